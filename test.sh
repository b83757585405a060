#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs what is missing, builds, and runs every test. The last line counts them.
# usage: ./test.sh [--quick] [ctest arguments], such as -R Mpi
#   --quick  style, unit tests, scenes, MPI, and ParaView's scripts on one rank; about 6 minutes on two cores
set -uo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/scripts/common.sh"

arguments=()
if [ "${1:-}" = --quick ]; then
  arguments=(-L '^quick$')
  shift
fi
install_packages "${packages[@]}" "${test_packages[@]}"
build_project --with-tests
results=$build/tests.xml
rm -f "$results"
ctest --test-dir "$build" --parallel 2 --output-on-failure --output-junit "$results" \
  "${keep_output[@]}" "${arguments[@]}" "$@"
count_tests "$results"
