"""The filter of system calls for a notebook's process: what the sandbox's namespaces and limits leave open.

A notebook needs files, threads, pipes and sockets of its own; whatever makes memory that no limit counts, reaches past
the sandbox, or is a door into the kernel that no notebook uses, is refused with an error that Python can raise.
"""

import ctypes
import errno
import fcntl
import mmap
import os
import socket
import tempfile

import pyseccomp

# Memory that counts for no process: it stays when nobody maps it, or lies in the kernel.
UNCOUNTED_MEMORY = (
    "memfd_create memfd_secret shmget shmat shmdt shmctl msgget msgsnd msgrcv msgctl semget semop semctl mq_open "
    "io_setup inotify_init inotify_init1 listen setsockopt landlock_create_ruleset"
)
# They leave whole pages in pipes and sockets, which count the bytes. Whoever copies so does without, where it is unknown.
PAGES = "splice tee sendfile"
# Other processes, and new or other namespaces.
REACHING_OUT = (
    "ptrace process_vm_readv process_vm_writev process_madvise kcmp pidfd_getfd unshare setns mount umount2 pivot_root "
    "chroot fsopen fsconfig fsmount fspick move_mount open_tree mount_setattr name_to_handle_at open_by_handle_at"
)
# Large parts of the kernel where most of its holes have been.
SELDOM_USED = (
    "bpf perf_event_open userfaultfd io_uring_setup io_uring_enter io_uring_register keyctl add_key request_key "
    "init_module finit_module delete_module kexec_load kexec_file_load reboot swapon swapoff sethostname setdomainname "
    "acct quotactl quotactl_fd syslog settimeofday clock_settime clock_adjtime adjtimex personality iopl ioperm "
    "modify_ldt uselib ustat sysfs vhangup lookup_dcookie fanotify_init migrate_pages move_pages vmsplice"
)
NEW_NAMESPACES = (0x00020000, 0x02000000, 0x04000000, 0x08000000, 0x10000000, 0x20000000, 0x40000000)  # CLONE_NEW…
CLONE_FILES, CLONE_PARENT, CLONE_THREAD = 0x400, 0x8000, 0x10000
CLOSE_RANGE_UNSHARE = 2
F_SETPIPE_SZ, F_OFD_SETLK, F_OFD_SETLKW = 1031, 37, 38  # fcntl
LOCKS = F_OFD_SETLK, F_OFD_SETLKW, fcntl.F_SETLK, fcntl.F_SETLKW  # of ranges: a file has any number of them
SHARED_ANONYMOUS, MAP_HUGETLB = mmap.MAP_SHARED | mmap.MAP_ANONYMOUS, 0x40000
PR_SET_SECCOMP, PR_SET_NO_NEW_PRIVS, PR_SET_THP_DISABLE = 22, 38, 41
SECCOMP_MODE_FILTER, INSTRUCTION = 2, 8  # bytes of an instruction
SOCKET_TYPE = 0xF  # in what socket(2) is given, the rest is flags
INT = 0xFFFFFFFF  # what the kernel sees of an argument of this type: a comparison with all bits would be passed by the others


def compiled():
    """The filter as the kernel takes it: bytes."""
    with tempfile.TemporaryFile() as file:
        _rules().export_bpf(file)
        file.seek(0)
        return file.read()


class _Program(ctypes.Structure):
    """struct sock_fprog of seccomp(2)."""

    _fields_ = [("length", ctypes.c_ushort), ("instructions", ctypes.c_char_p)]


def put_on(libc, program):
    """Put a compiled filter on the calling process for good, and on all that it starts; raises OSError."""
    given = _Program(len(program) // INSTRUCTION, program)
    if libc.prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) or libc.prctl(
        PR_SET_SECCOMP, SECCOMP_MODE_FILTER, ctypes.byref(given), 0, 0
    ):
        raise OSError(ctypes.get_errno(), f"the filter of system calls: {os.strerror(ctypes.get_errno())}")


def _rules():
    Arg, refuse = pyseccomp.Arg, pyseccomp.ERRNO(errno.EPERM)
    rules = pyseccomp.SyscallFilter(pyseccomp.ALLOW)

    def refuse_bits(name, argument, mask, value, *more):
        rules.add_rule(refuse, name, Arg(argument, pyseccomp.MASKED_EQ, mask, value), *more)

    for name in f"{UNCOUNTED_MEMORY} {REACHING_OUT} {SELDOM_USED}".split():
        rules.add_rule(refuse, name)
    for name in ("clone3", *PAGES.split()):  # the flags of the first cannot be seen; the C library then uses clone
        rules.add_rule(pyseccomp.ERRNO(errno.ENOSYS), name)
    # A child of the parent's is outside, where its processor time counts for nobody; descriptors are looked for in processes.
    for flag in (*NEW_NAMESPACES, CLONE_PARENT):
        refuse_bits("clone", 0, flag, flag)
    for only in (CLONE_FILES, CLONE_THREAD):
        refuse_bits("clone", 0, CLONE_FILES | CLONE_THREAD, only)
    refuse_bits("close_range", 2, CLOSE_RANGE_UNSHARE, CLOSE_RANGE_UNSHARE)
    refuse_bits("mmap", 3, SHARED_ANONYMOUS, SHARED_ANONYMOUS)
    refuse_bits("mmap", 3, MAP_HUGETLB, MAP_HUGETLB)  # pages that are set aside for others
    refuse_bits("prctl", 0, INT, PR_SET_THP_DISABLE)  # forkserver.py has disabled them
    for name in ("socket", "socketpair"):  # AF_VSOCK, for one, knows no network namespace
        rules.add_rule(pyseccomp.ERRNO(errno.ENETUNREACH), name, Arg(0, pyseccomp.NE, socket.AF_UNIX))
        for kind in (socket.SOCK_DGRAM, socket.SOCK_RAW, socket.SOCK_SEQPACKET):  # one keeps what many have sent
            refuse_bits(name, 1, SOCKET_TYPE, kind, Arg(0, pyseccomp.EQ, socket.AF_UNIX))
    for command in (F_SETPIPE_SZ, *LOCKS):
        refuse_bits("fcntl", 1, INT, command)
    return rules
