"""A container as Docker makes one, without Docker: `python tests/container.py ROOT COMMAND …`, as root, on Linux.

ROOT is the folder of a root file system ("/" for this machine's own). The command is root in it, with the capabilities,
the covered parts of /proc and /sys, and the refused system calls of Docker's defaults (https://docs.docker.com/engine/security/):
so it may make no namespace and mount nothing. `--seccomp=unconfined` and `--systempaths=unconfined` open what these
options of Docker open. The network is this machine's.
"""

import argparse
import ctypes
import errno
import os
import subprocess
import sys
from pathlib import Path

CAPABILITIES = {
    "chown": 0, "dac_override": 1, "fowner": 3, "fsetid": 4, "kill": 5, "setgid": 6, "setuid": 7, "setpcap": 8,
    "net_bind_service": 10, "net_raw": 13, "sys_chroot": 18, "mknod": 27, "audit_write": 29, "setfcap": 31,
}  # fmt: skip
DEVICES = ("null", "zero", "full", "random", "urandom", "tty")
MASKED = ("acpi", "interrupts", "kcore", "keys", "latency_stats", "sched_debug", "scsi", "timer_list", "timer_stats")
READ_ONLY = ("bus", "fs", "irq", "sys", "sysrq-trigger")
REFUSED = (
    "acct add_key bpf delete_module finit_module fsconfig fsmount fsopen fspick init_module io_uring_enter io_uring_register "
    "io_uring_setup kexec_file_load kexec_load keyctl mount mount_setattr move_mount open_tree perf_event_open pivot_root "
    "quotactl reboot request_key setns swapoff swapon umount2 unshare userfaultfd vhangup"
).split()  # of those that Docker's profile lets only a container with more capabilities call
NAMESPACES = 0x7E020000  # flags of clone
PR_CAPBSET_DROP, MNT_DETACH = 24, 2
HOST = "host"
ROOT = Path("/mnt")  # where the root lies until it becomes the root


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--seccomp", choices=["default", "unconfined"], default="default")
    parser.add_argument("--systempaths", choices=["default", "unconfined"], default="default")
    parser.add_argument(
        "--host", action="store_true", help=f"this machine's files in /{HOST}, for what sets a container up"
    )
    parser.add_argument("--inside", action="store_true", help=argparse.SUPPRESS)
    parser.add_argument("root", type=Path)
    parser.add_argument("command", nargs=argparse.REMAINDER)
    options = parser.parse_args(arguments)
    if options.inside:
        enter(options)
    own = ["unshare", "--mount", "--pid", "--ipc", "--uts", "--fork", "--kill-child", "--propagation=private"]
    os.execvp(own[0], [*own, sys.executable, __file__, "--inside", *arguments])


def enter(options):
    """Become the container's first process, in namespaces that have been made for it."""
    import pyseccomp

    mount("--rbind", options.root, ROOT)
    if options.host:
        (ROOT / HOST).mkdir(exist_ok=True)
        mount("--bind", "-o", "ro", "/", ROOT / HOST)
    fill(options.systempaths)
    os.chdir(ROOT)
    # Not by chroot, after which nobody may make a user namespace.
    subprocess.run(["pivot_root", ".", "."], check=True)
    libc = ctypes.CDLL(None)
    libc.umount2(b".", MNT_DETACH)
    os.chdir("/")
    for number in set(range(64)) - set(CAPABILITIES.values()):
        libc.prctl(
            PR_CAPBSET_DROP, number, 0, 0, 0
        )  # the kernel knows fewer; executing a program takes the others away
    if options.seccomp == "default":
        refuse(pyseccomp)
    os.execvp(options.command[0], options.command)


def fill(systempaths):
    """/proc and /dev, as far as programs need them."""
    for name in filter(os.path.ismount, (ROOT / "proc", ROOT / "dev")):
        subprocess.run(["umount", "--lazy", name], check=True)  # else bubblewrap may mount what this one shows beneath
    mount("-t", "proc", "proc", ROOT / "proc")
    mount("-t", "tmpfs", "-o", "mode=755", "tmpfs", ROOT / "dev")
    for name in DEVICES:
        (ROOT / "dev" / name).touch()
        mount("--bind", Path("/dev", name), ROOT / "dev" / name)
    (ROOT / "dev/shm").mkdir()
    mount("-t", "tmpfs", "-o", "mode=1777,size=64m", "shm", ROOT / "dev/shm")
    (ROOT / "dev/pts").mkdir()
    mount("-t", "devpts", "-o", "newinstance,ptmxmode=666", "devpts", ROOT / "dev/pts")
    (ROOT / "dev/ptmx").symlink_to("pts/ptmx")
    for name, target in {"fd": "", "stdin": "/0", "stdout": "/1", "stderr": "/2"}.items():
        (ROOT / "dev" / name).symlink_to(f"/proc/self/fd{target}")
    if systempaths == "unconfined":
        return
    for path in filter(Path.exists, (ROOT / "proc" / name for name in MASKED)):
        mount(*(["-t", "tmpfs", "-o", "ro", "tmpfs"] if path.is_dir() else ["--bind", ROOT / "dev/null"]), path)
    for path in filter(Path.exists, (ROOT / "proc" / name for name in READ_ONLY)):
        mount("--bind", path, path)
        mount("-o", "remount,bind,ro", path)


def mount(*arguments):
    subprocess.run(["mount", *map(str, arguments)], check=True)


def refuse(pyseccomp):
    """From here on, fail the system calls that Docker's profile refuses."""
    rules = pyseccomp.SyscallFilter(pyseccomp.ALLOW)
    rules.set_attr(pyseccomp.Attr.CTL_NNP, 0)
    for name in REFUSED:
        rules.add_rule(pyseccomp.ERRNO(errno.EPERM), name)
    for flag in (1 << bit for bit in range(32) if NAMESPACES >> bit & 1):
        made = pyseccomp.Arg(0, pyseccomp.MASKED_EQ, flag, flag)
        rules.add_rule(pyseccomp.ERRNO(errno.EPERM), "clone", made)
    rules.add_rule(pyseccomp.ERRNO(errno.ENOSYS), "clone3")  # its flags lie in memory, where a filter cannot look
    rules.load()


if __name__ == "__main__":
    main(sys.argv[1:])
