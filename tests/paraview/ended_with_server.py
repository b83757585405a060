#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Whether with_server.py leaves nothing behind: when it is ended, as `timeout` ends a test that takes too
long, and when the client fails. The server is one whose ranks are in sessions of their own, do not end when
asked to, and have a launcher that ends without them."""

import os
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
from started import is_running

RANK = "import signal, time; signal.signal(signal.SIGTERM, signal.SIG_IGN); time.sleep(100)"
SERVER = f"""
import subprocess, sys, time
for _ in range(2):
    rank = subprocess.Popen([sys.executable, "-c", {RANK!r}], start_new_session=True)
    with open(sys.argv[1], "a") as text:
        print(rank.pid, file=text)
print("Accepting connection", flush=True)
time.sleep(100)
"""


def start(folder, client):
    """with_server.py with its server and the given client, once its ranks and the client run."""
    ranks, begun = os.path.join(folder, "ranks"), os.path.join(folder, "begun")
    process = subprocess.Popen(
        [
            sys.executable,
            os.path.join(os.path.dirname(os.path.abspath(__file__)), "with_server.py"),
            *("--server", sys.executable, "-c", SERVER, ranks),
            *("--client", sys.executable, "-c", f"open({begun!r}, 'w').close(); {client}"),
        ]
    )
    deadline = time.monotonic() + 30
    while not os.path.exists(begun):
        if time.monotonic() > deadline:
            raise AssertionError("the client was not begun")
        time.sleep(0.05)
    with open(ranks, encoding="utf-8") as text:
        return process, [int(line) for line in text]


def check(name, client, end, result):
    with tempfile.TemporaryDirectory() as folder:
        process, ranks = start(folder, client)
        if len(ranks) != 2 or not (end is None or all(map(is_running, ranks))):
            raise AssertionError(f"{name}: the server's ranks do not run")
        if end is not None:
            process.send_signal(end)
        got = process.wait(timeout=20)
        left = [rank for rank in ranks if is_running(rank)]
        for rank in left:
            os.kill(rank, signal.SIGKILL)
        if left or got != result:
            raise AssertionError(f"{name}: returned {got}, and left {len(left)} of {len(ranks)} ranks")
        print(f"ok: {name}")


check("a test that is ended leaves no rank", "import time; time.sleep(100)", signal.SIGTERM, 143)
check("a client that fails leaves no rank", "raise SystemExit(3)", None, 3)
