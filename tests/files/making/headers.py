# SPDX-License-Identifier: BSD-3-Clause
"""MetaImage by VTK, NRRD by Teem, headers as people write them, and bare values. Importing it makes the files."""

import bz2
import gzip
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
    note(name, [(None, "int16")], spacing=[0.5, 0.25, 2.0], origin=[1.0, 2.0, 3.0])

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
    note(name, [(None, np.dtype(dtype).name)])

# Compressed, and in several files.
for name, how, end in (("gzip.nrrd", "gzip:9", ""), ("bzip2.nhdr", "bzip2", "raw.bz2"),
                       ("gzip.nhdr", "gzip", "raw.gz")):
    raw = path("packed.bin")
    values("<u2").tofile(raw)
    make = [unu, "make", "-i", raw, "-t", "ushort", "-s", *map(str, SIZE), "-e", "raw", "-en", "little"]
    made = subprocess.run(make, stdout=subprocess.PIPE, check=True).stdout
    subprocess.run([unu, "save", "-f", "nrrd", "-e", how, "-o", path(name)], input=made, check=True)
    os.remove(raw)
    note(name, [(None, "uint16")])
for name in ("packed.mha", "packed.mhd"):
    writer = vtkMetaImageWriter()
    writer.SetInputData(image)
    writer.SetCompression(True)
    writer.SetFileName(path(name))
    writer.Write()
    note(name, [(None, "int16")], spacing=[0.5, 0.25, 2.0], origin=[1.0, 2.0, 3.0])

os.makedirs(path("slices_50%"))
slices = [f"slices_50%/s{number:03d}.raw" for number in range(-2, 18, 2)]
for piece, name in zip(values("<f4"), slices):
    piece.tofile(path(name))
rows = [f"slices_50%/row{number}.raw" for number in range(130)]
for piece, name in zip(values("<f4").reshape(130, 21), rows):
    piece.tofile(path(name))
for start, name in ((0, "half1"), (5, "half2")):
    with open(path(name + ".gz"), "wb") as file:
        # A line and four bytes to skip, and two streams.
        file.write(b"a line\n" + gzip.compress(b"skip" + values("<f4")[start : start + 2].tobytes()))
        file.write(gzip.compress(values("<f4")[start + 2 : start + 5].tobytes()))
with open(path("last.bz2"), "wb") as file:
    file.write(bz2.compress(b"what is before" + values("<f4").tobytes()))
for name, pack in (("zeros.gz", gzip.compress), ("zeros.bz2", bz2.compress)):
    with open(path(name), "wb") as file:  # for TestHostileHeaders
        file.write(pack(bytes(1 << 18)))
make = [unu, "make", "-h", "-t", "float", "-s", *map(str, SIZE), "-e", "raw", "-en", "little"]
subprocess.run([*make, "-i", *slices, "-o", path("list.nhdr")], check=True)
note("list.nhdr", [(None, "float32")])

# Headers as people write them.
values("<f4").tofile(path("headers.bin"))
values("<i2", 3).tofile(path("components.bin"))
for number, part in enumerate(np.moveaxis(values(">i2", 3), 3, 0)):
    part.tofile(path(f"apart{number}.bin"))
with open(path("skipped.bin"), "wb") as file:
    file.write(b"a line\nanother\n" + b"." * 16 + values("<f4").tobytes())
flat = np.ascontiguousarray(values("|u1", 3)[:1])
flat.tofile(path("flat.bin"))
headers = {
    "blanks.nhdr": (
        "type: float\ndimension: 3\nsizes: 21 13 10\nspace dimension: 3\ncontent:\nkey:=value\ntype:=large\n"
        "space directions: (0, 2, 0) ( -3, 0, 0 ) (0,0,4)\nspace origin: (10, 20, 30)\ndata file: headers.bin\n",
        [(None, "float32")],
        {
            "origin": [10.0, 20.0, 30.0],
            "spacing": [2.0, 3.0, 4.0],
            "direction": [0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0],
        },
    ),
    "joined.nhdr": (
        "type: float\ndimension: 3\nsizes: 21 13 10\nspacings: 1.5 -2 2\naxismins: 1 2 3\n"
        "centers: node node cell\ndatafile: skipped.bin\nbyteskip: -1\n",
        [(None, "float32")],
        {
            "origin": [1.0, 2.0, 4.0],
            "spacing": [1.5, 2.0, 2.0],
            "direction": [1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 1.0],
        },
    ),
    # Positions of cells: the first sample is in the middle of the first one.
    "cells.nhdr": (
        "type: float\ndimension: 3\nsizes: 21 13 10\nspacings: 1 2 -4\naxis mins: 10 20 30\n"
        "centerings: cell cell cell\ndata file: headers.bin\n",
        [(None, "float32")],
        {
            "origin": [10.5, 21.0, 28.0],
            "spacing": [1.0, 2.0, 4.0],
            "direction": [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, -1.0],
        },
    ),
    "cells_between.nhdr": (
        "type: float\ndimension: 3\nsizes: 21 13 10\naxis mins: 10 20 30\naxis maxs: 31 46 70\n"
        "centerings: cell cell cell\ndata file: headers.bin\n",
        [(None, "float32")],
        {"origin": [10.5, 21.0, 32.0], "spacing": [1.0, 2.0, 4.0]},
    ),
    # Four axes, without a word what they are.
    "four_first.nhdr": (
        "type: int16\ndimension: 4\nsizes: 3 21 13 10\ndata file: components.bin\n",
        [(None, "int16", 3)],
        {},
    ),
    "four_last.nhdr": (
        "type: int16\ndimension: 4\nsizes: 21 13 10 3\nendian: big\ndata file: apart%d.bin 0 2 1\n",
        [(None, "int16", 3)],
        {"warnings": ["without 'kinds'"]},
    ),
    "four_one.nhdr": (
        "type: float\ndimension: 4\nsizes: 21 13 10 1\ndata file: headers.bin\n",
        [(None, "float32")],
        {},
    ),
    "kinds.nhdr": (
        "type: int16\ndimension: 4\nsizes: 3 21 13 10\nkinds: vector domain domain domain\ndata file: components.bin\n",
        [(None, "int16", 3)],
        {},
    ),
    "pattern.nhdr": (
        "type: float\ndimension: 3\nsizes: 21 13 10\ndata file: slices_50%%/s%03d.raw -2 16 2\n",
        [(None, "float32")],
        {},
    ),
    "rows.nhdr": (
        "type: float\ndimension: 3\nsizes: 21 13 10\ndata file: slices_50%%/row%d.raw 0 129 1 1\n",
        [(None, "float32")],
        {},
    ),
    "halves.nhdr": (
        "type: float\ndimension: 3\nsizes: 21 13 10\nencoding: gz\nline skip: 1\nbyte skip: 4\n"
        "data file: LIST 3\nhalf1.gz\nhalf2.gz\n",
        [(None, "float32")],
        {},
    ),
    "last.nhdr": (
        "type: float\ndimension: 3\nsizes: 21 13 10\nencoding: bz2\nbyte skip: -1\ndata file: last.bz2\n",
        [(None, "float32")],
        {},
    ),
    "lines.nhdr": (
        "type: float\ndimension: 3\nsizes: 21 13 10\nline skip: 2\nbyte skip: 16\ndata file: skipped.bin\n",
        [(None, "float32")],
        {},
    ),
    "apart.nhdr": (
        "type: int16\ndimension: 4\nsizes: 21 13 10 3\nkinds: domain domain domain list\nendian: big\n"
        "data file: apart%d.bin 0 2 1\n",
        [(None, "int16", 3)],
        {},
    ),
    "flat.nhdr": (
        "type: uchar\ndimension: 3\nsizes: 3 21 13\nkinds: RGB-color domain domain\ndata file: flat.bin\n",
        [(None, "uint8", 3)],
        {"size": (21, 13, 1)},
    ),
}
# One head in worlds of other axes: all lie where the one in left-posterior-superior does.
head = {
    "origin": [10.0, 20.0, 30.0],
    "spacing": [2.0, 3.0, 4.0],
    "direction": [0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0],
}
for name, space, (x, y), more, warnings in (
    ("lps", "space: left-posterior-superior", (1, 1), "space units: \"mm\" \"mm\" \"mm\"\n", []),
    ("lpst", "space: LPST", (1, 1), "", []),
    ("ras", "space: right-anterior-superior", (-1, -1), "", []),
    ("RAS", "space: RAS", (-1, -1), "", []),
    ("las", "space: Left-Anterior-Superior", (1, -1), "", []),
    ("time", "space: right-anterior-superior-time", (-1, -1), "", []),
    ("scanner", "space: scanner-xyz", (1, 1), "", []),
    ("left", "space: 3D-left-handed", (1, 1), "", ["'space'"]),
    ("other", "space: mars", (1, 1), "space units: \"mm\" \"m\" \"mm\"\n", ["'mars'", "'space units"]),
    ("plain", "space dimension: 3", (1, 1), "old min: 3\n", ["'old min'"]),
):
    end = ",0)" if space.endswith(("T", "time")) else ")"
    headers[f"space_{name}.nhdr"] = (
        f"type: float\ndimension: 3\nsizes: 21 13 10\n{space}\n{more}space origin: ({10 * x},{20 * y},30{end}\n"
        f"space directions: (0,{2 * y},0{end} ({-3 * x},0,0{end} (0,0,4{end}\ndata file: headers.bin\n",
        [(None, "float32")],
        {**head, "warnings": warnings},
    )
headers["slice.nhdr"] = (
    "type: uchar\ndimension: 3\nsizes: 3 21 13\nkinds: RGB-color domain domain\nspace: RAS\n"
    "space directions: none (0,-2,0) (0,0,4)\nspace origin: (1,2,3)\ndata file: flat.bin\n",
    [(None, "uint8", 3)],
    {
        "size": (21, 13, 1),
        "origin": [-1.0, -2.0, 3.0],
        "spacing": [2.0, 4.0, 1.0],
        "direction": [0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0],
    },
)
headers["frame.nhdr"] = (
    "type: int16\ndimension: 4\nsizes: 3 21 13 10\nkinds: vector domain domain domain\nspace dimension: 3\n"
    "measurement frame: (0,1,0) (1,0,0) (0,0,1)\nthicknesses: nan nan nan 2\ndata file: components.bin\n",
    [(None, "int16", 3)],
    {"warnings": ["'measurement frame'", "'thicknesses'"]},
)
for name, (text, arrays, more) in headers.items():
    with open(path(name), "w", encoding="utf-8") as file:
        encoding = "" if "encoding" in text else "encoding: raw\n"
        file.write("NRRD0005\nendian: little\n" + encoding + text)
    note(name, arrays, **more)
for name, text in (
    ("colons.mhd", "ElementType : MET_FLOAT\nElementDataFile : headers.bin\n"),
    ("big.mhd", "ElementByteOrderMSB = T\nElementType = MET_LONG\nElementDataFile = big.bin\n"),
):
    values(">i4").tofile(path("big.bin"))
    with open(path(name), "w", encoding="utf-8") as file:
        file.write("NDims = 3\nDimSize = 21 13 10\n" + text)
    note(name, [(None, "float32" if "colons" in name else "int32")])

for name, text, more in (
    ("list.mhd", "ElementDataFile = LIST\n" + "\n".join(slices), {}),
    ("list3.mhd", "ElementDataFile = LIST 2D\n" + "\n".join(slices), {}),
    ("pattern.mhd", "ElementDataFile = slices_50%%/s%03d.raw -2 16 2\n", {}),
    (
        "slope.mhd",
        "ElementToIntensityFunctionSlope = 2\nElementToIntensityFunctionOffset = 0\nElementDataFile = headers.bin\n",
        {"warnings": ["'ElementToIntensityFunctionSlope = 2'"]},
    ),
    (
        "placed.mhd",
        "TransformMatrix = 0 1 0 -1 0 0 0 0 1\nCenterOfRotation = 1 2 3\nAnatomicalOrientation = RAS\n"
        "Position = 1 2 3\n"
        "ElementSize = 2 3 4\nElementDataFile = headers.bin\n",
        {
            "origin": [1.0, 2.0, 3.0],
            "spacing": [2.0, 3.0, 4.0],
            "direction": [0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0],
        },
    ),
):
    with open(path(name), "w", encoding="utf-8") as file:
        file.write("NDims = 3\nDimSize = 21 13 10\nElementType = MET_FLOAT\n" + text)
    note(name, [(None, "float32")], **more)

with open(path("backwards.mhd"), "w", encoding="utf-8") as file:
    file.write("NDims = 3\nDimSize = 21 13 10\nElementType = MET_FLOAT\nElementSpacing = 1 -2 3\n"
               "ElementDataFile = headers.bin\n")
note("backwards.mhd", [(None, "float32")], spacing=[1.0, 2.0, 3.0])

# Of what a header says of its own size, MetaIO makes a place in the file, also where the values follow it.
for name, size, between in (("skip.mha", 300, 300), ("skip_all.mha", -1, 200)):
    header = f"NDims = 3\nDimSize = 21 13 10\nElementType = MET_SHORT\nHeaderSize = {size}\nElementDataFile = LOCAL\n"
    with open(path(name), "wb") as file:
        file.write(header.encode().ljust(between, b"y") + values("<i2").tobytes())
    note(name, [(None, "int16")])
# Bare values.
with open(path("bare.raw"), "wb") as file:
    file.write(b"a header of 21 bytes.")
    file.write(values(">i4").tobytes())
note(
    "bare.raw",
    [(None, "int32")],
    raw={"type": "int32", "big": True, "header": 21, "spacing": [1.0, 1.0, 3.0]},
    spacing=[1.0, 1.0, 3.0],
)
