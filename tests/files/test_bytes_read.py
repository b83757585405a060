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


def write(path, values, chunk, options):
    with h5py.File(path, "w") as file:
        file.create_dataset("f", data=values, chunks=(chunk,) * 3, **options)
    return path


def convert(path, compression):
    done = f"{os.path.splitext(path)[0]}_{compression}.vtkhdf"
    subprocess.run([CONVERT, "--quiet", "--compression", compression, path, done], check=True, timeout=60)
    os.remove(path)
    return done


def copy(path):
    """As other programs do, which do not know that samples lie behind the chunks that they belong to."""
    done = path + ".copy.vtkhdf"
    with h5py.File(path, "r") as one, h5py.File(done, "w") as other:
        for name in ("VTKHDF", "DSM"):
            one.copy(name, other)
    os.remove(path)
    return done


def write_floats(name, chunk=64):
    return write(os.path.join(FOLDER, name + ".h5"), floats, chunk, {})


failed = False
hashes = set()
# Of compressed chunks, also the neighbors of those that a rank's bricks begin with are unpacked as a whole, for one
# layer of samples, and counted so; but for brick files, where a chunk has these with it, or behind it.
for name, path, isovalue, most in (
    ("floats32", lambda: write_floats("floats32", 32), 1.0, 1.1),
    ("floats64", lambda: write_floats("floats64"), 1.0, 1.1),
    ("bytes32", lambda: write(os.path.join(FOLDER, "bytes32.h5"), bytes_, 32,
                              {"compression": "gzip", "compression_opts": 1}), 180, 2.5),
    ("bricks, zstd", lambda: convert(write_floats("bricks"), "zstd"), 1.0, 1.1),
    ("bricks", lambda: convert(write_floats("bricks"), "none"), 1.0, 1.1),
    ("bricks, copied", lambda: copy(convert(write_floats("bricks"), "none")), 1.0, 3.0),
):
    path = path()
    entered = trace(1, path, isovalue, "off")
    rank = entered["opening"]["ranks"][0]
    bricks = (rank["misses"] - rank["joins"]) * entered["brick_bytes"]
    if isovalue == 1.0:
        hashes.add(entered["image_hash"])
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
if len(hashes) != 1:
    failed = True
    print(f"FAILED: the same values give the pictures {hashes}")
sys.exit(1 if failed else 0)
