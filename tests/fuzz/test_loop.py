#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests the mutation loop with a target that has defects: it finds them by words of a dictionary, keeps the inputs, and
these reproduce them. usage: test_loop.py fuzz_Planted"""

import os
import re
import subprocess
import sys
import tempfile

target = sys.argv[1]


def run(*options):
    done = subprocess.run([target, *options], capture_output=True, text=True, check=False)
    counted = re.search(r"number_of_executed_units: (\d+)", done.stdout)
    return done.returncode, int(counted.group(1)) if counted else 0, done.stderr


def check(holds, what):
    if not holds:
        sys.exit(f"failed: {what}")


with tempfile.TemporaryDirectory() as work:
    seeds = os.path.join(work, "seeds")
    os.makedirs(seeds)
    with open(os.path.join(seeds, "seed"), "w", encoding="utf-8") as file:
        file.write("some text of a seed")
    code, inputs, _ = run("-runs=1000", seeds)
    check((code, inputs) == (0, 1000), f"without defects, the loop ends with {code} after {inputs} inputs")
    for word, said in (("throw", "not caught"), ("large", "an allocation of 314572800 bytes"),
                       ("loop", "takes too long")):
        words = os.path.join(work, word + ".dict")
        with open(words, "w", encoding="utf-8") as file:
            file.write(f'# a comment\nname="{word[:-1]}\\x{ord(word[-1]):02x}"\n')
        kept = os.path.join(work, word + "-")
        code, inputs, text = run("-runs=100000", "-timeout=1", f"-dict={words}", f"-artifact_prefix={kept}", seeds)
        found = [name for name in os.listdir(work) if name.startswith(word + "-crash-")]
        check(code == 1 and 0 < inputs < 100000 and said in text, f"{word}: ends with {code} after {inputs}: {text}")
        check(len(found) == 1, f"{word}: {found} are kept")
        with open(os.path.join(work, found[0]), "rb") as file:
            check(word.encode() in file.read(), f"{word}: another input is kept")
        code, _, text = run("-timeout=1", os.path.join(work, found[0]))
        check(code != 0 and said in text, f"{word}: the input does not reproduce it: {text}")
    code, inputs, _ = run("-runs=3000", f"-dict={os.path.join(work, 'throw.dict')}", "-ignore_crashes=1",
                          f"-artifact_prefix={work}/all-", seeds)
    found = [name for name in os.listdir(work) if name.startswith("all-crash-")]
    check(code == 1 and inputs == 3000 and len(found) > 1, f"it does not go on: {inputs} inputs, {len(found)} kept")
print("ok")
