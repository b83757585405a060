# SPDX-License-Identifier: BSD-3-Clause
"""HDF5 by h5py: every layout and index of chunks, filters, types, values elsewhere, and VTK's images."""

import h5py
import numpy as np

from seeds.common import SHAPE, path, values

# By default, h5py writes the older structures, which have no checksums: most changes of them reach the reader.
EARLIEST, LATEST = {}, {"libver": "latest"}
DATASETS = {
    "contiguous": (EARLIEST, {"data": values()}),
    "big_endian": (EARLIEST, {"data": values(">i2"), "chunks": (3, 2, 5)}),
    "chunked": (EARLIEST, {"data": values(), "chunks": (2, 3, 2)}),
    "deflate": (EARLIEST, {"data": values("<u2"), "chunks": (3, 4, 5), "compression": "gzip", "shuffle": True}),
    "fletcher": (EARLIEST, {"data": values("|u1"), "chunks": (3, 4, 5), "fletcher32": True, "compression": "gzip"}),
    "tree": (EARLIEST, {"data": values("|u1", (9, 8, 8)), "chunks": (1, 1, 1)}),
    "steps": (EARLIEST, {"data": values("|u1", (3, *SHAPE)), "chunks": (2, 3, 4, 5)}),
    "components": (EARLIEST, {"data": values("<f4", (*SHAPE, 3)), "chunks": (3, 4, 5, 3)}),
    "all_axes": (EARLIEST, {"data": values("|u1", (2, *SHAPE, 2)), "chunks": (1, 3, 4, 5, 2)}),
    "split": (EARLIEST, {"data": values("|u1", (*SHAPE, 3)), "chunks": (3, 4, 5, 1)}),
    "scaleoffset": (EARLIEST, {"data": values("<i4"), "chunks": (3, 4, 5), "scaleoffset": 0}),
    "lzf": (EARLIEST, {"data": values(), "chunks": (3, 4, 5), "compression": "lzf"}),
    "half": (EARLIEST, {"data": values("<f2")}),
    "bools": (EARLIEST, {"data": values("|u1") > 50}),
    "members": (EARLIEST, {"data": np.zeros(SHAPE, [("x", "<f4"), ("text", "S3"), ("y", ">i2")]), "chunks": (2, 3, 2)}),
    "opaque": (EARLIEST, {"data": np.zeros(SHAPE, "V3")}),
    "single": (LATEST, {"data": values(), "chunks": SHAPE}),
    "fixed_array": (LATEST, {"data": values(), "chunks": (2, 3, 2), "compression": "gzip"}),
    "extensible_array": (LATEST, {"data": values(), "chunks": (2, 3, 2), "maxshape": (None, 4, 5)}),
    "tree2": (LATEST, {"data": values(), "chunks": (2, 3, 2), "maxshape": (None, None, 5)}),
    "latest": (LATEST, {"data": values()}),
}


def make_plain(folder):
    for name, (options, dataset) in DATASETS.items():
        with h5py.File(path(folder, "Hdf", name + ".h5"), "w", **options) as file:
            file.create_dataset("f", **dataset)
    for name, options in (("block", {}), ("block_chunked", {"chunks": (2, 3, 2)})):
        with h5py.File(path(folder, "Hdf", name + ".h5"), "w", userblock_size=512) as file:
            file.create_dataset("f", data=values(), **options)
    for name, options in (("holes", EARLIEST), ("holes_latest", LATEST)):
        with h5py.File(path(folder, "Hdf", name + ".h5"), "w", **options) as file:
            hole = file.create_dataset("f", SHAPE, "<f4", chunks=(2, 3, 2), fillvalue=42.0)
            hole[0:2, 0:3, 0:2] = 1.0
            file.create_dataset("nothing", SHAPE, "<i2", fillvalue=7)
    with h5py.File(path(folder, "Hdf", "groups.h5"), "w") as file:
        file["deep/er/f"] = values()
        file["deep/g"] = values("|u1")
        file["line"] = np.arange(5)
        file["soft"] = h5py.SoftLink("/deep/er/f")
        file["beyond"] = h5py.ExternalLink("input.h5", "/deep/g")
        file["deep"].attrs["text"] = "some text"
        file["deep/g"].attrs["numbers"] = [1.0, 2.0]
        file["kind"] = np.dtype("<f4")
        file.create_dataset("named", SHAPE, file["kind"])
    for name, kind in (("labels", {"chunks": (2, 3, 2, 3, 1)}), ("labels_contiguous", {})):
        with h5py.File(path(folder, "Hdf", name + ".h5"), "w") as file:
            dataset = file.create_dataset("f", data=values("|u1", (2, *SHAPE, 2)), **kind)
            for axis, label in enumerate(("c", "z", "y", "x", "t")):
                dataset.dims[axis].label = label
    with h5py.File(path(folder, "Hdf", "virtual.h5"), "w", libver="latest") as file:
        file["a"] = values()[:3]
        layout = h5py.VirtualLayout(SHAPE, "<f4")
        layout[:3] = h5py.VirtualSource(".", "a", (3, *SHAPE[1:]))
        layout[3:] = h5py.VirtualSource("input.h5", "a", (3, *SHAPE[1:]))
        file.create_virtual_dataset("f", layout, fillvalue=2.0)
    with h5py.File(path(folder, "Hdf", "external.h5"), "w") as file:
        file.create_dataset("f", SHAPE, "<f4",
                            external=[("values.bin", 8, 200), ("values.bin", 300, h5py.h5f.UNLIMITED)])
    # Space that is set aside at once: the chunks follow one another, without an index.
    for name, kind in (("implicit", LATEST), ("early", EARLIEST)):
        with h5py.File(path(folder, "Hdf", name + ".h5"), "w", **kind) as file:
            creation = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
            creation.set_chunk((2, 3, 2))
            creation.set_alloc_time(h5py.h5d.ALLOC_TIME_EARLY)
            whole = h5py.h5s.create_simple(SHAPE)
            h5py.Dataset(h5py.h5d.create(file.id, b"f", h5py.h5t.IEEE_F32LE, whole, creation))[...] = values()
    with h5py.File(path(folder, "Hdf", "compact.h5"), "w") as file:
        creation = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
        creation.set_layout(h5py.h5d.COMPACT)
        whole = h5py.h5s.create_simple(SHAPE)
        h5py.Dataset(h5py.h5d.create(file.id, b"f", h5py.h5t.STD_U8LE, whole, creation))[...] = values("|u1")


def create_image(file, cells=False):
    group = file.create_group("VTKHDF")
    group.attrs["Version"] = [2, 0]
    group.attrs["Type"] = np.bytes_("ImageData")
    group.attrs["WholeExtent"] = [5, 9, -3, 0, 0, 5]
    group.attrs["Origin"] = [1.0, 2.0, 3.0]
    group.attrs["Spacing"] = [0.5, 0.25, 2.0]
    group.attrs["Direction"] = [0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]
    if cells:
        group["CellData/c"] = values("<i2", (5, 3, 4))
    return group


def make_images(folder):
    for name, kind in (("image", EARLIEST), ("image_latest", LATEST)):
        with h5py.File(path(folder, "VtkHdf", name + ".vtkhdf"), "w", **kind) as file:
            group = create_image(file, True)
            group.create_dataset("PointData/f", data=values(), chunks=(2, 3, 2), compression="gzip")
            group["PointData/v"] = values("|u1", (*SHAPE, 3))
    for name, text in (("scalars", np.bytes_("g")), ("scalars_text", "g")):
        with h5py.File(path(folder, "VtkHdf", name + ".vtkhdf"), "w") as file:
            points = create_image(file).create_group("PointData")
            points["f"] = values("|u1")
            points["g"] = values("|u1")
            points.attrs["Scalars"] = text
    for name, kind in (("steps", EARLIEST), ("steps_latest", LATEST)):
        with h5py.File(path(folder, "VtkHdf", name + ".vtkhdf"), "w", **kind) as file:
            group = create_image(file)
            steps = group.create_group("Steps")
            steps.attrs["NSteps"] = 3
            steps["Values"] = np.array([0.5, 1.0, 4.0])
            steps["PointDataOffsets/f"] = [1, 0, 2]
            group.create_dataset("PointData/f", data=values("|u1", (3, *SHAPE)), chunks=(1, 3, 4, 5))
            group["PointData/g"] = values("|u1", (3, *SHAPE))
    with h5py.File(path(folder, "VtkHdf", "links.vtkhdf"), "w") as file:
        group = create_image(file)
        file["g"] = values("|u1")
        group["PointData/f"] = h5py.ExternalLink("input.vtkhdf", "/g")
        group["PointData/h"] = h5py.SoftLink("/g")


def make(folder):
    make_plain(folder)
    make_images(folder)
