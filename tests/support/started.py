# SPDX-License-Identifier: BSD-3-Clause
"""What a test starts: where its server may listen, which processes are below it, and what they hold. What it
has started ends with it: also ranks in sessions of their own, whose launcher is gone, and when the test is
ended because its time is over. Ranks that were left would slow every test after it."""

import contextlib
import ctypes
import os
import signal
import socket
import sys
import time

PR_SET_CHILD_SUBREAPER = 36  # <linux/prctl.h>


def find_free_port():
    """A port of this host that nothing listens to."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def read_stat(process):
    """The name of a process and its parent (proc(5)); None where it is gone, or has ended."""
    try:
        with open(f"/proc/{process}/stat", encoding="utf-8", errors="replace") as text:
            before, _, after = text.read().rpartition(")")
    except OSError:
        return None
    state, parent = after.split()[:2]
    return None if state in "ZX" else (before.partition("(")[2], int(parent))


def is_running(process):
    """Whether there is such a process, and it has not ended."""
    return read_stat(process) is not None


def get_memory(process):
    """What a process holds besides files that are mapped, and its part of what it shares with others, in KiB. Raises
    OSError where it has ended."""
    with open(f"/proc/{process}/smaps_rollup", encoding="utf-8") as text:
        return sum(int(line.split()[1]) for line in text if line.startswith(("Pss_Anon:", "Pss_Shmem:")))


def find_descendants(ancestor, name=""):
    """The processes below one that have not ended, and whose names begin so (proc(5): 15 characters of it are
    known), in the order of their numbers."""
    children = {}
    names = {}
    for process in map(int, filter(str.isdigit, os.listdir("/proc"))):
        if found := read_stat(process):
            names[process], parent = found
            children.setdefault(parent, []).append(process)
    found, left = [], [ancestor]
    while left:
        below = children.get(left.pop(), [])
        found += below
        left += below
    return sorted(process for process in found if names[process].startswith(name))


def end_descendants(seconds):
    """Kills them, until none is left; raises when some remain after so many seconds."""
    deadline = time.monotonic() + seconds
    while processes := find_descendants(os.getpid()):
        if time.monotonic() > deadline:
            raise RuntimeError(f"processes {processes} do not end")
        for process in processes:
            with contextlib.suppress(ProcessLookupError):
                os.kill(process, signal.SIGKILL)
        time.sleep(0.05)


@contextlib.contextmanager
def ended_with_this():
    """Within it, SIGTERM raises SystemExit, and processes whose parents have ended become children of
    this one (prctl(2)); at its end, all that are below this one are killed. To be entered once, by the
    main thread of a process that is a test's own."""
    ctypes.CDLL(None, use_errno=True).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
    signal.signal(signal.SIGTERM, lambda number, _: sys.exit(128 + number))
    try:
        yield
    finally:
        # A second signal must not cut this short.
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
        end_descendants(5)
