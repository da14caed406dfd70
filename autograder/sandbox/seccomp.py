"""The filter of system calls for a notebook's process: what the sandbox's namespaces and limits leave open.

A notebook needs files, threads, pipes and sockets of its own; whatever makes memory that no limit counts, reaches past
the sandbox, or is a door into the kernel that no notebook uses, is refused with an error that Python can raise.
"""

import errno
import socket

import pyseccomp

# Memory that counts for no process: it stays when nobody maps it.
UNCOUNTED_MEMORY = "memfd_create memfd_secret shmget shmat shmdt shmctl msgget msgsnd msgrcv msgctl semget semop semctl"
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
F_SETPIPE_SZ = 1031  # fcntl
BUFFERS = (socket.SO_SNDBUF, socket.SO_RCVBUF)


def notebook_filter():
    """A pyseccomp.SyscallFilter; its `load()` puts it on the calling process for good, and on all that it starts."""
    Arg, refuse = pyseccomp.Arg, pyseccomp.ERRNO(errno.EPERM)
    rules = pyseccomp.SyscallFilter(pyseccomp.ALLOW)
    for name in f"{UNCOUNTED_MEMORY} {REACHING_OUT} {SELDOM_USED}".split():
        rules.add_rule(refuse, name)
    rules.add_rule(pyseccomp.ERRNO(errno.ENOSYS), "clone3")  # its flags cannot be seen; the C library then uses clone
    for flag in NEW_NAMESPACES:
        rules.add_rule(refuse, "clone", Arg(0, pyseccomp.MASKED_EQ, flag, flag))
    for name in ("socket", "socketpair"):  # AF_VSOCK, for one, knows no network namespace
        rules.add_rule(pyseccomp.ERRNO(errno.ENETUNREACH), name, Arg(0, pyseccomp.NE, socket.AF_UNIX))
    for option in BUFFERS:  # sockets and pipes hold what is written to them, and no limit counts it
        rules.add_rule(refuse, "setsockopt", Arg(1, pyseccomp.EQ, socket.SOL_SOCKET), Arg(2, pyseccomp.EQ, int(option)))
    rules.add_rule(refuse, "fcntl", Arg(1, pyseccomp.EQ, F_SETPIPE_SZ))
    return rules
