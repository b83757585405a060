# SPDX-License-Identifier: BSD-3-Clause
"""Makes volumes of every format, by programs other than this project's: h5py, zarr, VTK's writers and Teem.
Called as make_files.py FOLDER. FOLDER/manifest.json says what is in each. The sample at (x, y, z), component c,
channel k and step t is (3 x + 5 y + 7 z + c + 11 k + 13 t) modulo 101."""

import importlib
import json

from making.volumes import entries, path

for part in ("hdf", "zarrs", "headers", "balls", "placed", "named"):
    importlib.import_module(f"making.{part}")
with open(path("manifest.json"), "w", encoding="utf-8") as file:
    json.dump(entries, file, indent=1)
print(len(entries), "volumes")
