#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Every C++ file is formatted as .clang-format says. Versions of clang-format understand it differently: the
# files are as this one writes them. Exits with 77 (skipped) where it is not installed.
set -euo pipefail
version=14
cd "$1"
for program in "clang-format-$version" clang-format; do
  if command -v "$program" >/dev/null && "$program" --version | grep -q "version $version\."; then
    formatter=$program
  fi
done
[ -n "${formatter:-}" ] || { echo "skipped: clang-format $version is not installed"; exit 77; }
mapfile -t files < <(find plugin tests vtk_modules examples \( -name '*.h' -o -name '*.cxx' \) | sort)
[ "${#files[@]}" -gt 50 ] || { echo "only ${#files[@]} files were found"; exit 1; }
"$formatter" --dry-run -Werror "${files[@]}"
echo "${#files[@]} files are formatted"
