#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Every C++ file is formatted as .clang-format says. Exits with 77 (skipped) without clang-format.
set -euo pipefail
cd "$1"
command -v clang-format >/dev/null || { echo "skipped: clang-format is not installed"; exit 77; }
mapfile -t files < <(find plugin tests vtk_modules examples \( -name '*.h' -o -name '*.cxx' \) | sort)
[ "${#files[@]}" -gt 50 ] || { echo "only ${#files[@]} files were found"; exit 1; }
clang-format --dry-run -Werror "${files[@]}"
echo "${#files[@]} files are formatted"
