# SPDX-License-Identifier: BSD-3-Clause
"""Brick files, by dsm_convert."""

import os
import subprocess
import tempfile

from seeds.common import path, values


def make(folder, convert):
    with tempfile.TemporaryDirectory() as work:
        for name, dtype, components, options in (
            ("plain", "<f4", 1, []),
            ("zstd", "|u1", 1, ["--compression", "zstd", "--levels", "all"]),
            ("deflate", "<i2", 1, ["--compression", "deflate", "--levels", "1"]),
            ("vectors", "|u1", 3, []),
            ("vectors_zstd", "<f4", 2, ["--compression", "zstd"]),
        ):
            shape = (7, 6, 9)
            raw = os.path.join(work, "values.raw")
            values(dtype, (*shape, components)).tofile(raw)
            types = {"<f4": "float", "|u1": "uchar", "<i2": "short"}
            header = os.path.join(work, name + ".nhdr")
            with open(header, "w", encoding="utf-8") as file:
                file.write(f"NRRD0004\ntype: {types[dtype]}\ndimension: 4\nsizes: {components} 9 6 7\n")
                file.write("kinds: vector domain domain domain\nendian: little\nencoding: raw\ndata file: values.raw\n")
            out = path(folder, "BrickFile", name + ".vtkhdf")
            subprocess.run([convert, "--quiet", "--brick", "4", *options, header, out], check=True)
