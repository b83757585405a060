# SPDX-License-Identifier: BSD-3-Clause
"""What all ranks together read of a volume in a file for one picture, over the bytes of the bricks that its rays
enter. Called as test_bytes_read.py DSM_BENCH DSM_CONVERT FOLDER MPIRUN..."""

import json
import os
import subprocess
import sys

import h5py
import numpy as np

BENCH, CONVERT, FOLDER, MPIRUN = *sys.argv[1:4], sys.argv[4:]
EDGE = 256
os.makedirs(FOLDER, exist_ok=True)
along = np.linspace(0, 1, EDGE, dtype="float32")
x, y, z = along[None, None, :], along[None, :, None], along[:, None, None]
floats = np.sin(20 * y) * np.cos(17 * x) + np.sin(23 * z)
bytes_ = (floats * 60 + 120).astype("u1")


def trace(ranks, path, isovalue, prefetch):
    command = [*MPIRUN, "-np", str(ranks), BENCH, "isosurface", "--volume", path, "--frames", "1"]
    command += ["--isovalue", str(isovalue), "--size", "300x300", "--memory", "512", "--threads", "1"]
    command += ["--prefetch", prefetch, "--json", "-"]
    return json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE, timeout=60).stdout)


failed = False
# Of compressed chunks, also the neighbours of those that a rank's bricks begin with are unpacked as a whole, for one
# layer of samples, and counted so; but for brick files with Zstandard, where a chunk has these with it.
for name, values, isovalue, chunk, options, most in (
    ("floats32", floats, 1.0, 32, {}, 1.1),
    ("floats64", floats, 1.0, 64, {}, 1.1),
    ("bytes32", bytes_, 180, 32, {"compression": "gzip", "compression_opts": 1}, 2.5),
    ("bricks", floats, 1.0, 64, {}, 1.1),
):
    path = os.path.join(FOLDER, name + ".h5")
    with h5py.File(path, "w") as file:
        file.create_dataset("f", data=values, chunks=(chunk,) * 3, **options)
    if name == "bricks":
        source, path = path, os.path.join(FOLDER, "bricks.vtkhdf")
        subprocess.run([CONVERT, "--quiet", "--compression", "zstd", source, path], check=True, timeout=60)
    entered = trace(1, path, isovalue, "off")
    rank = entered["opening"]["ranks"][0]
    bricks = (rank["misses"] - rank["joins"]) * entered["brick_bytes"]
    for ranks in (1, 2, 3, 4):
        found = trace(ranks, path, isovalue, "on")
        read = [rank["bytes_read"] for rank in found["opening"]["ranks"]]
        good = (
            0 < sum(read) <= most * bricks
            and max(read) <= 1.5 * sum(read) / ranks
            and found["image_hash"] == entered["image_hash"]
        )
        failed = failed or not good
        print(
            f"{'passed' if good else 'FAILED'}: {name}, {ranks} ranks: {sum(read) / bricks:.2f} of the bricks' "
            f"{bricks >> 10} KiB, by rank {[part >> 10 for part in read]} KiB",
            flush=True,
        )
    os.remove(path)
sys.exit(1 if failed else 0)
