# SPDX-License-Identifier: BSD-3-Clause
"""NRRD and MetaImage: headers as programs and people write them, with the values behind them or in values.bin."""

import bz2
import gzip
import zlib

from seeds.common import values, write

NRRD = {
    "plain": "type: float\ndimension: 3\nsizes: 5 4 6\nendian: little\nencoding: raw\n",
    "directions": "type: int16\ndimension: 3\nspace: left-posterior-superior\nsizes: 5 4 6\n"
    "space directions: (0.5,0,0) (0,0.25,0) (0,0,2)\nkinds: domain domain domain\nendian: big\n"
    "encoding: raw\nspace origin: (1,2,3)\nspace units: \"mm\" \"mm\" \"mm\"\n",
    "vectors": "type: uchar\ndimension: 4\nsizes: 3 5 4 6\nkinds: vector domain domain domain\nencoding: raw\n"
    "space directions: none (1,0,0) (0,1,0) (0,0,1)\n",
    "axes": "type: double\ndimension: 3\nsizes: 5 4 6\nspacings: 1.5 -2 2\naxis mins: 1 2 3\naxis maxs: 4 5 6\n"
    "centers: node node cell\nendian: little\nencoding: raw\ncontent: a name\n# a comment\nkey:=value\n",
    "flat": "type: uchar\ndimension: 3\nsizes: 3 5 4\nkinds: RGB-color domain domain\nencoding: raw\n",
    "detached": "type: uint16_t\ndimension: 3\nsizes: 5 4 6\nendian: big\nencoding: raw\ndata file: values.bin\n"
    "byte skip: 7\nline skip: 0\n",
    "end": "type: int\ndimension: 3\nsizes: 5 4 6\nendian: little\nencoding: raw\ndatafile: values.bin\nbyteskip: -1\n",
    "list": "type: int\ndimension: 3\nsizes: 5 4 6\nencoding: raw\ndata file: LIST 2\na.bin\n",
    "pattern": "type: int\ndimension: 3\nsizes: 5 4 6\nencoding: raw\ndata file: slice%03d.bin 1 6 1 2\n",
    "lists": "type: uchar\ndimension: 3\nsizes: 32 32 8\nencoding: raw\ndata file: LIST 3\nvalues.bin\nvalues.bin\n",
    "las": "type: double\ndimension: 3\nspace: LAS\nsizes: 5 4 6\nspace directions: (0,1,0) (1,0,0) (0,0,2)\n"
    "endian: little\nencoding: raw\nspace origin: (1,2,3)\nmeasurement frame: (1,0,0) (0,1,0) (0,0,1)\n",
    "last": "type: short\ndimension: 4\nsizes: 5 4 6 3\nkinds: domain domain domain list\nendian: big\nencoding: raw\n",
}
PACKED = {
    "gzip": (gzip.compress, "type: double\ndimension: 3\nsizes: 5 4 6\nendian: little\nencoding: gzip\n"),
    "bzip2": (bz2.compress, "type: double\ndimension: 3\nsizes: 5 4 5\nencoding: bz2\nbyte skip: -1\n"),
}
META = {
    "plain": "ObjectType = Image\nNDims = 3\nDimSize = 5 4 6\nElementType = MET_SHORT\n",
    "full": "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nCompressedData = False\n"
    "TransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = 1 2 3\nCenterOfRotation = 0 0 0\nAnatomicalOrientation = RAI\n"
    "ElementSpacing = 0.5 -0.25 2\nDimSize = 5 4 6\nElementNumberOfChannels = 3\nElementType = MET_UCHAR_ARRAY\n",
    "big": "NDims = 3\nElementByteOrderMSB = T\nDimSize = 5 4 6\nElementType = MET_LONG\nHeaderSize = 300\n"
           "Position = 1 2 3\n",
    "end": "NDims = 3\nDimSize = 5 4 6\nElementType = MET_DOUBLE\nHeaderSize = -1\nRotation = 0 1 0 -1 0 0 0 0 1\n"
    "ElementSize = 1 1 1\n",
    "colons": "NDims : 3\nDimSize : 5 4 6\nElementType : MET_FLOAT\n",
}


def make(folder):
    raw = values("<f8").tobytes()
    for name, text in NRRD.items():
        for version in (1, 4, 5) if name == "plain" else (5,):
            write(folder, "Nrrd", f"{name}{version}", f"NRRD000{version}\n{text}\n".encode() + raw)
    for name, (pack, text) in PACKED.items():
        write(folder, "Nrrd", name, f"NRRD0005\n{text}\n".encode() + pack(raw))
    packed = zlib.compress(raw)
    text = ("NDims = 3\nDimSize = 5 4 6\nElementType = MET_DOUBLE\nCompressedData = T\n"
            f"CompressedDataSize = {len(packed)}\n")
    write(folder, "MetaImage", "packed", f"{text}ElementDataFile = LOCAL\n".encode() + packed)
    for name, text in META.items():
        for place, content in (("LOCAL", raw), ("values.bin", b""), ("LIST", b"a.bin\n"), ("slice%03d.bin 1 6 1", b"")):
            between = " : " if name == "colons" else " = "
            write(folder, "MetaImage", f"{name}-{place[:4]}",
                  f"{text}ElementDataFile{between}{place}\n".encode() + content)
