# SPDX-License-Identifier: BSD-3-Clause
"""Makes the seeds of the fuzz targets: small files of every format, by other programs where there are some.
usage: make_seeds.py FOLDER dsm_convert fuzz_write_seeds. FOLDER gets a folder for each target."""

import importlib
import os
import shutil
import subprocess
import sys

folder, convert, write_seeds = sys.argv[1:]
shutil.rmtree(folder, ignore_errors=True)
for part in ("headers", "zarrs", "hdf", "answers"):
    importlib.import_module(f"seeds.{part}").make(folder)
importlib.import_module("seeds.bricks").make(folder, convert)
subprocess.run([write_seeds, folder], check=True)
for target in sorted(os.listdir(folder)):
    print(len(os.listdir(os.path.join(folder, target))), "seeds of", target)
