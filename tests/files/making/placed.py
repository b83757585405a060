# SPDX-License-Identifier: BSD-3-Clause
"""Files that say where their samples lie, in which order, and how numbers become values: netCDF-4 by netCDF4,
openPMD, EMD and voxel sizes by h5py, xarray's and OME's metadata in Zarr. Importing it makes the files."""

import json

import h5py
import netCDF4
import numpy as np
import zarr

from making.volumes import SIZE, note, path, values
from making.zarrs import LATER, save_zarr

PACKED = {"scale": 0.25, "offset": 5.0, "missing": [7.0]}
EVEN = {"lon": np.linspace(10, 30, SIZE[0]), "lat": 60 - 0.5 * np.arange(SIZE[1]),
        "lev": 100.0 + 50 * np.arange(SIZE[2])}
PLACE = {"origin": [10.0, 60.0, 100.0], "spacing": [1.0, -0.5, 50.0]}
UNEVEN = 10.0 * np.arange(SIZE[2]) ** 1.5

# netCDF-4: packed shorts and bytes that are unsigned, coordinates, times; another order of axes; uneven levels.
with netCDF4.Dataset(path("packed.nc"), "w") as file:
    file.createDimension("time", None)
    for name, numbers in EVEN.items():
        file.createDimension(name, len(numbers))
        file.createVariable(name, "f4", (name,))[:] = numbers
    file.createVariable("time", "f8", ("time",)).units = "days since 2000-01-01"
    file["time"][:] = [0.5, 1.5, 4.5]
    shorts = file.createVariable("t", "i2", ("time", "lev", "lat", "lon"), zlib=True, fill_value=7)
    shorts.set_auto_maskandscale(False)
    shorts.scale_factor, shorts.add_offset = 0.25, 5.0
    whole = file.createVariable("u", "i1", ("time", "lev", "lat", "lon"), fill_value=np.int8(7),
                                chunksizes=(2, 4, 5, 8))
    whole.set_auto_maskandscale(False)
    whole.setncattr("_Unsigned", "true")
    whole.scale_factor, whole.add_offset = 0.25, 5.0
    for step in range(3):
        shorts[step] = values("<i2", step=step)
        whole[step] = values("|i1", step=step)
note("packed.nc", [("t", "float32"), ("u", "float32")], steps=3, times=[0.5, 1.5, 4.5], packing=PACKED, **PLACE)

with netCDF4.Dataset(path("uneven.nc"), "w") as file:
    for name, numbers in (("lon", EVEN["lon"]), ("lat", EVEN["lat"]), ("lev", UNEVEN)):
        file.createDimension(name, len(numbers))
        file.createVariable(name, "f8", (name,))[:] = numbers
    numbers = values("<f4").transpose(1, 2, 0)
    file.createVariable("t", "f4", ("lat", "lon", "lev"), chunksizes=(5, 8, 4), zlib=True)[:] = numbers
    file.createVariable("plain", "f4", ("lat", "lon", "lev"), contiguous=True)[:] = numbers
note(
    "uneven.nc", [("plain", "float32"), ("t", "float32")],
    origin=[10.0, 60.0, 0.0], spacing=[1.0, -0.5, 1.0], coordinates=[[], [], list(UNEVEN)],
)

# Coordinates of two axes, as of a curved grid; coordinates of one number are no positions.
with netCDF4.Dataset(path("curved.nc"), "w") as file:
    for name, length in zip("xyz", SIZE):
        file.createDimension(name, length)
    for name in ("lon", "lat"):
        file.createVariable(name, "f4", ("y", "x"))[:] = 1.0
    file.createVariable("height", "f4", ())[:] = 2.0
    for name in ("t", "u"):
        file.createVariable(name, "f4", ("z", "y", "x"))[:] = values("<f4")
        file[name].coordinates, file[name].grid_mapping = "height lon lat", "pole"
note("curved.nc", [("t", "float32"), ("u", "float32")], warnings=["'lon', 'lat'", "'pole'"])

# openPMD: axes in either order, an offset, samples in the middle of cells.
for name, labels, order, data in (
    ("open_c.h5", "xyz", "C", values("<f4").transpose(2, 1, 0)),
    ("open_f.h5", "xyz", "F", values("<f4")),
    ("open_z.h5", "zyx", "C", values("<f4")),
):
    with h5py.File(path(name), "w") as file:
        file.attrs["openPMD"], file.attrs["basePath"], file.attrs["meshesPath"] = "1.1.0", "/data/%T/", "fields/"
        rho = file.create_dataset("data/7/fields/rho", data=data,
                                  chunks=tuple(np.maximum(1, np.array(data.shape) // 3)))
        rho.attrs["axisLabels"] = np.array([letter.encode() for letter in labels])
        rho.attrs["geometry"], rho.attrs["dataOrder"] = np.bytes_("cartesian"), np.bytes_(order)
        turn = 1 if labels == "xyz" else -1
        rho.attrs["gridSpacing"], rho.attrs["gridGlobalOffset"] = [1.0, 2.0, 4.0][::turn], [0.0, 0.0, -16.0][::turn]
        rho.attrs["gridUnitSI"], rho.attrs["position"], rho.attrs["unitSI"] = 0.5, [0.5] * 3, 1.0
    note(name, [("rho", "float32")], spacing=[0.5, 1.0, 2.0], origin=[0.25, 0.5, -7.0])

# Iterations, whose order is that of numbers, with values kept in several ways. One mesh
# lies elsewhere and moves, one is in one only, one has numbers of several types.
with h5py.File(path("open_steps.h5"), "w") as file:
    file.attrs["openPMD"], file.attrs["basePath"], file.attrs["meshesPath"] = "1.1.0", "/data/%T/", "fields/"
    for step, (iteration, kept) in enumerate(((7, {"chunks": (4, 5, 8), "compression": "gzip"}), (20, {}),
                                              (100, {"chunks": (2, 7, 9)}))):
        group = file.create_group(f"data/{iteration}")
        group.attrs["time"], group.attrs["timeUnitSI"] = 3.0 * step, 0.5
        for name, place in (("E/x", 0.5), ("mixed", 0.5), ("rho", 0.0)) + ((("once", 0.0),) if step == 1 else ()):
            dtype = "<i2" if name == "mixed" and step == 1 else ("<f4", "<f4", ">f4")[step]
            mesh = group.create_dataset(f"fields/{name}", data=values(dtype, step=step), **kept)
            mesh.attrs["position"] = [0.0, 0.0, place]
            record = mesh.parent if "/" in name else mesh
            record.attrs["axisLabels"], record.attrs["dataOrder"] = np.array([b"z", b"y", b"x"]), np.bytes_("C")
            record.attrs["gridSpacing"], record.attrs["gridUnitSI"] = [1.0] * 3, 1.0
            record.attrs["gridGlobalOffset"] = [0.0, 0.0, 5.0 if step == 2 and name == "rho" else 0.0]
note(
    "open_steps.h5", [("E/x", "float32"), ("rho", "float32")], steps=3, origin=[0.5, 0.0, 0.0], times=[0.0, 1.5, 3.0],
    warnings=["'once'", "'mixed' is not shown", "'rho' at positions that differ", "'rho'"],
)

# EMD, whose first axis is x; voxel sizes; axes of one sample.
with h5py.File(path("emd.h5"), "w") as file:
    group = file.create_group("experiment/tomogram")
    group.attrs["emd_group_type"] = 1
    group["data"] = values("<u2").transpose(2, 1, 0)
    for axis, (name, count) in enumerate(zip("xyz", SIZE)):
        group[f"dim{axis + 1}"] = 2.0 + (axis + 1) * np.arange(count)
        group[f"dim{axis + 1}"].attrs["name"], group[f"dim{axis + 1}"].attrs["units"] = name, "[n_m]"
note("emd.h5", [("experiment/tomogram/data", "uint16")], spacing=[1.0, 2.0, 3.0], origin=[2.0] * 3)
# Imaris: extents from edge to edge, datasets that are padded to whole chunks, a coarser level.
with h5py.File(path("image.ims"), "w") as file:
    def tell(group, **told):
        for name, text in told.items():
            group.attrs[name] = np.frombuffer(str(text).encode(), "S1")

    tell(file.create_group("DataSetInfo/Image"), X=21, Y=13, Z=10, Unit="um", ExtMin0=10, ExtMin1=20, ExtMin2=30,
         ExtMax0=31, ExtMax1=46, ExtMax2=70)
    for step in range(2):
        for channel, how in enumerate(({"compression": "gzip"}, {})):
            padded = np.full((12, 15, 24), 999, "<u2")
            padded[:10, :13, :21] = values("<u2", channel=channel, step=step)
            group = file.create_group(f"DataSet/ResolutionLevel 0/TimePoint {step}/Channel {channel}")
            group.create_dataset("Data", data=padded, chunks=(4, 5, 8), **how)
            group = file.create_group(f"DataSet/ResolutionLevel 1/TimePoint {step}/Channel {channel}")
            group.create_dataset("Data", data=padded[::2, ::2, ::2], chunks=(4, 5, 8))
            tell(group, ImageSizeX=11, ImageSizeY=7, ImageSizeZ=5)
note(
    "image.ims", [("Channel 0", "uint16"), ("Channel 1", "uint16", 1, 1)], steps=2, spacing=[1.0, 2.0, 4.0],
    origin=[10.5, 21.0, 32.0],
)
CHOSEN = "DataSet/ResolutionLevel 1/TimePoint 0/Channel 0/Data"
note(
    "image.ims", [(CHOSEN, "uint16")], dataset=CHOSEN, size=(11, 7, 5), stride=2, spacing=[21 / 11, 26 / 7, 8.0],
    origin=[10 + 21 / 22, 20 + 13 / 7, 34.0],
)
with h5py.File(path("voxel_size.h5"), "w") as file:
    file.create_dataset("f", data=values("<f4")).attrs["element_size_um"] = [4.0, 1.0, 0.5]
note("voxel_size.h5", [("f", "float32")], spacing=[0.5, 1.0, 4.0])
with h5py.File(path("resolution.h5"), "w") as file:
    dataset = file.create_dataset("f", data=values("<f4")[None, None], chunks=(1, 1, 4, 5, 8))
    dataset.attrs["resolution"], dataset.attrs["offset"] = [40, 4, 4], [400, 0, 8]
note("resolution.h5", [("f", "float32")], spacing=[4.0, 4.0, 40.0], origin=[8.0, 0.0, 400.0])
with h5py.File(path("ones.h5"), "w") as file:
    file["f"] = np.stack([values("<f4", step=step) for step in range(2)])[:, None]
note("ones.h5", [("f", "float32")], steps=2)

# Zarr: half precision, xarray's packed values and coordinates.
save_zarr("half.zarr", values("<f2"), compressor=None, chunks=(4, 5, 8))
note("half.zarr", [("half", "float32")])
save_zarr("half_big.zarr", values(">f2"), chunks=(4, 5, 8))
note("half_big.zarr", [("half_big", "float32")])
zarr.open_group(path("cf.zarr"), mode="w", **LATER)
save_zarr("cf.zarr/t", values("<i2"), chunks=(4, 5, 8))
for name, numbers in EVEN.items():
    save_zarr("cf.zarr/" + name, numbers, chunks=(7,))
attributes = {"": {"_ARRAY_DIMENSIONS": ["lev", "lat", "lon"], "scale_factor": 0.25, "add_offset": 5.0,
                   "_FillValue": 7}}
attributes.update({name: {"_ARRAY_DIMENSIONS": [name], "units": "degrees"} for name in EVEN})
attributes["lev"].update({"units": "m", "positive": "Down"})
for name, told in attributes.items():
    with open(path("cf.zarr/" + (name or "t") + "/.zattrs"), "w", encoding="utf-8") as file:
        json.dump(told, file)
note("cf.zarr", [("t", "float32")], packing=PACKED, origin=[10.0, 60.0, -100.0], spacing=[1.0, -0.5, -50.0])

# A group whose first array is still, and has CF's coordinates of two axes; the other one has times.
zarr.open_group(path("mixed_times.zarr"), mode="w", **LATER)
for name, data, told in (
    ("a", values("<f4"), {"_ARRAY_DIMENSIONS": ["z", "y", "x"], "coordinates": "curved z", "grid_mapping": "pole"}),
    ("b", np.stack([values("<f4", step=step) for step in range(2)]), {"_ARRAY_DIMENSIONS": ["time", "z", "y", "x"]}),
    ("curved", np.zeros(SIZE[1::-1]), {"_ARRAY_DIMENSIONS": ["y", "x"]}),
    ("time", np.array([2.0, 5.0]), {"_ARRAY_DIMENSIONS": ["time"]}),
):
    save_zarr(f"mixed_times.zarr/{name}", data, chunks=data.shape)
    with open(path(f"mixed_times.zarr/{name}/.zattrs"), "w", encoding="utf-8") as file:
        json.dump(told, file)
note(
    "mixed_times.zarr", [("a", "float32", 1, 0, False, True), ("b", "float32")], steps=2, times=[2.0, 5.0],
    warnings=["'curved'", "'grid_mapping'"],
)


# Axes in an order of their own, in chunks with a filter and without one.
for name, compressor in (("turned.zarr", "default"), ("turned_raw.zarr", None)):
    save_zarr(name, values("<f4").transpose(1, 0, 2), compressor=compressor, chunks=(5, 4, 8))
    with open(path(name + "/.zattrs"), "w", encoding="utf-8") as file:
        json.dump({"_ARRAY_DIMENSIONS": ["y", "depth", "x"], "voxel_size": [2, 4, 1]}, file)
    note(name, [(name[: -len(".zarr")], "float32")], spacing=[1.0, 2.0, 4.0])

# OME-Zarr 0.6: coordinate systems, transformations in one another, units that differ.
def write_ome6(name, transformation, data, systems, coarser=None, **more):
    """coarser: the transformation of another level; then that one is noted."""
    group = zarr.open_group(path(name), mode="w", **LATER)
    save_zarr(name + "/s0", data, chunks=(1,) * (data.ndim - 3) + (4, 5, 8))
    datasets = [(transformation, "s0")]
    if coarser:
        save_zarr(name + "/s1", data[::2, ::2, ::2], chunks=(4, 5, 8))
        datasets.append((coarser, "s1"))
        more = {"levels": 2, "level": 1, "size": (11, 7, 5), "stride": 2, **more}
    group.attrs["ome"] = {
        "version": "0.6",
        "multiscales": [
            {
                "coordinateSystems": [{"name": "other", "axes": []}, {"name": "intrinsic", "axes": systems}],
                "datasets": [
                    {"path": level, "coordinateTransformations": [{**how, "input": {"path": level},
                                                                   "output": {"name": "intrinsic"}}]}
                    for how, level in datasets
                ],
            }
        ],
    }
    note(name, [(None, "float32")], **more)


def scale(numbers):
    return {"type": "scale", "scale": numbers}


SPACE = [{"name": letter, "type": "space", "unit": "micrometer"} for letter in "zyx"]
MIXED = [{**axis, "unit": unit} for axis, unit in zip(SPACE, ("millimeter", "nanometer", "micrometer"))]
IN_TIME = [{"name": "t", "type": "time", "unit": "second"}, *SPACE]
MOVED = {"type": "translation", "translation": [10, 20, 30]}
write_ome6(
    "six.zarr", {"type": "sequence", "transformations": [scale([4, 2, 0.5]), MOVED]}, values("<f4"), SPACE,
    spacing=[0.5, 2.0, 4.0], origin=[30.0, 20.0, 10.0],
)
write_ome6(
    "six_units.zarr", scale([0.001, 2000, 1]), values("<f4"), MIXED, spacing=[1.0, 2.0, 1.0],
    warnings=["shown in 'micrometer'"],
)
write_ome6(
    "six_time.zarr", scale([0.5, 4, 2, 1]), np.stack([values("<f4", step=step) for step in range(3)]), IN_TIME,
    steps=3, times=[0.0, 0.5, 1.0], spacing=[1.0, 2.0, 4.0],
)
write_ome6(
    "six_mapped.zarr",
    {"type": "sequence", "transformations": [{"type": "mapAxis", "mapAxis": [2, 1, 0]}, scale([4, 2, 1])]},
    values("<f4").transpose(2, 1, 0), SPACE, spacing=[1.0, 2.0, 4.0],
)
write_ome6(
    "six_affine.zarr", {"type": "affine", "affine": [[4, 0, 0, 1], [0, 2, 0, 2], [0, 0, 1, 3]]}, values("<f4"), SPACE,
    spacing=[1.0, 2.0, 4.0], origin=[3.0, 2.0, 1.0],
)
write_ome6(
    "six_turned.zarr", {"type": "rotation", "rotation": [[1, 0, 0], [0, 0.6, 0.8], [0, -0.8, 0.6]]}, values("<f4"),
    SPACE, direction=[0.6, -0.8, 0.0, 0.8, 0.6, 0.0, 0.0, 0.0, 1.0],
)

TURNED = {"type": "rotation", "rotation": [[1, 0, 0], [0, 0.6, 0.8], [0, -0.8, 0.6]]}
write_ome6(
    "six_turned_levels.zarr", TURNED, values("<f4"), SPACE,
    {"type": "sequence", "transformations": [scale([2, 2, 2]), TURNED]},
    spacing=[2.0] * 3, origin=[-0.1, 0.7, 0.5], direction=[0.6, -0.8, 0.0, 0.8, 0.6, 0.0, 0.0, 0.0, 1.0],
)

# OME-Zarr 0.1, which tells names of arrays alone.
group = zarr.open_group(path("ome1.zarr"), mode="w", **LATER)
save_zarr("ome1.zarr/0", values("<f4"), chunks=(4, 5, 8))
save_zarr("ome1.zarr/1", values("<f4")[::2, ::2, ::2], chunks=(4, 5, 8))
group.attrs["multiscales"] = [{"version": "0.1", "datasets": [{"path": "0"}, {"path": "1"}]}]
note(
    "ome1.zarr", [(None, "float32")], levels=2, level=1, size=(11, 7, 5), stride=2, spacing=[2.0] * 3, origin=[0.5] * 3,
)
