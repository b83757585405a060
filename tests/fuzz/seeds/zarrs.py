# SPDX-License-Identifier: BSD-3-Clause
"""Zarr: metadata as programs write them, and the bytes of chunks and shards for the arrays of zarr_arrays.json."""

import json
import os
import struct

import numpy as np
from numcodecs import GZip, Zlib, Zstd, get_codec

from seeds.common import values, write

ARRAYS = os.path.join(os.path.dirname(__file__), "..", "zarr_arrays.json")


def crc32c(raw):
    value = 0xFFFFFFFF
    for byte in raw:
        value ^= byte
        for _ in range(8):
            value = (value >> 1) ^ (0x82F63B78 if value & 1 else 0)
    return value ^ 0xFFFFFFFF


def fletcher32(raw):
    first = second = 0
    for at in range(0, len(raw) // 2 * 2, 2):
        first = (first + (raw[at] << 8 | raw[at + 1])) % 65535
        second = (second + first) % 65535
    return second << 16 | first


def encode(raw, codec):
    name = codec.get("id") or codec["name"]
    if name == "crc32c":
        return raw + struct.pack("<I", crc32c(raw))
    if name == "fletcher32":
        return raw + struct.pack("<I", fletcher32(raw))
    if name in ("bytes", "transpose"):
        return raw
    if name in ("zlib", "gzip", "zstd"):
        return bytes({"zlib": Zlib(), "gzip": GZip(), "zstd": Zstd()}[name].encode(raw))
    configuration = {**codec.get("configuration", codec), "id": name.replace("numcodecs.", "")}
    kind = configuration.get("dtype", "f4" if name == "bitround" else "u1")
    return np.ascontiguousarray(get_codec(configuration).encode(np.frombuffer(raw, kind).copy())).tobytes()


def encode_all(raw, codecs):
    for codec in codecs:
        raw = encode(raw, codec)
    return raw


def make_chunk(metadata):
    """The bytes of the first chunk, whose values have no meaning: all of its axes are as long as the chunk's."""
    if metadata["zarr_format"] == 2:
        raw = values(metadata["dtype"], metadata["chunks"]).tobytes()
        compressor = metadata["compressor"]
        return encode_all(raw, (metadata["filters"] or []) + ([compressor] if compressor else []))
    shape = metadata["chunk_grid"]["configuration"]["chunk_shape"]
    codecs = metadata["codecs"]
    if codecs[0]["name"] != "sharding_indexed":
        return encode_all(values(np.dtype(metadata["data_type"]), shape).tobytes(), codecs)
    shards = codecs[0]["configuration"]
    inner = shards["chunk_shape"]
    chunk = encode_all(values(np.dtype(metadata["data_type"]), inner).tobytes(), shards["codecs"])
    count = int(np.prod([s // c for s, c in zip(shape, inner)]))
    is_first = shards.get("index_location") == "start"
    index_bytes = len(encode_all(bytes(16 * count), shards["index_codecs"]))
    index = b""
    for number in range(count):
        offset = number * len(chunk) + (index_bytes if is_first else 0)
        index += struct.pack("<QQ", *((2**64 - 1, 2**64 - 1) if number == 1 else (offset, len(chunk))))
    index = encode_all(index, shards["index_codecs"])
    return index + chunk * count if is_first else chunk * count + index


def make_chunks(folder):
    with open(ARRAYS, encoding="utf-8") as file:
        arrays = json.load(file)
    for number, array in enumerate(arrays):
        write(folder, "ZarrChunks", array["name"], bytes([number]) + make_chunk(array["metadata"]))


def join(files):
    """The format of FuzzZarrMetadata.cxx."""
    return "\n".join(f"==> {name}\n{text if isinstance(text, str) else json.dumps(text)}"
                     for name, text in files.items())


def make_metadata(folder):
    with open(ARRAYS, encoding="utf-8") as file:
        arrays = json.load(file)
    for array in arrays:
        name = "zarr.json" if array["metadata"]["zarr_format"] == 3 else ".zarray"
        write(folder, "ZarrMetadata", array["name"], join({name: array["metadata"], array["chunk"]: "0123456789"}))
    plain = arrays[0]["metadata"]
    sized = lambda *shape: {**plain, "shape": shape, "chunks": [min(3, n) for n in shape]}
    write(folder, "ZarrMetadata", "names", join({
        ".zarray": {**sized(2, 6, 4, 5), "fill_value": "NaN"},
        ".zattrs": {"_ARRAY_DIMENSIONS": ["time", "z", "y", "x"]}}))
    write(folder, "ZarrMetadata", "channels", join({
        ".zarray": {**sized(6, 4, 5, 2), "chunks": [3, 4, 5, 2]},
        ".zattrs": {"_ARRAY_DIMENSIONS": ["z", "y", "x", "c"]}}))
    write(folder, "ZarrMetadata", "group", join({
        ".zgroup": {"zarr_format": 2}, ".zattrs": '{"missing": NaN, "least": -Infinity}',
        "0/.zarray": sized(6, 4, 5), "1/.zarray": sized(3, 2, 3), "a/.zarray": sized(6, 4, 5), "0/0.0.0": "abc"}))
    axes = [{"name": "t", "type": "time"}, {"name": "c", "type": "channel"}]
    axes += [{"name": name, "type": "space", "unit": "micrometer"} for name in "zyx"]
    scales = [{"path": str(level), "coordinateTransformations": [
        {"type": "scale", "scale": [1, 1, 4 << level, 2 << level, 1 << level]},
        {"type": "translation", "translation": [0, 0, 1, 2, 3]}]} for level in (0, 1)]
    image = {"multiscales": [{"version": "0.4", "axes": axes, "datasets": scales,
                              "coordinateTransformations": [{"type": "scale", "scale": [1, 1, 2, 2, 2]}]}],
             "omero": {"channels": [{"label": "red"}, {"label": "red"}]}}
    write(folder, "ZarrMetadata", "ome2", join({
        ".zgroup": {"zarr_format": 2}, ".zattrs": image, "0/.zarray": sized(3, 2, 6, 4, 5),
        "1/.zarray": sized(3, 2, 3, 2, 3)}))
    third = next(one["metadata"] for one in arrays if one["metadata"]["zarr_format"] == 3)
    grid = lambda *shape: {**third, "shape": shape, "chunk_grid": {
        "name": "regular", "configuration": {"chunk_shape": [min(3, n) for n in shape]}}}
    write(folder, "ZarrMetadata", "ome3", join({
        "zarr.json": {"zarr_format": 3, "node_type": "group", "attributes": {"ome": image}},
        "0/zarr.json": grid(3, 2, 6, 4, 5), "1/zarr.json": grid(3, 2, 3, 2, 3)}))
    write(folder, "ZarrMetadata", "names3", join({
        "zarr.json": {**grid(2, 6, 4, 5), "dimension_names": ["time", "z", "y", None], "fill_value": "0x7fc00000",
                      "chunk_key_encoding": {"name": "v2", "configuration": {"separator": "."}}}}))


def make(folder):
    make_chunks(folder)
    make_metadata(folder)
