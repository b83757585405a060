# SPDX-License-Identifier: BSD-3-Clause
"""HDF5 and netCDF-4 with axes by name in many orders, depths, and values that are not one number each. Importing it
makes the files."""

import h5py
import netCDF4
import numpy as np

from making.volumes import SIZE, entries, note, path, values

STEPS = [values("<f4", step=step) for step in range(12)]
CHANNELS = np.stack([values("<f4", channel=channel) for channel in range(3)])
OF_CHANNELS = [(f"v {channel}", "float32", 1, channel) for channel in range(3)]


def write_labels(name, labels, data, arrays, more=None, **kept):
    with h5py.File(path(name), "w") as file:
        dataset = file.create_dataset("v", data=data, **kept)
        for axis, label in enumerate(labels):
            dataset.dims[axis].label = label
    note(name, arrays, **(more or {}))


def write_netcdf(name, coordinates, data, arrays, more=None, **kept):
    """coordinates: name, numbers, attributes."""
    with netCDF4.Dataset(path(name), "w") as file:
        for axis, numbers, attributes in coordinates:
            file.createDimension(axis, len(numbers))
            file.createVariable(axis, "f8", (axis,))[:] = numbers
            file[axis].setncatts(attributes)
        file.createVariable("v", data.dtype, [one[0] for one in coordinates], **kept)[:] = data
    note(name, arrays, **(more or {}))


ONE = [("v", "float32")]
write_labels("zyxt.h5", ("z", "y", "x", "time"), np.stack(STEPS, -1), ONE, {"steps": 12})
write_labels("xyzt.h5", ("x", "y", "z", "time"), np.stack(STEPS[:3], -1).transpose(2, 1, 0, 3), ONE, {"steps": 3},
             chunks=(8, 5, 4, 2))
write_labels("czyx.h5", ("c", "z", "y", "x"), CHANNELS, OF_CHANNELS)
write_labels("czyx_chunks.h5", ("c", "z", "y", "x"), CHANNELS, OF_CHANNELS, chunks=(2, 4, 5, 8), compression="gzip")
# ImageJ's order, also with times, and a voxel size.
write_labels("zcyx.h5", ("z", "channel", "y", "x"), CHANNELS.transpose(1, 0, 2, 3), OF_CHANNELS)
both = np.stack([np.stack([values("<f4", channel=channel, step=step) for channel in range(3)], 1) for step in range(2)])
write_labels("tzcyx.h5", ("t", "z", "c", "y", "x"), both, OF_CHANNELS, {"steps": 2, "spacing": [1.0, 2.0, 3.0]},
             chunks=(1, 4, 3, 5, 8))
with h5py.File(path("tzcyx.h5"), "a") as file:
    file["v"].attrs["element_size_um"] = [3.0, 2.0, 1.0]
write_labels("short.h5", ("time", "z", "y", "x"), np.stack(STEPS[:2])[..., :8], ONE,
             {"steps": 2, "size": (8, *SIZE[1:])})
write_labels("frames.h5", ("frame", "z", "y", "x"), np.stack(STEPS[:2]), ONE, {"steps": 2})

# What weather and ocean have: ensembles, times in front or not, depths that count downward.
TIMES = ("time", [1.0, 2.0, 4.0], {"units": "days since 2000-01-01"})
LEVELS = ("deptht", 5.0 * 1.5 ** np.arange(SIZE[2]), {"units": "m", "positive": "down"})
LATITUDES = ("nav_lat", 60.0 - np.arange(SIZE[1]), {"units": "degrees_north", "bounds": "lat_bnds"})
LONGITUDES = ("nav_lon", np.arange(10.0, 10.0 + SIZE[0]), {"units": "degrees_east"})
MEMBERS = ("ens", [0.0, 1.0, 2.0], {})
PLACED = {"origin": [10.0, 60.0, 0.0], "spacing": [1.0, -1.0, -1.0], "coordinates": [[], [], list(-LEVELS[1])]}
IN_TIME = {**PLACED, "steps": 3, "times": TIMES[1]}
write_netcdf("ocean.nc", (LEVELS, LATITUDES, LONGITUDES), values("<f4"), ONE, PLACED, chunksizes=(4, 5, 8))
write_netcdf("levels_first.nc", (LEVELS, TIMES, LATITUDES, LONGITUDES), np.stack(STEPS[:3], 1), ONE, IN_TIME)
members = np.stack([np.stack([values("<f4", channel=member, step=step) for step in range(3)]) for member in range(3)])
write_netcdf(
    "members.nc", (MEMBERS, TIMES, LEVELS, LATITUDES, LONGITUDES), members, OF_CHANNELS, IN_TIME,
    chunksizes=(2, 2, 4, 5, 8), zlib=True
)
FLAT = {"steps": 3, "times": TIMES[1], "size": (*SIZE[:2], 1), "origin": [10.0, 60.0, 0.0], "spacing": [1.0, -1.0, 1.0]}
write_netcdf("flat.nc", (TIMES, LATITUDES, LONGITUDES), np.stack(STEPS[:3])[:, 0], ONE, FLAT)

# Values of several numbers, of which each becomes an array, and a vector where they are x, y and z: with the distance
# of 46 channels the sample is greater by one. Others are left out with a word, as is what a missing filter packed.
with h5py.File(path("kinds.h5"), "w") as file:
    parts = [values("<f4", channel=46 * part) for part in range(3)]
    vector = np.zeros(SIZE[::-1], [("x", "<f4"), ("name", "S3"), ("y", "<f4"), ("z", "<f4")])
    vector["x"], vector["y"], vector["z"] = parts
    file.create_dataset("v", data=vector, chunks=(4, 5, 8), compression="gzip")
    file["wave"] = (values("<f8") + 1j * values("<f8", channel=1)).astype(">c16")
    file["opaque"] = np.zeros(SIZE[::-1], "V16")
    file.create_dataset("packed", data=values("<f4"), compression="lzf")
    for name, part in zip(("E/x", "E/y", "E/z"), parts):
        file.create_dataset(name, data=part, chunks=(4, 5, 8))
note(
    "kinds.h5",
    [
        *((f"E/{letter}", "float32", 1, 46 * part) for part, letter in enumerate("xyz")),
        *((f"v/{letter}", "float32", 1, 46 * part) for part, letter in enumerate("xyz")),
        ("wave/r", "float64"), ("wave/i", "float64", 1, 1), ("E", "float32", 3), ("v", "float32", 3),
    ],
    warnings=["'opaque' (opaque, 16 bytes)", "'packed', which is not shown: the HDF5 filter 32000"],
)
note("kinds.h5", [("wave/r", "float64"), ("wave/i", "float64", 1, 1)], dataset="wave")

# Two missing values and more, of packed numbers.
with h5py.File(path("many_missing.h5"), "w") as file:
    dataset = file.create_dataset("f", data=values("<i2"))
    dataset.attrs["_FillValue"] = np.array([7], "i2")
    dataset.attrs["missing_value"] = np.array([7, 9, 11, 12, 13], "i2")
    dataset.attrs["scale_factor"] = 0.25
note(
    "many_missing.h5", [("f", "float32")], packing={"scale": 0.25, "offset": 0.0, "missing": [7, 9, 11, 12]},
    warnings=["'missing_value'"],
)

# openPMD: what has times of its own beside iterations, and iterations of another number of axes.
with h5py.File(path("open_times.h5"), "w") as file:
    file.attrs["openPMD"], file.attrs["basePath"], file.attrs["meshesPath"] = "1.1.0", "/data/%T/", "fields/"
    for step in range(3):
        file[f"data/{step}/fields/rho"] = STEPS[step]
        file[f"data/{step}/fields/deep"] = STEPS[step] if step < 2 else STEPS[step][np.newaxis]
    file["probe"] = np.stack(STEPS[:2])
note("open_times.h5", [("rho", "float32")], steps=3,
     warnings=["'deep'", "'probe' with 2 time steps beside 3 iterations"])

# Axes that cannot be told apart.
with h5py.File(path("five.h5"), "w") as file:
    file["a"], file["data"] = np.zeros((3, 3)), np.zeros((2, 3, *SIZE[::-1]), "u1")
write_labels("letters.h5", ("x", "y", "x"), values("|u1"), ONE)
entries.pop()
