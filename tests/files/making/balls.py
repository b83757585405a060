# SPDX-License-Identifier: BSD-3-Clause
"""Balls to be looked at, in several formats, and such as change with time. Importing it makes the files."""

import json

import h5py
import netCDF4
import numpy as np
from numcodecs import Blosc
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOImage import vtkMetaImageWriter
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

from making.hdf import write_steps
from making.volumes import path
from making.zarrs import save_zarr

# A ball, to be looked at: distance from the middle, 1 at the nearest face.
edges = (48, 40, 36)
z, y, x = np.meshgrid(*(np.linspace(-1, 1, n) for n in reversed(edges)), indexing="ij")
ball = np.sqrt(x * x + y * y + z * z).astype("<f4")
with h5py.File(path("ball.h5"), "w") as file:
    file.create_dataset("f", data=ball, chunks=(16, 10, 13), compression="gzip", shuffle=True)
save_zarr("ball.zarr", ball, compressor=Blosc("zstd"), chunks=(9, 40, 20))
# As climate models write it: packed, on levels that are not evenly spaced, from north to south.
with netCDF4.Dataset(path("ball.nc"), "w") as file:
    for name, numbers in (("lev", np.sinh(2 * np.linspace(-1, 1, edges[2]))), ("lat", np.linspace(1, -1, edges[1])),
                          ("lon", np.linspace(-1, 1, edges[0]))):
        file.createDimension(name, len(numbers))
        file.createVariable(name, "f8", (name,))[:] = numbers
    packed = file.createVariable("f", "i2", ("lev", "lat", "lon"), zlib=True, chunksizes=(16, 10, 13))
    packed.scale_factor, packed.add_offset = 0.001, 0.5
    packed[:] = ball
# Missing values: NaN, and values that an attribute declares missing, of several types.
is_missing = np.broadcast_to(x + 0.3 * y > 0.25, ball.shape)
with h5py.File(path("missing.h5"), "w") as file:
    for name, dtype, scale, value, attribute in (
        ("nan", "<f4", 1, np.nan, None),
        ("float", "<f4", 1, 9.96921e36, "_FillValue"),
        ("double", ">f8", 1, -1e20, "missing_value"),
        ("whole nan", "<f4", 100, np.nan, None),
        ("short", "<i2", 100, -9999, "_FillValue"),
        ("byte", "|u1", 100, 255, "missing_value"),
        ("ranged", "<i4", 100, -9999, "valid_range"),
        ("two", "<i2", 100, -9999, "_FillValue"),
    ):
        stored = ball if scale == 1 else np.round(scale * ball)
        stored = np.where(is_missing, value, stored).astype(dtype)
        if name in ("ranged", "two"):
            stored[is_missing & (y > 0)] = 8888
        dataset = file.create_dataset(name, data=stored, chunks=(16, 10, 13), compression="gzip")
        if attribute:
            # As netCDF-4 has it: an array of one number.
            dataset.attrs[attribute] = np.array([0, 1000] if name == "ranged" else [value], dtype)
        if name == "two":
            dataset.attrs["missing_value"] = np.array([8888, -1], dtype)
for name, dtype, value, attribute in (("float", "<f4", 1e20, "missing_value"), ("short", "<i2", -9999, "_FillValue")):
    stored = np.where(is_missing, value, ball if dtype == "<f4" else np.round(100 * ball)).astype(dtype)
    save_zarr(f"missing_{name}.zarr", stored, compressor=Blosc("zstd"), chunks=(9, 40, 20))
    with open(path(f"missing_{name}.zarr/.zattrs"), "w", encoding="utf-8") as file:
        json.dump({attribute: value}, file)
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
        image.GetPointData().GetScalars().SetName(name)
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
write_steps("play.vtkhdf", [0.0, 1.0, 2.0, 3.0], [("play", np.stack(steps), None)], edges)

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
stacks = [("tinted", np.stack(steps), None), ("tint", np.stack(tints), None)]
write_steps("tinted.vtkhdf", [0.0, 1.0, 2.0, 3.0], stacks, edges)
