# SPDX-License-Identifier: BSD-3-Clause
"""Makes volumes of every format, by programs other than this project's: h5py, zarr, VTK's writers and Teem.
Called as make_files.py FOLDER. FOLDER/manifest.json says what is in each. The sample at (x, y, z), component c,
channel k and step t is (3 x + 5 y + 7 z + c + 11 k + 13 t) modulo 101."""

import json
import os
import shutil
import struct
import subprocess
import sys

import h5py
import numpy as np
import zarr
from numcodecs import Blosc, GZip, Shuffle, Zlib, Zstd
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOImage import vtkMetaImageWriter
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

SIZE = (21, 13, 10)  # x, y, z
BZIP2, BLOSC = 307, 32001
folder = sys.argv[1]
shutil.rmtree(folder, ignore_errors=True)
os.makedirs(folder)
entries = []


def values(dtype, components=1, channel=0, step=0, size=SIZE):
    """z, y, x, and c when there are several."""
    z, y, x = np.meshgrid(*(np.arange(n) for n in reversed(size)), indexing="ij")
    base = 3 * x + 5 * y + 7 * z + 11 * channel + 13 * step
    if components > 1:
        base = base[..., np.newaxis] + np.arange(components)
    return (base % 101).astype(dtype)


def path(name):
    return os.path.join(folder, name)


def create_image(file, size=SIZE, version=(1, 0)):
    """The group of a VTKHDF file's image; where it is, counts from 0."""
    group = file.create_group("VTKHDF")
    group.attrs["Version"], group.attrs["Type"] = version, np.bytes_("ImageData")
    group.attrs["WholeExtent"] = [limit for n in size for limit in (0, n - 1)]
    return group


def note(name, arrays, **more):
    """arrays: name, type, components, channel, on cells, without time."""
    keys = ("name", "type", "components", "channel", "cells", "still")
    defaults = (None, None, 1, 0, False, False)
    listed = [dict(zip(keys, (*array, *defaults[len(array) :]))) for array in arrays]
    entry = {"file": name, "arrays": listed, "steps": 1, "level": 0, "dataset": "", "size": SIZE}
    entries.append({**entry, **more})


# HDF5: layouts, filters and types.
plain = {
    "contiguous": ({}, "<f4"),
    "chunked": ({"chunks": (4, 5, 8)}, "<f4"),
    "big_endian": ({"chunks": (4, 5, 8)}, ">i2"),
    "big_endian_deflate": ({"chunks": (4, 5, 8), "compression": "gzip"}, ">f8"),
    "deflate": ({"chunks": (3, 13, 21), "compression": "gzip"}, "<f8"),
    "shuffle_deflate": ({"chunks": (10, 4, 7), "compression": "gzip", "shuffle": True}, "<u2"),
    "fletcher": ({"chunks": (4, 5, 8), "fletcher32": True}, "<i4"),
    "all_filters": (
        {"chunks": (4, 5, 7), "compression": "gzip", "shuffle": True, "fletcher32": True},
        "<i8",
    ),
    # No filter of ours: the library reads it, with a plugin of Debian's.
    "bzip2": ({"chunks": (4, 5, 8), "compression": BZIP2}, "<f4"),
    "signed_char": ({}, "|i1"),
    "blosc": ({"chunks": (4, 5, 8), "compression": BLOSC}, "<f4"),
}
for name, (options, dtype) in plain.items():
    with h5py.File(path(name + ".h5"), "w") as file:
        file.create_dataset("deep/er/f", data=values(dtype), **options)
        file["other"] = np.arange(5)
    note(name + ".h5", [("deep/er/f", np.dtype(dtype).name)])

# Large ones that are not compressed: of slices a few are there.
os.makedirs(path("large"))
LARGE = {"slices": (1100, 1024, 20), "whole": (257, 260, 256), "cubes": (150, 140, 130), "big_endian": (150, 140, 130)}
chunks = {"slices": (1, 1024, 1100), "whole": None, "cubes": (120, 130, 140), "big_endian": (120, 130, 140)}
for name, size in LARGE.items():
    with h5py.File(path(f"large/{name}.h5"), "w") as file:
        kind = ">u2" if name == "big_endian" else "|u1"
        dataset = file.create_dataset("f", size[::-1], kind, chunks=chunks[name])
        for z in (3, 8) if name == "slices" else range(size[2]):
            dataset[z] = values("|u1", size=(*size[:2], 1), channel=7 * z)[0]

with h5py.File(path("large/packed.h5"), "w") as file:
    dataset = file.create_dataset("f", (40, 1024, 1024), "|u1", chunks=(1, 1024, 1024), compression="gzip")
    dataset[20] = 100

# What is not as the machine has it, the library makes so: fewer bits, half the precision, truth values.
short = h5py.h5t.STD_I16LE.copy()
short.set_precision(12)
short.set_offset(3)
stored_as = {"bits12": (short, "<i2"), "half": (h5py.h5t.IEEE_F16LE, "<f4"), "names": (h5py.h5t.py_create(np.dtype("bool"), logical=True), "|i1")}
for name, (kind, dtype) in stored_as.items():
    with h5py.File(path(name + ".h5"), "w") as file:
        whole = h5py.h5s.create_simple(SIZE[::-1])
        data = np.zeros(SIZE[::-1], bool) if name == "names" else values(dtype)
        h5py.Dataset(h5py.h5d.create(file.id, b"f", kind, whole))[...] = data
    note(name + ".h5", [("f", np.dtype(dtype).name)], **({"zeros": True} if name == "names" else {}))
# Behind a block of the user's own, as MATLAB writes it.
for name, options in (("block", {}), ("block_chunked", {"chunks": (4, 5, 8), "compression": "gzip"})):
    with h5py.File(path(name + ".h5"), "w", userblock_size=512) as file:
        file.create_dataset("f", data=values("<f4"), **options)
    note(name + ".h5", [("f", "float32")])
# Chunks at the ends that are not filtered.
with h5py.File(path("partial.h5"), "w") as file:
    creation = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    creation.set_chunk((4, 5, 8))
    creation.set_deflate(3)
    if hasattr(creation, "set_chunk_opts"):
        creation.set_chunk_opts(2)
    whole = h5py.h5s.create_simple(SIZE[::-1])
    h5py.Dataset(h5py.h5d.create(file.id, b"f", h5py.h5t.IEEE_F32LE, whole, creation))[...] = values("<f4")
note("partial.h5", [("f", "float32")])
# Values that are in another file.
with h5py.File(path("linked.bin"), "w") as file:
    file["before"] = np.zeros(1000)
    file["f"] = values("<f4")
    file.create_dataset("g", data=values("<f4"), chunks=(4, 5, 8))
with h5py.File(path("links.vtkhdf"), "w") as file:
    group = create_image(file)
    group.create_group("PointData")
    for name in "fg":
        group["PointData/" + name] = h5py.ExternalLink("linked.bin", "/" + name)
    file["filler"] = np.arange(5000.0)
note("links.vtkhdf", [("f", "float32"), ("g", "float32")])
# Likewise, in every way that there is: by a link alone, without VTK's group; in bare bytes; put together of parts.
os.makedirs(path("origins"))
for name, part in (("a.bin", values("<f4")[:4]), ("b.bin", values("<f4")[4:])):
    with h5py.File(path("origins/" + name), "w") as file:
        file["f"] = part
with h5py.File(path("origins/d.bin"), "w") as file:
    file.create_dataset("f", data=values("<f4"), chunks=(4, 5, 8), compression="gzip")
with h5py.File(path("origins/virtual.h5"), "w") as file:
    layout = h5py.VirtualLayout(SIZE[::-1], "<f4")
    layout[:4] = h5py.VirtualSource("a.bin", "f", (4, *SIZE[1::-1]))
    layout[4:] = h5py.VirtualSource("b.bin", "f", (SIZE[2] - 4, *SIZE[1::-1]))
    file.create_virtual_dataset("f", layout)
for name in ("external", "changed"):  # where bare bytes are, counts from the folder that a process is in
    values("<f4").tofile(path(f"origins/{name}.bin"))
    with h5py.File(path(f"origins/{name}.h5"), "w") as file:
        bare = [(os.path.abspath(path(f"origins/{name}.bin")), 0, h5py.h5f.UNLIMITED)]
        file.create_dataset("f", SIZE[::-1], "<f4", external=bare)
with h5py.File(path("origins/link.h5"), "w") as file:
    file["f"] = h5py.ExternalLink("d.bin", "/f")
for name in ("virtual", "external", "link"):
    note(f"origins/{name}.h5", [("f", "float32")])
# As many components as nobody would call a volume's, were it not VTK's.
with h5py.File(path("ten.vtkhdf"), "w") as file:
    group = create_image(file)
    group["PointData/f"] = values("<f4", 10)
note("ten.vtkhdf", [("f", "float32", 10)])
# What has no time beside what has.
with h5py.File(path("static.h5"), "w") as file:
    file["a"] = values("<f4")
    file["b"] = np.stack([values("<f4")] * 2)
still = (1, 0, False, True)
note("static.h5", [("a", "float32", *still), ("b", "float32", *still)], steps=2)

with h5py.File(path("vectors.h5"), "w") as file:
    file.create_dataset("v", data=values("<f4", 3), chunks=(4, 5, 8, 3))
    file.create_dataset("split", data=values("<f4", 3), chunks=(4, 5, 8, 1))
    file.create_dataset("small", data=np.zeros((2, 2, 2)))
note("vectors.h5", [("split", "float32", 3), ("v", "float32", 3)])
note("vectors.h5", [("small", "float64")], dataset="small", size=(2, 2, 2), zeros=True)

with h5py.File(path("holes.h5"), "w") as file:
    hole = file.create_dataset("f", SIZE[::-1], "<f4", chunks=(4, 5, 8), fillvalue=42.0)
    hole[0:4, 0:5, 0:8] = values("<f4")[0:4, 0:5, 0:8]
note("holes.h5", [("f", "float32")], fill=42.0, filled=[8, 5, 4])

with h5py.File(path("image.vtkhdf"), "w") as file:
    group = file.create_group("VTKHDF")
    group.attrs["Version"] = [1, 0]
    group.attrs["Type"] = np.bytes_("ImageData")
    group.attrs["WholeExtent"] = [5, 25, -3, 9, 0, 9]
    group.attrs["Origin"] = [1.0, 2.0, 3.0]
    group.attrs["Spacing"] = [0.5, 0.25, 2.0]
    group.attrs["Direction"] = [0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]
    points = group.create_group("PointData")
    points.create_dataset("f", data=values("<f4"), chunks=(4, 5, 8), compression="gzip")
    points.create_dataset("v", data=values("|u1", 3))
    cells = group.create_group("CellData")
    cells.create_dataset("c", data=values("<i2", size=(20, 12, 9)))
note(
    "image.vtkhdf",
    [("f", "float32"), ("v", "uint8", 3), ("c", "int16", 1, 0, True)],
    first=[5, -3, 0],
    origin=[1.0, 2.0, 3.0],
    spacing=[0.5, 0.25, 2.0],
    direction=[0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0],
)

# What are the scalars: of a fixed length, as VTK writes it, and as h5py does.
for name, scalars in (("scalars.vtkhdf", np.bytes_("g")), ("scalars_text.vtkhdf", "g")):
    with h5py.File(path(name), "w") as file:
        points = create_image(file).create_group("PointData")
        points.create_dataset("f", data=values("<f4"))
        points.create_dataset("g", data=values("|u1", channel=1))
        points.attrs["Scalars"] = scalars
    note(name, [("f", "float32"), ("g", "uint8", 1, 1)])

# Time steps in one file.
stacked = np.stack([values("<f4", step=t) for t in range(3)])
with h5py.File(path("steps.h5"), "w") as file:
    file.create_dataset("f", data=stacked, chunks=(2, 4, 5, 8), compression="gzip")
    file.create_dataset("whole", data=stacked)
note("steps.h5", [("f", "float32"), ("whole", "float32")], steps=3)
with h5py.File(path("steps_vectors.h5"), "w") as file:
    vectors = np.stack([values("<i2", 3, step=t) for t in range(4)])
    file.create_dataset("v", data=vectors, chunks=(1, 4, 5, 8, 3))
    file.create_dataset("by_library", data=vectors, chunks=(2, 4, 5, 8, 1))
note("steps_vectors.h5", [("by_library", "int16", 3), ("v", "int16", 3)], steps=4)


def write_steps(name, times, arrays, size):
    """VTKHDF; arrays: name, values of the frames, and of each step its frame, or None."""
    with h5py.File(path(name), "w") as file:
        group = create_image(file, size, (2, 0))
        group.attrs["Origin"] = [0.0, 0.0, 0.0]
        group.attrs["Spacing"] = [1.0, 1.0, 1.0]
        group.attrs["Direction"] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
        steps = group.create_group("Steps")
        steps.attrs["NSteps"] = len(times)
        steps["Values"] = np.array(times, "<f8")
        for array, frames, offsets in arrays:
            group.create_dataset(f"PointData/{array}", data=frames, chunks=(1, 4, 5, 8))
            if offsets:
                steps[f"PointDataOffsets/{array}"] = offsets


swapped = stacked[[1, 0, 2]]
write_steps("steps.vtkhdf", [0.5, 1.0, 4.0], [("f", swapped, [1, 0, 2]), ("g", stacked, None)], SIZE)
write_steps("descending.vtkhdf", [4.0, 1.0, 0.5], [("f", stacked, None)], SIZE)
note("steps.vtkhdf", [("f", "float32"), ("g", "float32")], steps=3)

# Zarr, version 2, by either version of its library.
LATER = {} if hasattr(zarr, "DirectoryStore") else {"zarr_format": 2}


def save_zarr(name, data, separator=".", compressor="default", **options):
    if LATER:
        encoding = {"name": "v2", "separator": separator}
        compressor = "auto" if compressor == "default" else compressor
        zarr.create_array(path(name), data=data, compressors=compressor, chunk_key_encoding=encoding, **LATER, **options)
        return
    store = zarr.DirectoryStore(path(name), dimension_separator=separator)
    zarr.save_array(store, data, compressor=compressor, dimension_separator=separator, **options)


compressors = {
    "raw": None,
    "blosc_lz4": Blosc("lz4", shuffle=Blosc.SHUFFLE),
    "blosc_zstd": Blosc("zstd", shuffle=Blosc.BITSHUFFLE),
    "zlib": Zlib(),
    "gzip": GZip(),
    "zstd": Zstd(),
}
for name, compressor in compressors.items():
    for dtype, separator in (("<f4", "."), (">u2", "/")):
        file = f"{name}_{np.dtype(dtype).name}.zarr"
        save_zarr(file, values(dtype), separator, compressor, chunks=(4, 5, 8))
        note(file, [(file[: -len(".zarr")], np.dtype(dtype).name)])
save_zarr("shuffled.zarr", values("<f8"), compressor=Zlib(), chunks=(4, 5, 8), filters=[Shuffle(8)])
note("shuffled.zarr", [("shuffled", "float64")])
# What is packed and does not shrink is packed again.
for name, inner, outer in (("packed_zlib", Zlib(0), Zstd()), ("packed_gzip", GZip(0), Blosc("lz4"))):
    save_zarr(f"{name}.zarr", values("|u1"), compressor=outer, chunks=(4, 5, 8), filters=[inner])
    note(f"{name}.zarr", [(name, "uint8")])
slices = np.zeros(LARGE["slices"][::-1], "u1")
for z in (3, 8):
    slices[z] = values("|u1", size=(*LARGE["slices"][:2], 1), channel=7 * z)[0]
save_zarr("large/slices.zarr", slices, compressor=None, chunks=chunks["slices"])
zarr.open_group(path("group.zarr"), mode="w", **LATER)
save_zarr("group.zarr/a", values("|u1"), chunks=(10, 13, 21))
save_zarr("group.zarr/b", values("<f4", channel=2), chunks=(4, 5, 8))
save_zarr("group.zarr/line", np.arange(4), chunks=(4,))
note("group.zarr", [("a", "uint8"), ("b", "float32", 1, 2)])
hole = zarr.open_array(
    path("holes.zarr"), mode="w", shape=SIZE[::-1], chunks=(4, 5, 8), dtype="<f4", fill_value=42.0, **LATER
)
hole[0:4, 0:5, 0:8] = values("<f4")[0:4, 0:5, 0:8]
note("holes.zarr", [("holes", "float32")], fill=42.0, filled=[8, 5, 4])

# The first axis fastest within chunks; axes that are named x, y, z; both.
for name, order, turned in (("fortran", "F", False), ("from_x", "C", True), ("both", "F", True)):
    data = values("<f4")
    save_zarr(f"{name}.zarr", data.T if turned else data, compressor=Zlib(), chunks=(8, 5, 4), order=order)
    names = {"_ARRAY_DIMENSIONS": list("xyz" if turned else "zyx")}
    with open(path(f"{name}.zarr/.zattrs"), "w", encoding="utf-8") as file:
        json.dump(names, file)
    note(f"{name}.zarr", [(name, "float32")])
# Names in capitals, and such as only say where x, y or z is.
for name, names in (("capitals", "XYZ"), ("capitals_z", "ZYX"), ("x_first", ["x", "lat", "lon"]), ("unknown", ["time_of_day", "lat", "dim_2"])):
    turned = names[0] in "Xx"
    data = values("<f4")
    save_zarr(f"{name}.zarr", data.T if turned else data, chunks=(8, 5, 4))
    with open(path(f"{name}.zarr/.zattrs"), "w", encoding="utf-8") as file:
        json.dump({"_ARRAY_DIMENSIONS": list(names)}, file)
    note(f"{name}.zarr", [(name, "float32")])
# The components of a sample on a last axis, which its name tells; the second one has x, y, z before it.
for name, names in (("components", ["z", "y", "x", "channel"]), ("components_x", "XYZC"), ("components_steps", ["time", "z", "y", "x", "c"])):
    data, chunk = values("<i2", 3), (4, 5, 8, 3)
    if names == "XYZC":
        data, chunk = data.transpose(2, 1, 0, 3), (8, 5, 4, 3)
    elif len(names) == 5:
        data, chunk = np.stack([values("<i2", 3, step=t) for t in range(3)]), (2, *chunk)
    save_zarr(f"{name}.zarr", data, chunks=chunk)
    with open(path(f"{name}.zarr/.zattrs"), "w", encoding="utf-8") as file:
        json.dump({"_ARRAY_DIMENSIONS": list(names)}, file)
    note(f"{name}.zarr", [(name, "int16", 3)], steps=3 if len(names) == 5 else 1)
hole = zarr.open_array(
    path("components_holes.zarr"), mode="w", shape=(*SIZE[::-1], 2), chunks=(4, 5, 8, 2), dtype=">f4", fill_value=42.0, **LATER
)
hole[0:4, 0:5, 0:8] = values("<f4", 2)[0:4, 0:5, 0:8]
hole.attrs["_ARRAY_DIMENSIONS"] = ["z", "y", "x", "c"]
note("components_holes.zarr", [("components_holes", "float32", 2)], fill=42.0, filled=[8, 5, 4])
# As xarray writes it: times, texts beside the volume, and numbers that JSON does not have.
zarr.open_group(path("xarray.zarr"), mode="w", **LATER)
save_zarr("xarray.zarr/f", np.stack([values("<f4", step=t) for t in range(3)]), chunks=(1, 10, 13, 21))
save_zarr("xarray.zarr/still", values("|u1"), chunks=(10, 13, 21))
save_zarr("xarray.zarr/times", np.array(["one", "two"]), chunks=(2,))
save_zarr("xarray.zarr/film", np.zeros((40, 20, 30), "|u1"), chunks=(1, 20, 30))
for name, text in (
    ("", '{"missing": NaN, "least": -Infinity}'),
    ("/f", '{"_ARRAY_DIMENSIONS": ["Time", "z", "y", "x"]}'),
    ("/film", '{"_ARRAY_DIMENSIONS": ["time", "y", "x"]}'),
):
    with open(path(f"xarray.zarr{name}/.zattrs"), "w", encoding="utf-8") as file:
        file.write(text)
note("xarray.zarr", [("f", "float32"), ("still", "uint8", 1, 0, False, True)], steps=3)
# Nested chunks, as old stores have them, without a word.
save_zarr("nested.zarr", values("<f4"), "/", chunks=(4, 5, 8))
with open(path("nested.zarr/.zarray"), encoding="utf-8") as file:
    metadata = json.load(file)
metadata.pop("dimension_separator", None)
with open(path("nested.zarr/.zarray"), "w", encoding="utf-8") as file:
    json.dump(metadata, file)
note("nested.zarr", [("nested", "float32")])
# Labels that are alike, transformations of the level and of all, two axes that are neither time nor space.
group = zarr.open_group(path("labels.zarr"), mode="w", **LATER)
save_zarr("labels.zarr/0", np.stack([np.stack([values("<u2", channel=3 * p + k) for k in range(3)]) for p in range(2)]), chunks=(1, 2, 4, 5, 8))
axes = [{"name": "phase", "type": "other"}, {"name": "c", "type": "channel"}]
axes += [{"name": name, "type": "space"} for name in "zyx"]


def transform(scale, translation):
    ones, zeros = [1, 1], [0, 0]
    return [{"type": "scale", "scale": ones + scale}, {"type": "translation", "translation": zeros + translation}]


group.attrs["multiscales"] = [
    {
        "version": "0.4",
        "axes": axes,
        "coordinateTransformations": transform([10, 10, 10], [100, 200, 300]),
        "datasets": [{"path": "0", "coordinateTransformations": transform([2, 3, 4], [1, 2, 3])}],
    }
]
group.attrs["omero"] = {"channels": [{"label": "same"}, {"label": "same"}, {"label": None}]}
labels = ["same", "same 1", "channel 2", "channel 3", "channel 4", "channel 5"]
note(
    "labels.zarr", [(label, "uint16", 1, channel) for channel, label in enumerate(labels)],
    spacing=[40.0, 30.0, 20.0], origin=[330.0, 220.0, 110.0],
)

# Channels that are behind space, as nobody should write them, and some do.
group = zarr.open_group(path("ome_last.zarr"), mode="w", **LATER)
save_zarr("ome_last.zarr/0", values("|u1", 3), chunks=(4, 13, 21, 3))
group.attrs["multiscales"] = [
    {
        "version": "0.4",
        "axes": [*({"name": name, "type": "space"} for name in "zyx"), {"name": "c", "type": "channel"}],
        "datasets": [{"path": "0", "coordinateTransformations": [{"type": "scale", "scale": [4, 2, 1, 1]}]}],
    }
]
note("ome_last.zarr", [("values", "uint8", 3)], spacing=[1.0, 2.0, 4.0])

# OME-Zarr: two channels, three times, two scales.
group = zarr.open_group(path("ome.zarr"), mode="w", **LATER)
full = np.stack(
    [np.stack([values("<u2", channel=k, step=t) for k in range(2)]) for t in range(3)]
)
save_zarr("ome.zarr/0", full, "/", chunks=(1, 2, 4, 5, 8))
coarse = full[..., ::2, ::2, ::2]
save_zarr("ome.zarr/1", coarse, "/", chunks=(3, 1, 5, 7, 11))
axes = [{"name": "t", "type": "time"}, {"name": "c", "type": "channel"}]
axes += [{"name": name, "type": "space"} for name in "zyx"]
scales = [[1, 1, 4, 2, 1], [1, 1, 8, 4, 2]]
group.attrs["multiscales"] = [
    {
        "version": "0.4",
        "axes": axes,
        "datasets": [
            {
                "path": str(level),
                "coordinateTransformations": [{"type": "scale", "scale": scale}],
            }
            for level, scale in enumerate(scales)
        ],
    }
]
group.attrs["omero"] = {"channels": [{"label": "red"}, {"label": "green"}]}
channels = [("red", "uint16", 1, 0), ("green", "uint16", 1, 1)]
note("ome.zarr", channels, steps=3, spacing=[1.0, 2.0, 4.0], levels=2)
note(
    "ome.zarr", channels, steps=3, spacing=[2.0, 4.0, 8.0], levels=2, level=1, size=(11, 7, 5), stride=2
)


# Zarr, version 3, which zarr 2 cannot write: by hand, after the specification.
def write_version3(name, codecs, chunk, shard=None, orders=(), components=1):
    data = values("<f4", components)
    os.makedirs(path(name))
    encode = {
        "gzip": lambda raw: GZip().encode(raw),
        "zstd": lambda raw: bytes(Zstd().encode(raw)),
        "blosc": lambda raw: bytes(Blosc("lz4").encode(raw)),
    }
    inner = [{"name": "transpose", "configuration": {"order": order}} for order in orders]
    inner += [{"name": "bytes", "configuration": {"endian": "little"}}]
    inner += [{"name": codec, "configuration": {}} for codec in codecs]
    outer = inner
    if shard:
        index_codecs = [{"name": "bytes", "configuration": {"endian": "little"}}, {"name": "crc32c"}]
        outer = [
            {
                "name": "sharding_indexed",
                "configuration": {
                    "chunk_shape": chunk,
                    "codecs": inner,
                    "index_codecs": index_codecs,
                    "index_location": "end",
                },
            }
        ]
    metadata = {
        "zarr_format": 3,
        "node_type": "array",
        "shape": data.shape,
        "data_type": "float32",
        "chunk_grid": {"name": "regular", "configuration": {"chunk_shape": shard or chunk}},
        "chunk_key_encoding": {"name": "default", "configuration": {"separator": "/"}},
        "fill_value": "NaN",
        "codecs": outer,
        "attributes": {},
    }
    if components > 1:
        metadata["dimension_names"] = ["z", "y", "x", "channel"]
    with open(path(name + "/zarr.json"), "w", encoding="utf-8") as file:
        json.dump(metadata, file)

    def cut(first, shape):
        whole = np.zeros(shape, "<f4")
        part = data[tuple(slice(f, f + n) for f, n in zip(first, shape))]
        whole[tuple(slice(0, n) for n in part.shape)] = part
        for order in orders:
            whole = whole.transpose(order)
        raw = whole.tobytes()
        for codec in codecs:
            raw = encode[codec](raw)
        return raw

    outer_shape = shard or chunk
    for place in np.ndindex(*(-(-n // s) for n, s in zip(data.shape, outer_shape))):
        first = [p * s for p, s in zip(place, outer_shape)]
        if shard:
            blob, index = b"", b""
            for within in np.ndindex(*(s // c for s, c in zip(shard, chunk))):
                start = [f + w * c for f, w, c in zip(first, within, chunk)]
                if any(at >= n for at, n in zip(start, data.shape)):
                    index += struct.pack("<QQ", 2**64 - 1, 2**64 - 1)
                    continue
                raw = cut(start, chunk)
                index += struct.pack("<QQ", len(blob), len(raw))
                blob += raw
            blob += index + struct.pack("<I", crc32c(index))
        else:
            blob = cut(first, chunk)
        file = path(name + "/c/" + "/".join(map(str, place)))
        os.makedirs(os.path.dirname(file), exist_ok=True)
        with open(file, "wb") as out:
            out.write(blob)
    note(name, [(name[: -len(".zarr")], "float32", components)])


def crc32c(raw):
    value = 0xFFFFFFFF
    for byte in raw:
        value ^= byte
        for _ in range(8):
            value = (value >> 1) ^ (0x82F63B78 if value & 1 else 0)
    return value ^ 0xFFFFFFFF


write_version3("three_raw.zarr", [], [4, 5, 8])
write_version3("three_zstd.zarr", ["zstd"], [4, 5, 8])
write_version3("three_sharded.zarr", ["blosc"], [2, 5, 4], [4, 10, 8])
write_version3("three_sharded_gzip.zarr", ["gzip"], [4, 5, 8], [4, 5, 8])
write_version3("three_components.zarr", ["zstd"], [4, 5, 8, 2], components=2)
write_version3("three_components_sharded.zarr", ["blosc"], [2, 5, 4, 2], [4, 10, 8, 2], components=2)
# Axes that are transposed, and again: to the order of C, or of Fortran.
turn, around = [2, 1, 0], [1, 2, 0]
for name, orders in (("turned", [turn]), ("twice", [turn, turn]), ("still", [turn, [0, 1, 2]]), ("around", [around] * 3)):
    write_version3(f"three_{name}.zarr", [], [4, 5, 8], None, orders)
    write_version3(f"three_{name}_sharded.zarr", ["zstd"], [2, 5, 4], [4, 10, 8], orders)

# VTK's MetaImage.
image = vtkImageData()
image.SetDimensions(*SIZE)
image.SetSpacing(0.5, 0.25, 2.0)
image.SetOrigin(1.0, 2.0, 3.0)
image.GetPointData().SetScalars(numpy_to_vtk(values("<i2").ravel(), deep=True))
for name in ("attached.mha", "detached.mhd"):
    writer = vtkMetaImageWriter()
    writer.SetInputData(image)
    writer.SetCompression(False)
    writer.SetFileName(path(name))
    if name.endswith("mhd"):
        writer.SetRAWFileName(path("detached.bin"))
    writer.Write()
    note(name, [("values", "int16")], spacing=[0.5, 0.25, 2.0], origin=[1.0, 2.0, 3.0])

# Teem's NRRD.
unu = shutil.which("teem-unu") or shutil.which("unu")
for name, dtype, teem, endian in (
    ("attached.nrrd", "<f4", "float", "little"),
    ("detached.nhdr", ">u2", "ushort", "big"),
):
    raw = path(name + ".bin")
    values(dtype.replace(">", "<")).tofile(raw)
    make = [unu, "make", "-i", raw, "-t", teem, "-s", *map(str, SIZE), "-e", "raw", "-en", "little"]
    save = [unu, "save", "-f", "nrrd", "-e", "raw", "-en", endian, "-o", path(name)]
    made = subprocess.run(make, stdout=subprocess.PIPE, check=True).stdout
    subprocess.run(save, input=made, check=True)
    os.remove(raw)
    note(name, [("values", np.dtype(dtype).name)])

# Headers as people write them.
values("<f4").tofile(path("headers.bin"))
values("<i2", 3).tofile(path("components.bin"))
with open(path("skipped.bin"), "wb") as file:
    file.write(b"a line\nanother\n" + b"." * 16 + values("<f4").tobytes())
flat = np.ascontiguousarray(values("|u1", 3)[:1])
flat.tofile(path("flat.bin"))
headers = {
    "blanks.nhdr": (
        "type: float\ndimension: 3\nsizes: 21 13 10\nspace dimension: 3\ncontent:\nkey:=value\ntype:=large\n"
        "space directions: (0, 2, 0) ( -3, 0, 0 ) (0,0,4)\nspace origin: (10, 20, 30)\ndata file: headers.bin\n",
        [("values", "float32")],
        {
            "origin": [10.0, 20.0, 30.0],
            "spacing": [2.0, 3.0, 4.0],
            "direction": [0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0],
        },
    ),
    "joined.nhdr": (
        "type: float\ndimension: 3\nsizes: 21 13 10\nspacings: 1.5 -2 2\naxismins: 1 2 3\n"
        "centers: node node cell\ndatafile: skipped.bin\nbyteskip: -1\n",
        [("values", "float32")],
        {
            "origin": [1.0, 2.0, 4.0],
            "spacing": [1.5, 2.0, 2.0],
            "direction": [1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 1.0],
        },
    ),
    "kinds.nhdr": (
        "type: int16\ndimension: 4\nsizes: 3 21 13 10\nkinds: vector domain domain domain\ndata file: components.bin\n",
        [("values", "int16", 3)],
        {},
    ),
    "flat.nhdr": (
        "type: uchar\ndimension: 3\nsizes: 3 21 13\nkinds: RGB-color domain domain\ndata file: flat.bin\n",
        [("values", "uint8", 3)],
        {"size": (21, 13, 1)},
    ),
}
for name, (text, arrays, more) in headers.items():
    with open(path(name), "w", encoding="utf-8") as file:
        file.write("NRRD0005\nendian: little\nencoding: raw\n" + text)
    note(name, arrays, **more)
for name, text in (
    ("colons.mhd", "ElementType : MET_FLOAT\nElementDataFile : headers.bin\n"),
    ("big.mhd", "ElementByteOrderMSB = T\nElementType = MET_LONG\nElementDataFile = big.bin\n"),
):
    values(">i4").tofile(path("big.bin"))
    with open(path(name), "w", encoding="utf-8") as file:
        file.write("NDims = 3\nDimSize = 21 13 10\n" + text)
    note(name, [("values", "float32" if "colons" in name else "int32")])

with open(path("backwards.mhd"), "w", encoding="utf-8") as file:
    file.write("NDims = 3\nDimSize = 21 13 10\nElementType = MET_FLOAT\nElementSpacing = 1 -2 3\nElementDataFile = headers.bin\n")
note("backwards.mhd", [("values", "float32")], spacing=[1.0, 2.0, 3.0])

# Of what a header says of its own size, MetaIO makes a place in the file, also where the values follow it.
for name, size, between in (("skip.mha", 300, 300), ("skip_all.mha", -1, 200)):
    header = f"NDims = 3\nDimSize = 21 13 10\nElementType = MET_SHORT\nHeaderSize = {size}\nElementDataFile = LOCAL\n"
    with open(path(name), "wb") as file:
        file.write(header.encode().ljust(between, b"y") + values("<i2").tobytes())
    note(name, [("values", "int16")])
# Bare values.
with open(path("bare.raw"), "wb") as file:
    file.write(b"a header of 21 bytes.")
    file.write(values(">i4").tobytes())
note(
    "bare.raw",
    [("values", "int32")],
    raw={"type": "int32", "big": True, "header": 21, "spacing": [1.0, 1.0, 3.0]},
    spacing=[1.0, 1.0, 3.0],
)

# A ball, to be looked at: distance from the middle, 1 at the nearest face.
edges = (48, 40, 36)
z, y, x = np.meshgrid(*(np.linspace(-1, 1, n) for n in reversed(edges)), indexing="ij")
ball = np.sqrt(x * x + y * y + z * z).astype("<f4")
with h5py.File(path("ball.h5"), "w") as file:
    file.create_dataset("f", data=ball, chunks=(16, 10, 13), compression="gzip", shuffle=True)
save_zarr("ball.zarr", ball, compressor=Blosc("zstd"), chunks=(9, 40, 20))
image = vtkImageData()
image.SetDimensions(*edges)
image.GetPointData().SetScalars(numpy_to_vtk(ball.ravel(), deep=True))
writer = vtkMetaImageWriter()
writer.SetInputData(image)
writer.SetCompression(False)
writer.SetFileName(path("ball.mha"))
writer.Write()


def write_series(name, frames, **others):
    """Of each frame a file with a header, and one for ParaView's own reader, which has further arrays, too."""
    for number, frame in enumerate(frames):
        file = f"{name}_{number:03}"
        frame.tofile(path(file + ".bin"))
        with open(path(file + ".nhdr"), "w", encoding="utf-8") as header:
            header.write("NRRD0004\ntype: float\ndimension: 3\nsizes: {2} {1} {0}\n".format(*frame.shape))
            header.write(f"endian: little\nencoding: raw\ndata file: {file}.bin\n")
        image.SetDimensions(*reversed(frame.shape))
        image.GetPointData().SetScalars(numpy_to_vtk(frame.ravel(), deep=True))
        image.GetPointData().GetScalars().SetName("values")
        for other, values_of_frames in others.items():
            array = numpy_to_vtk(values_of_frames[number].ravel(), deep=True)
            array.SetName(other)
            image.GetPointData().AddArray(array)
        writer = vtkXMLImageDataWriter()
        writer.SetInputData(image)
        writer.SetFileName(path(file + ".vti"))
        writer.Write()


# A ball that changes with time: files of four steps, and one of all.
steps = [(ball * (1 + 0.2 * t) + 0.05 * t * x).astype("<f4") for t in range(4)]
write_series("play", steps)
write_steps("play.vtkhdf", [0.0, 1.0, 2.0, 3.0], [("values", np.stack(steps), None)], edges)

# A ball of which little changes from step to step: bricks at one corner; the third step is as the second.
edges = (81, 81, 81)
z, y, x = np.meshgrid(*(np.linspace(-1, 1, n) for n in reversed(edges)), indexing="ij")
ball = np.sqrt(x * x + y * y + z * z).astype("<f4")
steps = [ball.copy() for _ in range(4)]
for step, more in zip(steps, (0.0, 0.05, 0.05, 0.1)):
    step[50:63, 50:63, 50:63] += np.float32(more)
write_series("calm", steps)
tints = [(x + 0.3 * t).astype("<f4") for t in range(4)]
write_series("tinted", steps, tint=tints)
stacks = [("values", np.stack(steps), None), ("tint", np.stack(tints), None)]
write_steps("tinted.vtkhdf", [0.0, 1.0, 2.0, 3.0], stacks, edges)

with open(path("manifest.json"), "w", encoding="utf-8") as file:
    json.dump(entries, file, indent=1)
print(len(entries), "volumes")
