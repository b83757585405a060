# SPDX-License-Identifier: BSD-3-Clause
"""Brick files that dsm_convert writes, as h5py reads them. Called as test_convert.py DSM_CONVERT FOLDER MPIRUN...;
leaves FOLDER/ball.vtkhdf, FOLDER/ball_zstd.vtkhdf and FOLDER/ball_deflate.vtkhdf, of FOLDER/ball.h5, for tests of the
reader."""

import glob
import json
import os
import signal
import subprocess
import sys
import time
import warnings

import h5py
import numpy as np
from numcodecs import Zlib, Zstd

CONVERT, FOLDER, MPIRUN = sys.argv[1], sys.argv[2], sys.argv[3:]
SIZE = (101, 70, 90)  # x, y, z
EDGE = 16
failed = False


def check(condition, what):
    global failed
    failed = failed or not condition
    print(("passed: " if condition else "FAILED: ") + what, flush=True)


def path(name):
    return os.path.join(FOLDER, name)


def command(ranks, *options):
    start = [*MPIRUN, "-np", str(ranks)] if MPIRUN and ranks > 1 else []
    return [*start, CONVERT, *(str(option) for option in options)]


def convert(*options, ranks=1):
    return subprocess.run(command(ranks, *options), capture_output=True, text=True, timeout=100)


def find_brick_ranges(values):
    """Of the cells whose corners all are numbers, brick after brick; none where there are no such cells."""
    counts = [-(-size // EDGE) for size in values.shape]
    ranges = []
    for z, y, x in np.ndindex(*counts):
        brick = values[tuple(slice(EDGE * i, EDGE * i + EDGE + 1) for i in (z, y, x))].astype("f8")
        if min(brick.shape) < 2:
            continue  # a chunk that begins no brick
        corners = np.stack([
            brick[k : brick.shape[0] - 1 + k, j : brick.shape[1] - 1 + j, i : brick.shape[2] - 1 + i]
            for k in (0, 1) for j in (0, 1) for i in (0, 1)])
        whole = np.isfinite(corners).all(axis=0)
        ranges.append((corners[:, whole].min(), corners[:, whole].max()) if whole.any() else None)
    return ranges


def read_brick_ranges(group, shape, edge=EDGE):
    """As find_brick_ranges, from the beginning of the index."""
    bricks = int(np.prod([-(-(size - 1) // edge) for size in shape]))
    pairs = np.frombuffer(group["BrickIndex"][: 8 * bricks].tobytes(), "<f4").reshape(-1, 2)
    return [None if first > last else (first, last) for first, last in pairs]


z, y, x = np.mgrid[: SIZE[2], : SIZE[1], : SIZE[0]]
values = (np.sin(0.1 * x) * np.cos(0.07 * y) + 0.01 * z).astype("float32")
values[10:20, 5:9, 3:7] = np.nan
values.tofile(path("convert.raw"))
BARE = ["--quiet", "--raw-size", ",".join(map(str, SIZE)), "--raw-type", "float32", "--spacing", "1,2,3"]


def compare(name, what):
    with h5py.File(path(name), "r") as file:
        array = file["VTKHDF/PointData/convert"]
        check(np.array_equal(array[...], values, equal_nan=True), f"{what}: every value")
        check(array.chunks == (EDGE,) * 3 and array.fletcher32, f"{what}: chunks fit bricks and have checksums")
        attributes = file["VTKHDF"].attrs
        check(list(attributes["WholeExtent"]) == [0, SIZE[0] - 1, 0, SIZE[1] - 1, 0, SIZE[2] - 1] and
              list(attributes["Spacing"]) == [1, 2, 3], f"{what}: the place in the world")
        index = file["DSM/PointData/convert"]
        expected = find_brick_ranges(values)
        found = read_brick_ranges(index, values.shape)
        check(file["DSM"].attrs["BrickEdge"] == EDGE and found == expected, f"{what}: the ranges of bricks")
        whole = index["ValueRanges"][0]
        check((whole == [np.nanmin(values), np.nanmax(values)] * 2).all(), f"{what}: the range of all")


for ranks in (1, 3) if MPIRUN else (1,):
    for compression in ("none", "deflate"):
        name = f"{compression}_{ranks}.vtkhdf"
        done = convert(*BARE, "--compression", compression, "--memory", 8, path("convert.raw"), path(name), ranks=ranks)
        check(done.returncode == 0, f"{name} is written {done.stderr}")
        compare(name, name)
        check(not os.path.exists(path(name) + ".part"), f"{name}: nothing else is left")

# Chunks of which a brick needs more together than the memory holds, as of slices: not read for each brick anew.
slices = np.tile(values[:20], (1, 9, 6))
with h5py.File(path("slices.h5"), "w") as file:
    file.create_dataset("values", data=slices, chunks=(1, *slices.shape[1:]), compression="gzip")
for ranks in (1, 3) if MPIRUN else (1,):
    name = f"slices_{ranks}.vtkhdf"
    start = time.monotonic()
    done = convert("--quiet", "--memory", 32, path("slices.h5"), path(name), ranks=ranks)
    took = time.monotonic() - start
    check(done.returncode == 0 and took < 30, f"{name} is written, in {took:.1f} s {done.stderr}")
    with h5py.File(path(name), "r") as file:
        check(np.array_equal(file["VTKHDF/PointData/values"][...], slices, equal_nan=True), f"{name}: every value")

# What h5py lacks the filter for is read back by our own reader.
done = convert(*BARE, "--compression", "zstd", path("convert.raw"), path("zstd.vtkhdf"))
check(done.returncode == 0, f"Zstandard is written {done.stderr}")
back = convert("--quiet", path("zstd.vtkhdf"), path("back.vtkhdf"))
check(back.returncode == 0, f"and read {back.stderr}")
compare("back.vtkhdf", "Zstandard")
# Other readers pass over what is behind a chunk.
for packed, name, codec in (("zstd.vtkhdf", "Zstandard", Zstd()), ("deflate_1.vtkhdf", "zlib", Zlib())):
    with h5py.File(path(packed), "r") as file, h5py.File(path("back.vtkhdf"), "r") as whole:
        array, other = file["VTKHDF/PointData/convert"], whole["VTKHDF/PointData/convert"]
        halos = file["DSM/PointData/convert"].attrs["HaloSamples"]
        filters, stored = array.id.read_direct_chunk((0, 0, 0))
        unpacked = np.frombuffer(codec.decode(stored[:-4]), "u1").reshape(array.dtype.itemsize, -1)
        chunk = np.ascontiguousarray(unpacked.T).view(array.dtype).reshape(array.chunks)
        same = np.array_equal(chunk, other[tuple(slice(edge) for edge in array.chunks)], equal_nan=True)
        check(halos == 1 and filters == 0 and same, f"numcodecs reads a chunk that has a halo ({name})")
# What is not compressed has its halo behind the chunk.
with h5py.File(path("none_1.vtkhdf"), "r") as file:
    array, group = file["VTKHDF/PointData/convert"], file["DSM/PointData/convert"]
    halos, behind, right = group["Halos"], 0, group.attrs["HaloSamples"] == 1
    for number in range(halos.shape[0]):
        counts = [-(-size // EDGE) for size in SIZE]
        at = np.unravel_index(number, counts[::-1])
        place = array.id.get_chunk_info_by_coord(tuple(int(k) * EDGE for k in at))
        record = halos.id.get_chunk_info_by_coord((number, 0))
        behind += record.byte_offset == place.byte_offset + place.size
        brick = values[tuple(slice(k * EDGE, k * EDGE + EDGE + 1) for k in at)]
        parts = (brick[..., EDGE:], brick[:, EDGE:, :EDGE], brick[EDGE:, :EDGE, :EDGE])
        samples = np.concatenate([part.ravel() for part in parts]).tobytes()
        words = np.frombuffer(halos[number, :24].tobytes(), "<u8")
        right = right and bytes(halos[number, :8]) == b"DSM halo" and list(words[1:]) == [number, len(samples)]
        right = right and halos[number, 24 : 24 + len(samples)].tobytes() == samples
    check(right, "the halos of chunks that are not compressed")
    check(behind >= 0.95 * halos.shape[0], f"they lie behind their chunks: {behind} of {halos.shape[0]}")
check(os.path.getsize(path("zstd.vtkhdf")) < 0.8 * os.path.getsize(path("back.vtkhdf")), "it is smaller")

# Components, cells, several arrays, other names.
done = convert("--quiet", path("image.vtkhdf"), path("arrays.vtkhdf"))
with h5py.File(path("image.vtkhdf"), "r") as one, h5py.File(path("arrays.vtkhdf"), "r") as other:
    for name in ("PointData/f", "PointData/v", "CellData/c"):
        check(np.array_equal(one["VTKHDF"][name], other["VTKHDF"][name]), f"{name} of several arrays")
    check((one["VTKHDF"].attrs["Direction"] == other["VTKHDF"].attrs["Direction"]).all(), "the direction")
    check(other["DSM/PointData/v/ValueRanges"].shape == (4, 4), "ranges of three components and the magnitude")
for option, value, words in (("--dataset", "f", "does not support choosing a dataset ('f')"),
                             ("--raw-size", "9,9,9", "--raw-size applies to .raw files only")):
    done = convert(option, value, path("image.vtkhdf"), path("none.vtkhdf"))
    check(done.returncode != 0 and words in done.stderr, f"{option} of no use is refused: {done.stderr.strip()}")
done = convert("--quiet", "--arrays", "nothing", path("image.vtkhdf"), path("none.vtkhdf"))
check(done.returncode != 0 and "has no array 'nothing'" in done.stderr, "an array that is not there is named")
done = convert(*BARE[:-1], "1,0,3", path("convert.raw"), path("none.vtkhdf"))
check(done.returncode != 0 and "--spacing" in done.stderr, f"no spacing: {done.stderr.strip()}")

# What a file says of place and values is kept, unless the user says otherwise.
done = convert("--quiet", "--spacing", "1,1,2", "--origin", "3,-4,5", "--arrays", "f", path("image.vtkhdf"),
               path("placed.vtkhdf"))
check(done.returncode == 0, f"another place {done.stderr}")
with h5py.File(path("placed.vtkhdf"), "r") as file:
    place = file["VTKHDF"].attrs
    check(list(place["Spacing"]) == [1, 1, 2] and list(place["Origin"]) == [3, -4, 5], "it is there")
done = convert("--quiet", "--arrays", "t", "--step", "1", path("packed.nc"), path("unpacked.vtkhdf"))
check(done.returncode == 0, f"packed values {done.stderr}")
with h5py.File(path("unpacked.vtkhdf"), "r") as file, h5py.File(path("packed.nc"), "r") as packed:
    numbers = packed["t"][1]
    check(np.array_equal(file["VTKHDF/PointData/t"][...],
                         np.where(numbers == 7, np.nan, 0.25 * numbers + 5).astype("f4"), equal_nan=True),
          "they are unpacked")
    check(list(file["VTKHDF"].attrs["Spacing"]) == [1, -0.5, 50], "and where they were")
done = convert("--quiet", "--levels", "1", "--arrays", "short", path("missing.h5"), path("missing.vtkhdf"))
check(done.returncode == 0, f"missing values {done.stderr}")
with h5py.File(path("missing.vtkhdf"), "r") as file:
    coarse = file["DSM/Levels/1/VTKHDF/PointData/short"]
    check(all(one.attrs["_FillValue"][0] == -9999 for one in (file["VTKHDF/PointData/short"], coarse)),
          "they are declared")
    check(set(np.unique(coarse[...][coarse[...] < 0])) == {-9999}, "and no mean of a coarser level has them")
done = convert("--quiet", "--arrays", "two", path("missing.h5"), path("two_missing.vtkhdf"))
with h5py.File(path("two_missing.vtkhdf"), "r") as file:
    declared = file["VTKHDF/PointData/two"].attrs
    check([*declared["_FillValue"], *declared["missing_value"]] == [-9999, 8888, -1], "all of several are declared")
done = convert("--quiet", path("kinds.h5"), path("kinds.vtkhdf"))
with h5py.File(path("kinds.vtkhdf"), "r") as file:
    check(len(file["VTKHDF/PointData"]) == 8,
          f"vectors of arrays that are written are not: {list(file['VTKHDF/PointData'])}")
done = convert("--quiet", path("uneven.nc"), path("none.vtkhdf"))
check(done.returncode != 0 and "not evenly spaced" in done.stderr, f"uneven coordinates: {done.stderr.strip()}")

# The names the wrong way round: what was to be read is not replaced.
done = convert("--quiet", path("image.vtkhdf"), path("convert.raw"))
check(done.returncode != 0 and "Use .vtkhdf" in done.stderr, f"another format: {done.stderr.strip()}")
check(os.path.getsize(path("convert.raw")) == values.nbytes, "and the file of that name is as it was")

# Each number of how far it is, once.
done = convert(*BARE[1:], path("convert.raw"), path("told.vtkhdf"))
told = done.stderr.replace("\n", "\r").split("\r")
told = [line for line in told if line.endswith(" %")]
check(told[-1:] == ["100 %"] and len(told) == len(set(told)), f"how far it is, and no number twice: {told[:3]} ...")

# Coarser levels: each the mean of 2 x 2 x 2 points of the one before that are numbers, half a sample further.
def reduce(fine):
    """Of a point array (z, y, x, and components), as dsm_convert does."""
    for axis in range(3):
        if fine.shape[axis] % 2 and fine.shape[axis] >= 3:
            rest = np.full_like(np.take(fine, [0], axis), np.nan)
            fine = np.concatenate([fine, rest], axis)
    parts = [fine[k::2, j::2, i::2] for k in (0, 1) for j in (0, 1) for i in (0, 1)]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # of none
        return np.nanmean(np.stack(parts), axis=0)


for ranks in (1, 2, 3, 4) if MPIRUN else (1,):
    name = f"levels_{ranks}.vtkhdf"
    done = convert(*BARE, "--levels", "all" if ranks < 4 else 2, "--memory", 8, "--compression",
                   "deflate" if ranks == 2 else "none", path("convert.raw"), path(name), ranks=ranks)
    check(done.returncode == 0, f"{name} is written {done.stderr}")
    check(glob.glob(path(name) + ".*") == [], f"{name}: nothing else is left")
    compare(name, name)
    with h5py.File(path(name), "r") as file:
        levels = file["DSM/Levels"]
        # 101 x 70 x 90, 51 x 35 x 45, 26 x 18 x 23, 13 x 9 x 12
        check(sorted(levels) == ["1", "2", "3"][: 2 if ranks == 4 else 3],
              f"{name}: until it is one brick: {sorted(levels)}")
        fine, spacing, origin = values, np.array([1.0, 2.0, 3.0]), np.zeros(3)
        for level in sorted(levels):
            image = levels[level]["VTKHDF"]
            origin, spacing = origin + 0.5 * spacing, 2 * spacing
            fine = reduce(fine.astype("f8")).astype("f4")
            array = image["PointData/convert"]
            check(array.shape == fine.shape and np.array_equal(array[...], fine, equal_nan=True),
                  f"{name}, level {level}: every value")
            check((image.attrs["Spacing"] == spacing).all() and np.allclose(image.attrs["Origin"], origin, 1e-15, 0),
                  f"{name}, level {level}: the place in the world")
            index = levels[level]["DSM/PointData/convert"]
            found = read_brick_ranges(index, fine.shape)
            check("Halos" not in index, f"{name}, level {level}: no samples that would not lie behind their chunks")
            check(array.fletcher32 and found == find_brick_ranges(fine) and len(index["BrickIndex"]) > 0,
                  f"{name}, level {level}: checksums, and the ranges of bricks")
            check((index["ValueRanges"][0] == [np.nanmin(fine), np.nanmax(fine)] * 2).all(),
                  f"{name}, level {level}: the range of all")

# One of them is a volume of its own for dsm_convert.
done = convert("--quiet", "--level", 2, path("levels_1.vtkhdf"), path("level_2.vtkhdf"))
with h5py.File(path("level_2.vtkhdf"), "r") as one, h5py.File(path("levels_1.vtkhdf"), "r") as all_levels:
    level = all_levels["DSM/Levels/2/VTKHDF/PointData/convert"]
    check(np.array_equal(one["VTKHDF/PointData/convert"], level, equal_nan=True), "a level is read")
done = convert("--quiet", "--level", 4, path("levels_1.vtkhdf"), path("none.vtkhdf"))
check(done.returncode != 0 and "has no level 4; valid levels are 0 to 3" in done.stderr,
      "one that is not there is named")

# Integers are rounded, vectors go by component, cells have that at their center; the direction counts.
done = convert("--quiet", "--levels", 1, "--brick", 4, path("image.vtkhdf"), path("arrays_levels.vtkhdf"))
check(done.returncode == 0, f"levels of several arrays {done.stderr}")
with h5py.File(path("arrays_levels.vtkhdf"), "r") as file:
    fine, coarse = file["VTKHDF"], file["DSM/Levels/1/VTKHDF"]
    for name in ("PointData/f", "PointData/v"):
        mean = reduce(fine[name][...].astype("f8"))
        kind = fine[name].dtype
        mean = np.rint(mean).astype(kind) if kind.kind in "iu" else mean.astype(kind)
        check(np.array_equal(coarse[name][...], mean), f"{name} ({kind}) of a level")
    check(np.array_equal(coarse["CellData/c"][...], fine["CellData/c"][1::2, 1::2, 1::2]), "cells of a level")
    first = fine.attrs["WholeExtent"][::2] + 0.5
    place = fine.attrs["Origin"] + fine.attrs["Direction"].reshape(3, 3) @ (fine.attrs["Spacing"] * first)
    check(np.allclose(coarse.attrs["Origin"], place, 1e-14, 1e-14), "where a turned level is")

# It is killed, and goes on, with another number of ranks.
big = np.arange(160 * 160 * 160, dtype="float32").reshape(160, 160, 160)
big.tofile(path("big.raw"))
BIG = ["--quiet", "--raw-size", "160,160,160", "--raw-type", "float32", path("big.raw"),
       path("big.vtkhdf")]


def get_chunks():
    try:
        with open(path("big.vtkhdf.part.json")) as file:
            return json.load(file)["chunks"][0]
    except (OSError, ValueError):
        return 0


def kill_after(chunks, what=None):
    process = subprocess.Popen(command(1, "--memory", 2, *(what or BIG)))
    deadline = time.monotonic() + 60
    while get_chunks() < chunks and process.poll() is None and time.monotonic() < deadline:
        time.sleep(0.002)
    process.send_signal(signal.SIGKILL)
    return process.wait() == -signal.SIGKILL


def kill_in_levels():
    process = subprocess.Popen(command(1, "--memory", 2, "--levels", "all", *BIG))
    deadline = time.monotonic() + 60
    while not os.path.exists(path("big.vtkhdf.part.level1")) and process.poll() is None and time.monotonic() < deadline:
        time.sleep(0.001)
    process.send_signal(signal.SIGKILL)
    return process.wait() == -signal.SIGKILL


def compare_big(what):
    with h5py.File(path("big.vtkhdf"), "r") as file:
        check(np.array_equal(file["VTKHDF/PointData/big"], big), f"{what}: every value")
        ranges = np.array(read_brick_ranges(file["DSM/PointData/big"], big.shape, 16))
        check((ranges[:, 0] == big[::16, ::16, ::16].ravel()).all(), f"{what}: every brick's least value")


for name in glob.glob(path("big.vtkhdf*")):
    os.remove(name)
check(kill_after(200) and kill_after(400), "it is killed twice")
before = get_chunks()
check(400 <= before < 1000, f"{before} chunks of 1000 are kept")
with open(path("big.vtkhdf.part"), "rb") as file:
    kept = file.read(1 << 20)
done = convert(*BIG, ranks=2)
check(done.returncode == 0, f"a later call goes on {done.stderr}")
compare_big("going on")
os.remove(path("big.vtkhdf"))

# What is not whole, or of other values, is begun anew.
check(kill_after(100), "it is killed again")
with open(path("big.vtkhdf.part.json")) as file:
    state = json.load(file)
state["whole"] = False
with open(path("big.vtkhdf.part.json"), "w") as file:
    json.dump(state, file)
with open(path("big.vtkhdf.part"), "r+b") as file:
    file.write(bytes(1 << 16))
done = convert(*BIG)
check(done.returncode == 0, f"what is damaged is begun anew {done.stderr}")
compare_big("begun anew")
os.remove(path("big.vtkhdf"))
check(kill_after(100), "it is killed once more")
big += 1
big.tofile(path("big.raw"))
done = convert(*BIG)
check(done.returncode == 0, f"other values are begun anew {done.stderr}")
compare_big("other values")
os.remove(path("big.vtkhdf"))

# Arrays whose names look alike when they are written are told apart.
with h5py.File(path("alike.h5"), "w") as file:
    file["p/a"], file["p_a"] = big, big + 1
check(kill_after(100, ["--quiet", "--dataset", "p/a", path("alike.h5"), path("big.vtkhdf")]),
      "it is killed with one of two arrays")
done = convert("--quiet", "--dataset", "p_a", path("alike.h5"), path("big.vtkhdf"))
with h5py.File(path("big.vtkhdf"), "r") as file:
    check(np.array_equal(file["VTKHDF/PointData/p_a"][...], big + 1), f"the other one is begun anew {done.stderr}")
os.remove(path("big.vtkhdf"))
done = convert("--quiet", path("alike.h5"), path("big.vtkhdf"))
check(done.returncode == 1 and "'p/a' and 'p_a' would both be named 'p_a'" in done.stderr,
      f"both: {done.stderr.strip()}")

# What is read is not written over, whatever is named.
for name, origin in (("detached.nhdr", "detached.raw"), ("detached.mhd", "detached.bin"),
                     ("raw_float32.zarr", "raw_float32.zarr/0.0.0"),
                     ("origins/virtual.h5", "origins/a.bin"), ("origins/link.h5", "origins/d.bin")):
    before = open(path(origin), "rb").read()
    done = convert("--quiet", path(name), path(origin))
    check(done.returncode == 1 and "would overwrite the source" in done.stderr, f"{name}: {done.stderr.strip()}")
    check(open(path(origin), "rb").read() == before, f"{origin} is as it was")

# Levels go on, too, or are made anew with what they are of.
check(kill_in_levels(), "it is killed with one level there")
kept = os.stat(path("big.vtkhdf.part.level1"))
done = convert("--levels", "all", *BIG, ranks=2)
check(done.returncode == 0 and glob.glob(path("big.vtkhdf.*")) == [], f"it goes on {done.stderr}")
with h5py.File(path("big.vtkhdf"), "r") as file:
    level = file["DSM/Levels/1/VTKHDF/PointData/big"][...]
    check(np.array_equal(level, reduce(big.astype("f8")).astype("f4")), "a level that was there")
    check(len(file["DSM/Levels"]) == 4, "and the others")
compare_big("with levels")
os.remove(path("big.vtkhdf"))
check(kill_in_levels(), "it is killed with one level there")
big += 1
big.tofile(path("big.raw"))
done = convert("--levels", "all", *BIG)
with h5py.File(path("big.vtkhdf"), "r") as file:
    level = file["DSM/Levels/1/VTKHDF/PointData/big"][...]
    check(np.array_equal(level, reduce(big.astype("f8")).astype("f4")), "a level of other values")
os.remove(path("big.vtkhdf"))

# One at a time, and only what is a file, or will be.
first = subprocess.Popen(command(1, "--memory", 2, *BIG), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
while first.poll() is None and not os.path.exists(path("big.vtkhdf.part.json")):
    time.sleep(0.002)
first.send_signal(signal.SIGSTOP)
second = convert(*BIG)
first.send_signal(signal.SIGCONT)
check(second.returncode == 1 and "is being written by another process" in second.stderr,
      f"two at a time: {second.stderr.strip()}")
check(first.wait(100) == 0, f"the first goes on: {first.stderr.read().strip()}")
compare_big("of the first of two")
os.remove(path("big.vtkhdf"))
os.mkfifo(path("pipe"))
for place, words in ((FOLDER, "a folder or a device"), (path("pipe"), "a folder or a device"),
                     ("", "name of the file to write is empty")):
    done = convert(*BIG[:-1], place)
    check(done.returncode == 1 and words in done.stderr, f"to '{place}': {done.stderr.strip()}")
os.remove(path("pipe"))
# In another byte order, they are other values.
check(kill_after(100), "it is killed once more")
swapped = convert("--raw-big-endian", *BIG)
check(swapped.returncode == 0, f"then of other bytes {swapped.stderr}")
with h5py.File(path("big.vtkhdf"), "r") as file:
    check(np.array_equal(file["VTKHDF/PointData/big"][...], big.view(">f4").astype("<f4"), equal_nan=True),
          "all values are the other ones")
os.remove(path("big.vtkhdf"))

# A disk that is full: one of 12 MiB that only this call sees, where the system lets us make one.
small = path("small")
os.makedirs(small, exist_ok=True)
IN_SMALL = ["unshare", "--user", "--map-root-user", "--mount", "sh", "-c",
            f'mount -t tmpfs -o size=12m none "{small}" && "$@"; code=$?; ls "{small}"; cat "{small}"/*.json; '
            f'mount -o remount,size=200m none "{small}"; "$@" > /dev/null || exit 2; ls "{small}"; exit $code', "sh"]
if subprocess.run([*IN_SMALL, "true"], capture_output=True).returncode == 0:
    done = subprocess.run([*IN_SMALL, *command(1, "--memory", 2, *BIG[:-1], os.path.join(small, "big.vtkhdf"))],
                          capture_output=True, text=True, timeout=100)
    check(done.returncode == 1 and "big.vtkhdf.part' cannot be written: No space left on device" in done.stderr,
          f"no room: {done.stderr.strip()}")
    names = [word for word in done.stdout.split() if word.startswith("big.vtkhdf")]
    check(names == ["big.vtkhdf.part", "big.vtkhdf.part.json", "big.vtkhdf"],
          f"half a file has no name of a whole one, until there is room: {names}")
    held = json.loads(done.stdout[done.stdout.index("{") : done.stdout.rindex("}") + 1])
    check(held["whole"] and held["chunks"][0] > 0, f"and it goes on with what it had: {held['chunks']} chunks")
    # However little is left: in the middle of the chunks, of what the library holds, of a level, or at the end.
    np.zeros((32, 32, 32), "<f4").tofile(path("little.raw"))
    LITTLE = command(1, "--quiet", "--memory", "1", "--brick", "8", "--levels", "1", "--raw-size", "32,32,32",
                     "--raw-type", "float32", path("little.raw"), os.path.join(small, "little.vtkhdf"))
    sizes = (f'for k in $(seq 8 28 1024); do mount -t tmpfs -o size="$k"k none "{small}"; '
             f'"$@"; echo $?; umount "{small}"; done')
    done = subprocess.run([*IN_SMALL[:6], sizes, "sh", *LITTLE], capture_output=True, text=True, timeout=100)
    codes, said = done.stdout.split(), done.stderr.splitlines()
    check(set(codes) == {"0", "1"} and codes.count("1") > 10, f"on disks of each size: {codes}")
    check(len(said) == codes.count("1") and all(": No space left on device" in line for line in said),
          f"each says why it ends: {set(said)}")
    os.remove(path("little.raw"))
else:
    print("not tried, since no file system can be mounted here: a full disk")
sys.stdout.flush()
os.remove(path("big.raw"))

for compression, name in (("none", "ball.vtkhdf"), ("zstd", "ball_zstd.vtkhdf"), ("deflate", "ball_deflate.vtkhdf")):
    done = convert("--quiet", "--arrays", "f", "--compression", compression, path("ball.h5"), path(name))
    check(done.returncode == 0, f"{name} is written {done.stderr}")
sys.exit(failed)
