# SPDX-License-Identifier: BSD-3-Clause
"""Zarr by zarr, and version 3 by hand: compressors, axes, OME, shards. Importing it makes the files."""

import json
import os
import shutil
import struct
import zipfile

import numpy as np
import zarr
from numcodecs import (BZ2, LZ4, LZMA, AsType, BitRound, Blosc, Delta, FixedScaleOffset, GZip, Quantize, Shuffle, Zlib,
                       Zstd)

from making.hdf import LARGE
from making.volumes import SIZE, note, path, values

# Zarr, version 2, by either version of its library.
LATER = {} if hasattr(zarr, "DirectoryStore") else {"zarr_format": 2}


def save_zarr(name, data, separator=".", compressor="default", **options):
    if LATER:
        encoding = {"name": "v2", "separator": separator}
        compressor = "auto" if compressor == "default" else compressor
        zarr.create_array(path(name), data=data, compressors=compressor, chunk_key_encoding=encoding, **LATER,
                          **options)
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
    "lz4": LZ4(),
    "bz2": BZ2(),
    "lzma": LZMA(),
    "lzma_alone": LZMA(format=2, preset=1),
    # As Python's lzma names them: differences in 4 bytes, then LZMA2 or LZMA1.
    "lzma_raw": LZMA(format=3, filters=[{"id": 3, "dist": 4}, {"id": 0x21, "preset": 1, "lc": 2}]),
    "lzma_raw1": LZMA(format=3, filters=[{"id": 0x4000000000000001, "dict_size": 65536, "lp": 1, "lc": 1}]),
}
for name, compressor in compressors.items():
    for dtype, separator in (("<f4", "."), (">u2", "/")):
        file = f"{name}_{np.dtype(dtype).name}.zarr"
        save_zarr(file, values(dtype), separator, compressor, chunks=(4, 5, 8))
        note(file, [(file[: -len(".zarr")], np.dtype(dtype).name)])
save_zarr("shuffled.zarr", values("<f8"), compressor=Zlib(), chunks=(4, 5, 8), filters=[Shuffle(8)])
note("shuffled.zarr", [("shuffled", "float64")])
# Filters that make other numbers of the values, or nothing but rounded ones.
filters = {
    "bitround": ("<f4", [BitRound(8)]),
    "quantize": ("<f8", [Quantize(1, "<f8", "<f4")]),
    "delta": (">i4", [Delta(">i4", "|i1")]),
    "delta_float": ("<f8", [Delta("<f8", "<f4")]),
    "astype": ("<f4", [AsType(">u2", "<f4")]),
    "fixedscaleoffset": (">f4", [FixedScaleOffset(offset=-3, scale=10, dtype=">f4", astype=">i2"), Delta(">i2")]),
}
for name, (dtype, of_name) in filters.items():
    save_zarr(f"{name}.zarr", values(dtype), compressor=Zstd(), chunks=(4, 5, 8), filters=of_name)
    note(f"{name}.zarr", [(name, np.dtype(dtype).name)])
# What is packed and does not shrink is packed again.
for name, inner, outer in (("packed_zlib", Zlib(0), Zstd()), ("packed_gzip", GZip(0), Blosc("lz4"))):
    save_zarr(f"{name}.zarr", values("|u1"), compressor=outer, chunks=(4, 5, 8), filters=[inner])
    note(f"{name}.zarr", [(name, "uint8")])
slices = np.zeros(LARGE["slices"][::-1], "u1")
for z in (3, 8):
    slices[z] = values("|u1", size=(*LARGE["slices"][:2], 1), channel=7 * z)[0]
save_zarr("large/slices.zarr", slices, compressor=None, chunks=(1, 1024, 1100))
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
for name, names in (("capitals", "XYZ"), ("capitals_z", "ZYX"), ("x_first", ["x", "lat", "lon"]),
                    ("unknown", ["time_of_day", "lat", "dim_2"])):
    turned = names[0] in "Xx"
    data = values("<f4")
    save_zarr(f"{name}.zarr", data.T if turned else data, chunks=(8, 5, 4))
    with open(path(f"{name}.zarr/.zattrs"), "w", encoding="utf-8") as file:
        json.dump({"_ARRAY_DIMENSIONS": list(names)}, file)
    note(f"{name}.zarr", [(name, "float32")])
# The components of a sample on a last axis, which its name tells; the second one has x, y, z before it.
for name, names in (("components", ["z", "y", "x", "channel"]), ("components_x", "XYZC"),
                    ("components_steps", ["time", "z", "y", "x", "c"])):
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
    path("components_holes.zarr"), mode="w", shape=(*SIZE[::-1], 2), chunks=(4, 5, 8, 2), dtype=">f4",
    fill_value=42.0, **LATER
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
save_zarr("labels.zarr/0", np.stack([np.stack([values("<u2", channel=3 * p + k) for k in range(3)])
                                     for p in range(2)]), chunks=(1, 2, 4, 5, 8))
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
note("ome_last.zarr", [(None, "uint8", 3)], spacing=[1.0, 2.0, 4.0])

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
    "ome.zarr", channels, steps=3, spacing=[2.0, 4.0, 8.0], levels=2, level=1, size=(11, 7, 5), stride=2,
    origin=[0.5, 1.0, 2.0],
)


# A place of the whole image leaves coarser levels where they are in it.
shutil.copytree(path("ome.zarr"), path("ome_moved.zarr"))
moved = zarr.open_group(path("ome_moved.zarr"), mode="r+", **LATER)
transformations = [{"type": "translation", "translation": [0, 0, 10, 20, 30]}]
moved.attrs["multiscales"] = [{**group.attrs["multiscales"][0], "coordinateTransformations": transformations}]
for level, more in enumerate((
    {"spacing": [1.0, 2.0, 4.0], "origin": [30.0, 20.0, 10.0]},
    {"spacing": [2.0, 4.0, 8.0], "origin": [30.5, 21.0, 12.0], "size": (11, 7, 5), "stride": 2},
)):
    note("ome_moved.zarr", channels, steps=3, levels=2, level=level, **more)


# Folders of several images: containers, plates, groups in one another, several images on the same axes.
def write_image(name, channel=0, names=("",)):
    image = zarr.open_group(path(name), mode="w", **LATER)
    scales = []
    for number, own in enumerate(names):
        save_zarr(f"{name}/{number}", values("|u1", channel=channel + number), chunks=(4, 5, 8))
        scale = [{"type": "scale", "scale": [4, 2, number + 1]}]
        datasets = [{"path": str(number), "coordinateTransformations": scale}]
        space = [{"name": letter, "type": "space"} for letter in "zyx"]
        scales.append({"version": "0.4", "name": own, "axes": space, "datasets": datasets})
    image.attrs["multiscales"] = scales


def write_groups(name, told, inner):
    zarr.open_group(path(name), mode="w", **LATER).attrs.update(told)
    for each in inner:
        zarr.open_group(path(f"{name}/{each}"), mode="w", **LATER)


PLACED = {"spacing": [1.0, 2.0, 4.0]}
write_groups("container.zarr", {"bioformats2raw.layout": 3}, ["OME"])
write_image("container.zarr/0")
note("container.zarr", [(None, "uint8")], **PLACED)
write_groups("plate.zarr", {"plate": {"wells": [{"path": "A/1"}]}}, ["A", "A/1"])
write_image("plate.zarr/A/1/0")
write_image("plate.zarr/A/1/1", channel=5)
note("plate.zarr", [(None, "uint8")], warnings=["'A/1/0' is shown. Enter another one as Dataset: 'A/1/0', 'A/1/1'"],
     **PLACED)
note("plate.zarr", [("A/1/1", "uint8", 1, 5)], dataset="A/1/1", **PLACED)
write_groups("deeper.zarr", {}, ["run", "run/fields"])
save_zarr("deeper.zarr/run/fields/a", values("|u1"), chunks=(4, 5, 8))
note("deeper.zarr", [("a", "uint8")])
write_image("several.zarr", names=("near", "", "near"))
note("several.zarr", [(None, "uint8")], warnings=["'near', 'multiscales/1', 'multiscales/2'"], **PLACED)
note("several.zarr", [("multiscales/1", "uint8", 1, 1)], dataset="multiscales/1", spacing=[2.0, 2.0, 4.0])


# Zarr, version 3, which zarr 2 cannot write: by hand, after the specification.
def write_version3(name, codecs, chunk, shard=None, orders=(), components=1, numbers=(), endian="little"):
    """numbers, codecs: names, or codecs of numcodecs, which get its names; numbers come before the bytes."""
    data = values("<f4", components)
    os.makedirs(path(name))
    encode = {
        "gzip": lambda raw: GZip().encode(raw),
        "zstd": lambda raw: bytes(Zstd().encode(raw)),
        "blosc": lambda raw: bytes(Blosc("lz4").encode(raw)),
    }

    def describe(codec):
        if isinstance(codec, str):
            return {"name": codec, "configuration": {}}
        configuration = codec.get_config()
        return {"name": "numcodecs." + configuration.pop("id"), "configuration": configuration}

    inner = [{"name": "transpose", "configuration": {"order": order}} for order in orders]
    inner += [describe(codec) for codec in numbers]
    inner += [{"name": "bytes", "configuration": {"endian": endian}}]
    inner += [describe(codec) for codec in codecs]
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
        for codec in numbers:
            whole = codec.encode(whole)
        raw = whole.astype(whole.dtype.newbyteorder("<" if endian == "little" else ">")).tobytes()
        for codec in codecs:
            raw = encode[codec](raw) if isinstance(codec, str) else bytes(codec.encode(np.frombuffer(raw, "u1")))
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
# Codecs of version 2, as zarr-python 3 names them.
for codec in (Zlib(), LZ4(), BZ2(), LZMA(), Blosc("zstd")):
    write_version3(f"three_{codec.codec_id}.zarr", [codec], [4, 5, 8])
write_version3("three_shuffle.zarr", [Shuffle(4), "zstd"], [2, 5, 4], [4, 10, 8])
write_version3("three_bitround.zarr", [Zstd()], [4, 5, 8], numbers=[BitRound(8)], endian="big")
scaled = [FixedScaleOffset(offset=-3, scale=10, dtype="<f4", astype="<i2"), Delta("<i2", "<i4")]
write_version3("three_fixedscaleoffset.zarr", [GZip()], [4, 5, 8], numbers=scaled, endian="big")
# Axes that are transposed, and again: to the order of C, or of Fortran.
turn, around = [2, 1, 0], [1, 2, 0]
for name, orders in (("turned", [turn]), ("twice", [turn, turn]), ("still", [turn, [0, 1, 2]]),
                     ("around", [around] * 3)):
    write_version3(f"three_{name}.zarr", [], [4, 5, 8], None, orders)
    write_version3(f"three_{name}_sharded.zarr", ["zstd"], [2, 5, 4], [4, 10, 8], orders)


def write_zip(name, source, method, inside="", large=False):
    """A folder as a ZIP archive, without its folders; `inside`: one around all."""
    with zipfile.ZipFile(path(name), "w", method) as archive:
        for where, _, files in sorted(os.walk(path(source))):
            for each in sorted(files):
                member = os.path.join(where, each)
                with archive.open(inside + os.path.relpath(member, path(source)), "w", force_zip64=large) as out, \
                        open(member, "rb") as file:
                    out.write(file.read())
        archive.comment = b'{"ome": {"version": "0.5"}}' if name.endswith(".ozx") else b""


# OME's zipped Zarr, and others: several arrays, levels, shards; compressed, in a folder, with numbers of 64 bits.
write_zip("ome_zipped.ozx", "ome.zarr", zipfile.ZIP_STORED)
note("ome_zipped.ozx", channels, steps=3, spacing=[1.0, 2.0, 4.0], levels=2)
write_zip("group_zipped.zip", "group.zarr", zipfile.ZIP_DEFLATED, "group.zarr/", large=True)
note("group_zipped.zip", [("a", "uint8"), ("b", "float32", 1, 2)])
write_zip("holes_zipped.zip", "holes.zarr", zipfile.ZIP_STORED)
note("holes_zipped.zip", [("holes_zipped", "float32")], fill=42.0, filled=[8, 5, 4])
write_zip("three_zipped.ozx", "three_sharded.zarr", zipfile.ZIP_STORED)
note("three_zipped.ozx", [(None, "float32")])
write_zip("raw_zipped.zip", "raw_float32.zarr", zipfile.ZIP_DEFLATED)
note("raw_zipped.zip", [("raw_zipped", "float32")])
