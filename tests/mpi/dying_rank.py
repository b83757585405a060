# SPDX-License-Identifier: BSD-3-Clause
"""A rank that dies while the others wait for its bricks ends the job soon, and with a message.

    dying_rank.py DSM_BENCH MPIRUN..."""

import os
import signal
import subprocess
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
from started import find_descendants, is_running

BENCH, MPIRUN = sys.argv[1], sys.argv[2:]
LIMIT = 20.0  # seconds; what mpirun needs to notice, and to end the others
NAME = os.path.basename(BENCH)


def wait_for(condition, seconds, what):
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            raise AssertionError(what)
        time.sleep(0.05)


job = subprocess.Popen(
    [*MPIRUN, "-np", "3", BENCH, "isosurface", "--volume", "sphere:96:float", "--size", "256x256",
     "--threads", "1", "--cache-fraction", "0.1", "--frames", "1000000"],
    stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
try:
    wait_for(lambda: len(find_descendants(job.pid, NAME)) == 3, 60, "three ranks started")
    time.sleep(4)  # into the frames
    ranks = find_descendants(job.pid, NAME)
    assert job.poll() is None and len(ranks) == 3, "the job runs"
    os.kill(ranks[1], signal.SIGKILL)
    start = time.monotonic()
    output, _ = job.communicate(timeout=LIMIT)
    print(f"the job ended after {time.monotonic() - start:.1f} s with {job.returncode}:\n{output}")
    assert job.returncode != 0, "a job that lost a rank has failed"
    assert "signal 9" in output, "which is said"
    wait_for(lambda: not any(map(is_running, ranks)), LIMIT, "no rank is left")
finally:
    if job.poll() is None:
        for rank in find_descendants(job.pid, NAME):
            os.kill(rank, signal.SIGKILL)
        job.kill()
