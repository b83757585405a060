# SPDX-License-Identifier: BSD-3-Clause
"""MetaImage by VTK, NRRD by Teem, headers as people write them, and bare values. Importing it makes the files."""

import os
import shutil
import subprocess

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOImage import vtkMetaImageWriter

from making.volumes import SIZE, note, path, values

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
