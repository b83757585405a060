#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# No line of a source file exceeds 120 columns. Every C++ file is formatted as .clang-format says. Versions of
# clang-format understand it differently: the files are as this one writes them. Exits with 77 (skipped) where it is
# not installed.
set -euo pipefail
version=14
width=120
cd "$1"
# Markdown is left out, since a table's row is a line, and so is what a program has recorded (session.xml).
mapfile -t sources < <(find . \( -path './build*' -o -path './.*' -o -name session.xml \) -prune -o -type f \
  -regextype posix-egrep -regex '.*(\.(h|cxx|txx|py|sh|cmake|xml)(\.in)?|/CMakeLists\.txt|/ci/run)' -print | sort)
[ "${#sources[@]}" -gt 1000 ] || { echo "only ${#sources[@]} sources were found"; exit 1; }
export LC_ALL=C.UTF-8
long="^.{$((width + 1)),}"
printf '%*s\n' $((width + 1)) x | grep -qE "$long" || { echo "long lines are not found"; exit 1; }
if grep -nE "$long" "${sources[@]}"; then
  echo "lines of more than $width columns"
  exit 1
fi
for program in "clang-format-$version" clang-format; do
  if command -v "$program" >/dev/null && "$program" --version | grep -q "version $version\."; then
    formatter=$program
  fi
done
[ -n "${formatter:-}" ] || { echo "skipped: clang-format $version is not installed"; exit 77; }
mapfile -t files < <(find plugin tests vtk_modules examples \( -name '*.h' -o -name '*.cxx' \) | sort)
[ "${#files[@]}" -gt 50 ] || { echo "only ${#files[@]} files were found"; exit 1; }
"$formatter" --dry-run -Werror "${files[@]}"
echo "${#sources[@]} sources have lines of at most $width columns, and ${#files[@]} files are formatted"
