#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Serves an OME-Zarr pyramid of any size over HTTP. Chunks are computed when they are asked for; no data are on disk.

    serve_pyramid.py [--size 8192 8192 4096] [--chunk 64] [--delay MILLISECONDS] [--port 0] [--end-with-input]
    serve_pyramid.py [--size 8192 8192 4096] [--chunk 64] --write FOLDER [--box X0 X1 Y0 Y1 Z0 Z1]

The first line of the output is `port N`. The pyramid is at http://127.0.0.1:N/pyramid.zarr.

/stats: requests and bytes of answered chunks as JSON, in all and by level. /reset: sets them to zero.

Values are unsigned bytes. They are nearly 0 at the border of the volume, and 24 to 231 around 127.5 in its middle: a
gyroid of three periods along each axis and one of about 200 samples, times a window. A sample of level k is the mean
of the function at 2^k samples of level 0 along each axis. At the upper border, the function continues beyond the
volume.

With --write, a folder gets the same pyramid. Its chunks are those that meet the box, which is in samples of level 0
without the last. Other chunks are missing and have the fill value 0."""

import argparse
import http.server
import itertools
import json
import math
import os
import sys
import threading
import time

import numpy

NAME = "pyramid.zarr"
LARGEST_OF_COARSEST = 128
PERIODS = 3  # of the coarse gyroid
WAVE_LENGTHS = (200.0, 213.0, 187.0)  # of the fine gyroid along x, y and z
MEAN, COARSE, FINE = 127.5, 45.0, 24.0  # a gyroid is within -1.5 and 1.5
WINDOW = 16  # The window along an axis is 1 - cos(pi x / size)^WINDOW.
# Factors along x, y and z of each term, by their number in list_factors().
TERMS = (
    (MEAN, (0, 0, 0)),
    (COARSE, (1, 2, 0)), (COARSE, (0, 1, 2)), (COARSE, (2, 0, 1)),
    (FINE, (3, 4, 0)), (FINE, (0, 3, 4)), (FINE, (4, 0, 3)),
)


def list_factors(size, wave_length):
    """Functions along one axis, each as cosines: rows of amplitude, angular frequency and phase. The window; its
    products with the sine and the cosine of the coarse gyroid; those with the fine gyroid's."""
    half = WINDOW // 2
    window = [(1.0 - math.comb(WINDOW, half) / 2**WINDOW, 0.0)]
    window += [(-2.0 * math.comb(WINDOW, half - order) / 2**WINDOW, 2 * math.pi * order / size)
               for order in range(1, half + 1)]
    factors = [[(amplitude, frequency, 0.0) for amplitude, frequency in window]]
    for length in (size / PERIODS, wave_length):
        for phase in (-math.pi / 2, 0.0):
            factors.append([(amplitude / 2, 2 * math.pi / length + side * frequency, phase)
                            for amplitude, frequency in window for side in (1, -1)])
    return [numpy.array(factor) for factor in factors]


def tabulate(factor, count, step):
    """The means of a factor over `step` samples of level 0 each. The mean of a cosine over samples is the cosine at
    their center, attenuated."""
    amplitude, frequency, phase = factor.T
    sine = numpy.sin(frequency / 2)
    is_constant = numpy.abs(sine) < 1e-12
    attenuation = numpy.where(is_constant, 1.0,
                              numpy.sin(step * frequency / 2) / (step * numpy.where(is_constant, 1.0, sine)))
    centers = step * numpy.arange(count) + (step - 1) / 2
    return numpy.cos(numpy.outer(centers, frequency) + phase) @ (amplitude * attenuation)


class Level:
    """A level of the pyramid. Axes are in the order x, y, z."""

    def __init__(self, number, whole, chunk):
        self.step = 2**number
        self.size = [math.ceil(size / self.step) for size in whole]
        self.counts = [math.ceil(size / chunk) for size in self.size]
        self.chunk = chunk
        # Chunks are full at the border, too.
        tables = [[tabulate(factor, count * chunk, self.step) for factor in list_factors(size, length)]
                  for size, length, count in zip(whole, WAVE_LENGTHS, self.counts)]
        # Along each axis, a row for each term.
        self.tables = [numpy.array([table[places[axis]] for _, places in TERMS], numpy.float32)
                       for axis, table in enumerate(tables)]
        self.tables[0] *= numpy.array([[amplitude] for amplitude, _ in TERMS], numpy.float32)

    def compute(self, places):
        """The bytes of a chunk."""
        x, y, z = (table[:, place * self.chunk : (place + 1) * self.chunk]
                   for table, place in zip(self.tables, places))
        columns = (z[:, :, None] * y[:, None, :]).reshape(len(TERMS), -1)
        values = columns.T @ x
        values += 0.5
        return values.astype(numpy.uint8).tobytes()

    def describe(self):
        return {
            "zarr_format": 2, "shape": self.size[::-1], "chunks": [self.chunk] * 3, "dtype": "|u1", "compressor": None,
            "fill_value": 0, "filters": None, "order": "C", "dimension_separator": "/",
        }


class Pyramid:
    def __init__(self, size, chunk):
        self.tag = f'"{"x".join(map(str, size))}-{chunk}"'
        self.levels = []
        while not self.levels or max(self.levels[-1].size) > LARGEST_OF_COARSEST:
            self.levels.append(Level(len(self.levels), size, chunk))
        datasets = [{
            "path": str(number),
            "coordinateTransformations": [
                {"type": "scale", "scale": [float(level.step)] * 3},
                {"type": "translation", "translation": [(level.step - 1) / 2] * 3},
            ],
        } for number, level in enumerate(self.levels)]
        image = {"version": "0.4", "name": "pyramid", "type": "mean", "datasets": datasets,
                 "axes": [{"name": name, "type": "space"} for name in "zyx"]}
        texts = {".zgroup": {"zarr_format": 2}, ".zattrs": {"multiscales": [image]}}
        texts.update((f"{number}/.zarray", level.describe()) for number, level in enumerate(self.levels))
        texts[".zmetadata"] = {"zarr_consolidated_format": 1, "metadata": dict(texts)}
        self.metadata = {key: json.dumps(text, indent=2).encode() for key, text in texts.items()}

    def find_chunk(self, key):
        """Returns the level's number and the chunk's places along x, y and z, or None if there is no such chunk."""
        words = key.split("/")
        if len(words) != 4 or not all(word.isascii() and word.isdigit() for word in words):
            return None
        number, *places = map(int, words)
        places.reverse()
        if number >= len(self.levels) or any(map(int.__ge__, places, self.levels[number].counts)):
            return None
        return number, places


def write_file(path, content):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "wb") as file:
        file.write(content)


def write_pyramid(pyramid, folder, box):
    if os.path.exists(folder):
        raise SystemExit(f"'{folder}' exists already. Delete it, or enter another folder.")
    for key, text in pyramid.metadata.items():
        write_file(os.path.join(folder, key), text)
    for number, level in enumerate(pyramid.levels):
        edge = level.step * level.chunk
        ranges = [range(max(0, first // edge), min(count, math.ceil(end / edge)))
                  for first, end, count in zip(box[::2], box[1::2], level.counts)]
        for places in itertools.product(*ranges):
            path = os.path.join(folder, str(number), *map(str, reversed(places)))
            write_file(path, level.compute(places))


class Counts:
    """Requests and bytes of answered chunks."""

    def __init__(self, levels):
        self.levels = levels
        self.guard = threading.Lock()
        self.reset()

    def reset(self):
        with self.guard:
            self.rows = {str(number): {"requests": 0, "bytes": 0} for number in range(self.levels)}

    def add(self, number, size):
        with self.guard:
            row = self.rows[str(number)]
            row["requests"] += 1
            row["bytes"] += size

    def describe(self):
        with self.guard:
            sums = {name: sum(row[name] for row in self.rows.values()) for name in ("requests", "bytes")}
            return json.dumps({**sums, "by_level": self.rows}).encode()


class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    disable_nagle_algorithm = True  # head and body are sent one after the other

    def log_message(self, *_):
        pass

    def answer(self, status, body=b"", tag=None):
        self.send_response(status)
        if status != 304:
            self.send_header("Content-Length", str(len(body)))
        if tag:
            self.send_header("ETag", tag)
        self.end_headers()
        if self.command != "HEAD":
            self.wfile.write(body)

    def do_GET(self):
        counts = self.server.counts
        if self.path == "/stats":
            self.answer(200, counts.describe())
        elif self.path == "/reset":
            counts.reset()
            self.answer(200)
        else:
            time.sleep(self.server.delay)
            self.answer_key()

    do_HEAD = do_GET

    def answer_key(self):
        pyramid = self.server.pyramid
        beginning = f"/{NAME}/"
        key = self.path[len(beginning) :] if self.path.startswith(beginning) else ""
        chunk = pyramid.find_chunk(key)
        if chunk is None and key not in pyramid.metadata:
            self.answer(404)
            return
        if self.headers.get("If-None-Match") == pyramid.tag:
            self.answer(304, tag=pyramid.tag)
            return
        if chunk is None:
            self.answer(200, pyramid.metadata[key], pyramid.tag)
            return
        number, places = chunk
        body = pyramid.levels[number].compute(places)
        if self.command == "GET":
            self.server.counts.add(number, len(body))
        self.answer(200, body, pyramid.tag)


class Server(http.server.ThreadingHTTPServer):
    daemon_threads = True
    request_queue_size = 64

    def __init__(self, port, pyramid, delay):
        super().__init__(("127.0.0.1", port), Handler)
        self.pyramid = pyramid
        self.delay = delay
        self.counts = Counts(len(pyramid.levels))

    def handle_error(self, *_):
        pass  # A client may leave at any time.


def parse_count(text):
    number = int(text)
    if number < 1:
        raise argparse.ArgumentTypeError(f"'{text}' is not a number of samples. Enter 1 or more.")
    return number


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", type=parse_count, nargs=3, default=[8192, 8192, 4096], metavar=("X", "Y", "Z"),
                        help="samples of level 0")
    parser.add_argument("--chunk", type=parse_count, default=64, help="samples along each edge of a chunk")
    parser.add_argument("--delay", type=float, default=0.0, help="milliseconds before each answer")
    parser.add_argument("--port", type=int, default=0, help="0: a free one")
    parser.add_argument("--end-with-input", action="store_true", help="end when the standard input ends")
    parser.add_argument("--write", metavar="FOLDER", help="write the pyramid to a folder instead of serving it")
    parser.add_argument("--box", type=int, nargs=6, metavar=("X0", "X1", "Y0", "Y1", "Z0", "Z1"),
                        help="the part to write, in samples of level 0; all by default")
    options = parser.parse_args()
    pyramid = Pyramid(options.size, options.chunk)
    if options.write:
        x, y, z = options.size
        write_pyramid(pyramid, options.write, options.box or (0, x, 0, y, 0, z))
        return
    server = Server(options.port, pyramid, options.delay / 1000)
    print("port", server.server_port, flush=True)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    if options.end_with_input:
        sys.stdin.read()
    else:
        threading.Event().wait()


if __name__ == "__main__":
    main()
