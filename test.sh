#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs what is missing, builds, and runs every test. The last line counts them.
# usage: ./test.sh [ctest arguments], such as -R Mpi
set -uo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/scripts/common.sh"

install_packages "${packages[@]}" libgtest-dev clang-format iproute2 python3-mpi4py
build_project --with-tests
results=$build/tests.xml
rm -f "$results"
ctest --test-dir "$build" --output-on-failure --output-junit "$results" "$@"
[ -s "$results" ] || fail "ctest did not write $results"

python3 - "$results" <<'PYTHON'
import sys
import xml.etree.ElementTree as tree

suite = tree.parse(sys.argv[1]).getroot()
states = [case.get("status") for case in suite.iter("testcase")]
skipped = sum(state in ("notrun", "disabled") for state in states)
passed = states.count("run")
failed = len(states) - passed - skipped
for case in suite.iter("testcase"):
    if case.get("status") in ("notrun", "disabled"):
        print("skipped:", case.get("name"))
print(f"{passed} passed, {failed} failed, {skipped} skipped")
sys.exit(0 if failed == 0 and passed > 0 else 1)
PYTHON
