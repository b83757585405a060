# SPDX-License-Identifier: BSD-3-Clause
"""Reads the JUnit file that ctest writes. Prints the slowest tests, those that were skipped, what failed, and last how
many passed, failed and were skipped. Exits with 1 if one failed or none passed.

    count_tests.py TESTS.XML"""

import re
import sys
import xml.etree.ElementTree as tree

SLOWEST = 20
# A line of tests/paraview/run_scripts.py, about one of several scripts of a test.
SCRIPT = re.compile(r"^script (\S+): (\w+)(?: in ([0-9.]+) s)?")
# A line of GoogleTest at its end, about one case.
CASE = re.compile(r"^\[  (FAILED|SKIPPED) +\] (\S+?)(?:, where .*)?$")


def read(path):
    for case in tree.parse(path).getroot().iter("testcase"):
        said = [line for line in (case.findtext("system-out") or "").split("\n") if line.strip()]
        state = {"run": "passed", "notrun": "skipped", "disabled": "skipped"}.get(case.get("status"), "failed")
        yield case.get("name"), state, float(case.get("time") or 0), said


def describe_failure(said):
    """The cases or scripts that failed, and the last that was said."""
    cases = {match[2]: None for match in map(CASE.match, said) if match and match[1] == "FAILED"}
    scripts = [number for number, line in enumerate(said) if (match := SCRIPT.match(line)) and match[2] == "failed"]
    if scripts:  # they come last, each with what it said
        return said[scripts[0]:]
    return [f"failed: {case}" for case in cases] + said[-12:]


tests = list(read(sys.argv[1]))
times = [(seconds, name) for name, _, seconds, _ in tests]
for name, _, _, said in tests:
    times += [(float(match[3]), f"{name}, {match[1]}") for match in map(SCRIPT.match, said) if match and match[3]]
print(f"the {min(SLOWEST, len(times))} slowest, in seconds:")
for seconds, name in sorted(times, reverse=True)[:SLOWEST]:
    print(f"  {seconds:6.1f} {name}")
for name, state, _, said in tests:
    if state == "skipped":
        print("skipped:", name)
    for line in said:
        if (match := SCRIPT.match(line)) and match[2] == "skipped":
            print(f"skipped: {name}, {match[1]}")
    for case in {match[2]: None for match in map(CASE.match, said) if match and match[1] == "SKIPPED"}:
        print(f"skipped: {name}, {case}")
for name, state, _, said in tests:
    if state == "failed":
        print("failed:", name, *describe_failure(said), sep="\n  ")
states = [state for _, state, _, _ in tests]
print(f"{states.count('passed')} passed, {states.count('failed')} failed, {states.count('skipped')} skipped")
sys.exit(0 if "failed" not in states and "passed" in states else 1)
