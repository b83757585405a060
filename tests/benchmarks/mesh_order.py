# SPDX-License-Identifier: BSD-3-Clause
"""Misses and frames/s of a mesh whose triangles share bricks by place, as in the file, or at random,
as the cache shrinks: Fig. 8 of the paper.

    mesh_order.py --mesh SCAN.ply [--subdivide 2] [--ranks 2] [--caches 1,0.5,0.25,0.1,0.05]
                  [--size 32x32] [--frames 4] [--arc 40] [--chart FILE.svg] [--json FILE]
                  [--from-json FILE]

A ray of a mesh in random order visits nearly every brick, so the pictures are small. The camera moves
along a part of an orbit, twice, and the second time counts: the caches are warm. Every setting must
give the same pictures. Prints a table in Markdown; the chart needs no other program.
"""
import argparse
import json
import math
import sys

from measuring import BENCH, run_bench

ORDERS = (("sorted", "sorted in space", "#1a7f37"), ("original", "as in the file", "#0969da"),
          ("random", "random", "#cf222e"))


def run(arguments):
    return run_bench(
        arguments.bench, arguments.ranks, "mesh", mesh=arguments.mesh,
        subdivide=arguments.subdivide, order=",".join(name for name, _, _ in ORDERS),
        cache_fraction=arguments.caches, size=arguments.size, frames=arguments.frames,
        arc=arguments.arc, repeat=2, threads=1, store="object")


def read(result):
    """For each order: bytes a triangle, and (cache fraction, misses a frame, frames/s)."""
    table = {}
    hashes = set()
    for order in result["orders"]:
        rows = [(cache["cache_fraction"], cache["misses"] / result["frames"],
                 cache["frames_per_second"]) for cache in order["caches"]]
        hashes.update(cache["image_hash"] for cache in order["caches"])
        table[order["order"]] = (order["bytes_per_triangle"], rows)
    if len(hashes) != 1:
        sys.exit("The pictures are not the same: " + ", ".join(sorted(hashes)))
    return table


def print_table(result, table):
    width, height = result["size"]
    print(f"{result['triangles']:,} triangles, {result['rank_count']} ranks, {width} x {height} "
          f"pixels, {result['frames']} positions along {result['arc']:g} degrees; all pictures are "
          "equal bit for bit.\n")
    print("| cache | " + " | ".join(
        f"{title}: misses a frame | frames/s" for _, title, _ in ORDERS) + " |")
    print("|---" * (1 + 2 * len(ORDERS)) + "|")
    for index, row in enumerate(table["sorted"][1]):
        cells = []
        for name, _, _ in ORDERS:
            _, misses, speed = table[name][1][index]
            cells += [f"{misses:,.0f}", f"{speed:.3g}"]
        print(f"| {row[0]:g} | " + " | ".join(cells) + " |")
    print("\nBytes a triangle: " + ", ".join(
        f"{title} {table[name][0]:.1f}" for name, title, _ in ORDERS) + ".")


class Plot:
    """One logarithmic plot over the cache fraction, which falls to the right, as in the paper."""

    def __init__(self, left, title, caches, values):
        self.left, self.title = left, title
        self.top, self.width, self.height = 30, 250, 150
        self.caches = [math.log(cache) for cache in caches]
        known = [value for value in values if value > 0] or [1]
        self.low = math.floor(math.log10(min(known)))
        self.high = max(math.ceil(math.log10(max(known))), self.low + 1)

    def place(self, cache, value):
        first, last = max(self.caches), min(self.caches)
        across = (first - math.log(cache)) / ((first - last) or 1)
        up = (math.log10(max(value, 10 ** self.low)) - self.low) / (self.high - self.low)
        return self.left + across * self.width, self.top + (1 - up) * self.height

    def draw(self, lines):
        parts = [f'<text x="{self.left}" y="18" font-weight="bold">{self.title}</text>']
        for power in range(self.low, self.high + 1):
            _, y = self.place(math.exp(self.caches[0]), 10.0 ** power)
            parts.append(f'<path d="M{self.left} {y:.1f}h{self.width}" stroke="#d0d7de"/>')
            label = f"{10.0 ** power:g}"
            parts.append(f'<text x="{self.left - 5}" y="{y + 4:.1f}" text-anchor="end">{label}</text>')
        for cache in self.caches:
            x, _ = self.place(math.exp(cache), 1)
            y = self.top + self.height + 15
            parts.append(f'<text x="{x:.1f}" y="{y}" text-anchor="middle">{math.exp(cache):g}</text>')
        for color, points in lines:
            places = [self.place(*point) for point in points]
            path = "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in places)
            parts.append(f'<path d="{path}" fill="none" stroke="{color}" stroke-width="2"/>')
            parts += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{color}"/>'
                      for x, y in places]
        return parts


def draw_chart(table, path):
    caches = [row[0] for row in table["sorted"][1]]
    parts = ['<svg xmlns="http://www.w3.org/2000/svg" width="720" height="240" '
             'font-family="sans-serif" font-size="11">', '<rect width="720" height="240" fill="#fff"/>']
    for left, title, column in ((70, "misses a frame", 1), (420, "frames/s", 2)):
        lines = [(color, [(row[0], row[column]) for row in table[name][1]])
                 for name, _, color in ORDERS]
        plot = Plot(left, title + ", over cache / mesh", caches,
                    [value for _, points in lines for _, value in points])
        parts += plot.draw(lines)
    for index, (_, title, color) in enumerate(ORDERS):
        x = 70 + 150 * index
        parts.append(f'<circle cx="{x}" cy="222" r="4" fill="{color}"/>')
        parts.append(f'<text x="{x + 10}" y="226">{title}</text>')
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(parts + ["</svg>"]) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bench", default=BENCH)
    parser.add_argument("--mesh", default="")
    parser.add_argument("--from-json", default="", help="what --json wrote; nothing is run")
    parser.add_argument("--subdivide", type=int, default=2)
    parser.add_argument("--ranks", type=int, default=2)
    parser.add_argument("--caches", default="1,0.5,0.25,0.1,0.05")
    parser.add_argument("--size", default="32x32")
    parser.add_argument("--frames", type=int, default=4, help="camera positions")
    parser.add_argument("--arc", type=float, default=40.0, help="degrees that the camera moves")
    parser.add_argument("--chart", default="")
    parser.add_argument("--json", default="")
    arguments = parser.parse_args()
    if arguments.from_json:
        with open(arguments.from_json, encoding="utf-8") as file:
            result = json.load(file)
    else:
        result = run(arguments)
    table = read(result)
    print_table(result, table)
    if arguments.json:
        with open(arguments.json, "w", encoding="utf-8") as file:
            json.dump(result, file, indent=2)
    if arguments.chart:
        draw_chart(table, arguments.chart)


if __name__ == "__main__":
    main()
