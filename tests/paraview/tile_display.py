#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs a command with a display that has several screens, so that each rank may have one:
    tile_display.py SCREENS WIDTHxHEIGHT FOLDER COMMAND...
The pictures of the screens are in the folder, as Xvfb writes them. In the command, @RANK_SCREEN@ stands for a
shell's words that give a rank of Open MPI the screen of its number."""

import os
import shutil
import subprocess
import sys

RANK_SCREEN = ["sh", "-c", 'DISPLAY="${DISPLAY%.*}.$OMPI_COMM_WORLD_RANK" exec "$@"', "sh"]


def main():
    screens, size, folder = int(sys.argv[1]), sys.argv[2], sys.argv[3]
    command = []
    for word in sys.argv[4:]:
        command += RANK_SCREEN if word == "@RANK_SCREEN@" else [word]
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    reader, writer = os.pipe()
    options = [word for screen in range(screens) for word in ("-screen", str(screen), size + "x24")]
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(writer), "-noreset", "-fbdir", folder, *options], pass_fds=[writer])
    os.close(writer)
    try:
        with os.fdopen(reader) as numbers:
            display = numbers.readline().strip()
        return subprocess.call(command, env=dict(os.environ, DISPLAY=f":{display}.0"))
    finally:
        server.terminate()
        server.wait(timeout=20)


sys.exit(main())
