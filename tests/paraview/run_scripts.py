#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs test scripts in one start of ParaView, and says of each whether it passed and how long it took:

    run_scripts.py SECONDS LIST COMMAND...

LIST is run.py's. COMMAND starts ParaView with run.py; @LIST@ and @REPORT@ in it stand for files that run.py takes. A
script that takes longer than SECONDS, or that ParaView does not survive, fails, and ParaView is started again for the
others. The environment variable DSM_TEST_SCRIPTS names those of the scripts that are to run, as in
DSM_TEST_SCRIPTS="Views Time"; all run without it.

Exits with 1 if a script failed, and with 77 if all were skipped."""

import collections
import os
import subprocess
import sys
import tempfile
import threading
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
from started import end_descendants, ended_with_this

Result = collections.namedtuple("Result", "name state seconds reason")


def get_name(script):
    """Volumes, of TestVolumes.py; of a script of several cases, the one that `--case` tells."""
    path = script[script.index("--case") + 1] if "--case" in script else script[0]
    return os.path.splitext(os.path.basename(path))[0].removeprefix("Test")


def read_report(path, scripts):
    """The results of the scripts that have ended, and how many have begun."""
    with open(path, encoding="utf-8") as text:
        lines = [line.split("\t") for line in text if line.endswith("\n")]
    ended = [line for line in lines if line[0] != "begun"]
    results = [Result(get_name(script), state, float(seconds), reason.strip())
               for script, (state, seconds, reason) in zip(scripts, ended)]
    return results, len(lines) - len(ended)


def watch(process, report, scripts, limit):
    """Waits for ParaView's end, at most `limit` seconds for each script. Returns how many scripts were begun, and how
    ParaView ended."""
    begun, since = 0, time.monotonic()
    while True:
        ended = process.poll() is not None
        count = read_report(report, scripts)[1]
        if count != begun:
            begun, since = count, time.monotonic()
        if ended:
            return begun, f"ParaView ended with exit code {process.returncode}"
        if time.monotonic() - since > limit:
            return begun, f"no end after {limit:.0f} s"
        time.sleep(0.1)


def pass_on(stream, tail):
    for line in stream:
        sys.stdout.write(line)
        sys.stdout.flush()
        tail.append(line.rstrip())


def fail(script, reason, tail):
    return Result(get_name(script), "failed", 0.0, "\n  ".join([reason + ":", *tail]))


def run_once(scripts, command, limit, folder):
    """Starts ParaView for these scripts. Returns a result of each that it came to, and of one at least."""
    paths = {name: os.path.join(folder, name) for name in ("@LIST@", "@REPORT@")}
    with open(paths["@LIST@"], "w", encoding="utf-8") as text:
        text.writelines("\t".join(script) + "\n" for script in scripts)
    open(paths["@REPORT@"], "w", encoding="utf-8").close()
    tail = collections.deque(maxlen=15)
    process = subprocess.Popen([paths.get(word, word) for word in command], stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, text=True, errors="replace")
    reader = threading.Thread(target=pass_on, args=(process.stdout, tail), daemon=True)
    reader.start()
    try:
        begun, reason = watch(process, paths["@REPORT@"], scripts, limit)
    except SystemExit:  # the test's own time is over
        results, begun = read_report(paths["@REPORT@"], scripts)
        for result in results:
            print(f"script {result.name}: {result.state} in {result.seconds:.2f} s {result.reason}")
        print(f"in the middle of {get_name(scripts[max(begun, 1) - 1])}:", *tail, sep="\n  ", flush=True)
        raise
    if process.poll() is None:
        process.terminate()  # with_server.py tells what its server said
        try:
            process.wait(timeout=6)
        except subprocess.TimeoutExpired:
            pass
        end_descendants(5)
        process.wait()
    reader.join(timeout=5)
    results = read_report(paths["@REPORT@"], scripts)[0]
    if begun > len(results):
        results.append(fail(scripts[begun - 1], reason, tail))
    elif not results:
        results = [fail(scripts[0], "before the first script, " + reason, tail)]
    elif process.returncode != 0 or len(results) < len(scripts):
        results[-1] = fail(scripts[len(results) - 1], "after the script, " + reason, tail)
    return results


def main():
    limit = float(sys.argv[1])
    with open(sys.argv[2], encoding="utf-8") as text:
        scripts = [line.rstrip("\n").split("\t") for line in text if line.strip()]
    chosen = os.environ.get("DSM_TEST_SCRIPTS", "").replace(",", " ").split()
    if chosen:
        scripts = [script for script in scripts if get_name(script) in chosen]
        if not scripts:
            print("none of the scripts has a name in DSM_TEST_SCRIPTS")
            return 77
    results = []
    try:
        with tempfile.TemporaryDirectory() as folder:
            while len(results) < len(scripts):
                results += run_once(scripts[len(results):], sys.argv[3:], limit, folder)
    finally:
        print("--- results")
        for result in results:
            if result.state != "failed":
                print(f"script {result.name}: {result.state} in {result.seconds:.2f} s")
        for script in scripts[len(results):]:
            print(f"script {get_name(script)}: failed: the test ended before")
        for result in results:
            if result.state == "failed":
                print(f"script {result.name}: failed: {result.reason}")
        sys.stdout.flush()
    states = {result.state for result in results}
    return 1 if "failed" in states else 77 if states == {"skipped"} else 0


with ended_with_this():
    sys.exit(main())
