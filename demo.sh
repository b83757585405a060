#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Ray traces an isosurface over four ranks, to demo.png.
# usage: ./demo.sh [FILE ISOVALUE [ARRAY]]
#   FILE      image data in any format that ParaView reads; without it, a noisy sphere of 256^3
#             samples is generated, each rank making its own piece
#   ISOVALUE  where the surface is
#   ARRAY     the point array to take; the file's first one if left out
# Environment: DSM_RANKS (4), DSM_SIZE (samples along an axis of the generated volume, 256).
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/scripts/common.sh"

if [ $# -eq 1 ] || [ $# -gt 3 ]; then
  fail "usage: ./demo.sh [FILE ISOVALUE [ARRAY]]"
fi
arguments=()
if [ $# -ge 2 ]; then
  [ -r "$1" ] || fail "cannot read the file $1"
  arguments=(--file "$(realpath "$1")" --isovalue "$2")
  [ $# -lt 3 ] || arguments+=(--array "$3")
fi

install_packages "${packages[@]}"
build_project
picture=$PWD/demo.png
rm -f "$picture"
start_ranks "${DSM_RANKS:-4}" timeout 3600 \
  pvbatch "$project/examples/demo.py" --plugin "$(plugin_directory)/DSMRayTracer.so" \
  --size "${DSM_SIZE:-256}" --output "$picture" "${arguments[@]}"
[ -s "$picture" ] || fail "the demo did not write a picture; the messages above explain why"
