#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs what is missing, builds, and runs every test. The last line counts them.
# usage: ./test.sh [ctest arguments], such as -R Mpi
set -uo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/scripts/common.sh"

install_packages "${packages[@]}" "${test_packages[@]}"
build_project --with-tests
results=$build/tests.xml
rm -f "$results"
ctest --test-dir "$build" --parallel 2 --output-on-failure --output-junit "$results" "$@"
count_tests "$results"
