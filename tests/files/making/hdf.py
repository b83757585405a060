# SPDX-License-Identifier: BSD-3-Clause
"""HDF5 by h5py: layouts, filters, types, VTK's images and time steps. Importing it makes the files."""

import os
import zlib

import h5py
import numpy as np

from making.volumes import SIZE, create_image, note, path, values

BZIP2, BLOSC, LZ4, ZFP = 307, 32001, 32004, 32013

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
    "bzip2": ({"chunks": (4, 5, 8), "compression": BZIP2}, "<f4"),
    # In blocks of 512 bytes; without the number the whole chunk is a block.
    "lz4": ({"chunks": (4, 5, 8), "compression": LZ4, "compression_opts": (512,)}, "<f4"),
    "lz4_whole": ({"chunks": (4, 5, 8), "compression": LZ4}, ">u2"),
    # The HDF5 library reads these filters. Lossless zfp needs Debian's plugin.
    "scale_offset": ({"chunks": (4, 5, 8), "scaleoffset": 0}, "<i4"),
    "zfp": ({"chunks": (4, 5, 8), "compression": ZFP, "compression_opts": (5, 0, 0, 0, 0, 0)}, "<f4"),
    "signed_char": ({}, "|i1"),
    "blosc": ({"chunks": (4, 5, 8), "compression": BLOSC}, "<f4"),
}
for name, (options, dtype) in plain.items():
    with h5py.File(path(name + ".h5"), "w") as file:
        file.create_dataset("deep/er/f", data=values(dtype), **options)
        file["other"] = np.arange(5)
    note(name + ".h5", [("deep/er/f", np.dtype(dtype).name)])

# Rounded values, which need not be undone, whether or not there is a plugin of the filter.
for name, rounding in (("bit_groom", 32022), ("granular_bit_round", 32023)):
    with h5py.File(path(name + ".h5"), "w") as file:
        creation = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
        creation.set_chunk(SIZE[::-1])
        creation.set_filter(rounding, h5py.h5z.FLAG_OPTIONAL, (3, 4, 0, 0, 0))
        creation.set_deflate(1)
        whole = h5py.h5s.create_simple(SIZE[::-1])
        dataset = h5py.h5d.create(file.id, b"f", h5py.h5t.IEEE_F32LE, whole, creation)
        dataset.write_direct_chunk((0, 0, 0), zlib.compress(values("<f4").tobytes()))
    note(name + ".h5", [("f", "float32")])

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
stored_as = {"bits12": (short, "<i2"), "half": (h5py.h5t.IEEE_F16LE, "<f4"),
             "names": (h5py.h5t.py_create(np.dtype("bool"), logical=True), "|i1")}
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
    file["group"] = h5py.ExternalLink("d.bin", "/")
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
