# SPDX-License-Identifier: BSD-3-Clause
"""A rank that dies while the others wait for its bricks ends the job soon, and with a message.

    dying_rank.py DSM_BENCH MPIRUN..."""

import os
import signal
import subprocess
import sys
import time

BENCH, MPIRUN = sys.argv[1], sys.argv[2:]
LIMIT = 20.0  # seconds; what mpirun needs to notice, and to end the others
NAME = os.path.basename(BENCH)


def find_ranks(ancestor):
    """The processes of the benchmark below a process."""
    parents, names = {}, {}
    for entry in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{entry}/stat", encoding="ascii") as file:
                text = file.read()
        except (FileNotFoundError, ProcessLookupError):
            continue
        end = text.rindex(")")
        names[int(entry)] = text[text.index("(") + 1:end]
        state, parent = text[end + 2:].split()[:2]
        parents[int(entry)] = int(parent) if state != "Z" else 0
    ranks = []
    for process, name in names.items():
        above = process
        while above in parents and above != ancestor:
            above = parents[above]
        if above == ancestor and name == NAME:
            ranks.append(process)
    return sorted(ranks)


def is_alive(process):
    try:
        with open(f"/proc/{process}/stat", encoding="ascii") as file:
            return file.read().rpartition(")")[2].split()[0] not in "ZX"
    except (FileNotFoundError, ProcessLookupError):
        return False


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
    wait_for(lambda: len(find_ranks(job.pid)) == 3, 60, "three ranks started")
    time.sleep(4)  # into the frames
    ranks = find_ranks(job.pid)
    assert job.poll() is None and len(ranks) == 3, "the job runs"
    os.kill(ranks[1], signal.SIGKILL)
    start = time.monotonic()
    output, _ = job.communicate(timeout=LIMIT)
    print(f"the job ended after {time.monotonic() - start:.1f} s with {job.returncode}:\n{output}")
    assert job.returncode != 0, "a job that lost a rank has failed"
    assert "signal 9" in output, "which is said"
    wait_for(lambda: not any(map(is_alive, ranks)), LIMIT, "no rank is left")
finally:
    if job.poll() is None:
        for rank in find_ranks(job.pid):
            os.kill(rank, signal.SIGKILL)
        job.kill()
