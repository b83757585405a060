# SPDX-License-Identifier: BSD-3-Clause
"""What a test has started ends with it: also ranks in sessions of their own, whose launcher is gone, and
when the test is ended because its time is over. Ranks that were left would slow every test after it."""

import contextlib
import ctypes
import os
import signal
import sys
import time

PR_SET_CHILD_SUBREAPER = 36  # <linux/prctl.h>


def find_descendants():
    """The processes below this one that have not ended."""
    children = {}
    for entry in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{entry}/stat", encoding="utf-8", errors="replace") as text:
                state, parent = text.read().rpartition(")")[2].split()[:2]
        except OSError:
            continue
        if state != "Z":
            children.setdefault(int(parent), []).append(int(entry))
    found, left = [], [os.getpid()]
    while left:
        below = children.get(left.pop(), [])
        found += below
        left += below
    return found


def end_descendants(seconds):
    """Kills them, until none is left; raises when some remain after so many seconds."""
    deadline = time.monotonic() + seconds
    while processes := find_descendants():
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
