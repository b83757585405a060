#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Prints the measured tables of docs/performance.md, as Markdown, for this machine:

    python3 tests/benchmarks/report.py [--bench build/bin/dsm_bench] [--samples 256]

Nothing else should run meanwhile. It takes about four minutes on two idle cores, and 1 GiB of memory."""

import argparse
import datetime
import os
import re
import subprocess

from measuring import BENCH, HERE, SESSION, run_bench

PROJECT = os.path.normpath(os.path.join(HERE, "..", ".."))
ORGANIZATIONS = (("Replicated", "replicated"), ("Object based", "object"), ("Page based", "paged"))
VOLUMES = (("noisy sphere", "sphere", 0.5), ("mixing layer", "rm", 127.5))
MEDIA = ("shell", "fog", "ramp")
EDGES = (("1 byte", "uchar"), ("2 bytes", "short"), ("4 bytes", "float"), ("8 bytes", "double"))


def find_processor():
    with open("/proc/cpuinfo", encoding="utf-8") as text:
        names = re.findall(r"^model name\s*:\s*(.+)$", text.read(), flags=re.MULTILINE)
    return names[0] if names else "unknown processor"


def find_version():
    with open(os.path.join(PROJECT, "CMakeLists.txt"), encoding="utf-8") as text:
        version = re.search(r"project\(\w+ VERSION ([\d.]+)", text.read()).group(1)
    commit = subprocess.run(["git", "-C", PROJECT, "rev-parse", "--short", "HEAD"], stdout=subprocess.PIPE,
                            stderr=subprocess.DEVNULL, text=True, check=False).stdout.strip()
    return version + (f" ({commit})" if commit else "")


def print_table(title, head, rows):
    print(f"**{title}**\n\n| {' | '.join(head)} |\n|{'---|' * len(head)}")
    for row in rows:
        print(f"| {' | '.join(str(cell) for cell in row)} |")
    print(flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bench", default=BENCH)
    parser.add_argument("--samples", type=int, default=256, help="along each axis of the volumes")
    options = parser.parse_args()
    cores = os.cpu_count()

    def measure(kind, samples, ranks=1, benchmark="isosurface", **more):
        name, isovalue = next((name, value) for title, name, value in VOLUMES if title == kind)
        more = {"volume": f"{name}:{samples}:float", "isovalue": isovalue, "threads": cores, **more}
        return run_bench(options.bench, ranks, benchmark, **more)

    size = f"{options.samples}^3"
    print(f"{datetime.date.today()}, version {find_version()}, {find_processor()}, {cores} cores. Volumes of {size} "
          "floats, pictures of 512 x 512 pixels. Load of the machine at the start: "
          f"{os.getloadavg()[0]:.1f}.\n")

    def describe_rate(result):
        rays = result["rays_per_second"] / 1e6
        return f"{rays:.1f}" if rays >= 1 else f"{rays:.2f}"

    def rate(kind, store):
        return describe_rate(measure(kind, options.samples, store=store, frames=10, repeat=2))

    def measure_media(kind):
        """By function: the rates of all organizations, unshaded."""
        name = next(name for title, name, _ in VOLUMES if title == kind)
        media = run_bench(options.bench, 1, "medium", volume=f"{name}:{options.samples}:float", threads=cores,
                          store=",".join(store for _, store in ORGANIZATIONS), shade="off", frames=3, repeat=2)["media"]
        return {function: [describe_rate(medium) for medium in media if medium["function"] == function]
                for function in MEDIA}

    print_table(f"Million primary rays per second, one rank, {cores} threads, all bricks in memory",
                ("volume", *(title for title, _ in ORGANIZATIONS)),
                [(kind, *(rate(kind, store) for _, store in ORGANIZATIONS)) for kind, _, _ in VOLUMES] +
                [(f"{kind}, as a volume: {function}", *rates) for kind, _, _ in VOLUMES
                 for function, rates in measure_media(kind).items()])

    def light(kind, **more):
        result = measure(kind, options.samples, store="replicated", frames=4, repeat=2, **more)
        return f"{result['frame_over_primary_frame']:.1f}"

    print_table("Time of a frame with light, over the frame without",
                ("volume", "hard shadows", "1 occlusion ray", "both"),
                [(kind, light(kind, shadows="on"), light(kind, occlusion=1), light(kind, shadows="on", occlusion=1))
                 for kind, _, _ in VOLUMES])

    # Two ranks of this machine that share nothing, as two hosts; a session at the mouse.
    samples = options.samples // 2
    rows = []
    for title, store in ORGANIZATIONS:
        for cache in (0.16, 0.05) if store != "replicated" else (1,):
            result = measure("mixing layer", samples, ranks=2, threads=max(1, cores // 2), store=store, session=SESSION,
                             cache_fraction=cache, repeat=2)
            frames = result["frames"]
            rows.append((title, "" if cache == 1 else f"{100 * cache:.0f} %", f"{result['frames_per_second']:.1f}",
                         f"{(result['misses'] - result['joins']) / frames:.1f}", f"{100 * result['idle_part']:.1f} %"))
    print_table(f"A session of turning, zooming and moving the isovalue: two ranks as separate hosts, mixing layer "
                f"of {samples}^3",
                ("memory organization", "cache, of all bricks", "frames/s", "misses per frame", "threads idle"), rows)

    rows = []
    for title, name in EDGES:
        result = measure("noisy sphere", 128, volume=f"sphere:128:{name}",
                         isovalue=0.5 if name in ("float", "double") else 32,
                         store="replicated", frames=1)
        width = int(title[0])
        rows.append((title, f"{result['brick_bytes'] / 1000:.0f} kB",
                     f"{result['resident_bytes'] / (128 ** 3 * width):.2f}"))
    print_table("Bricks of a volume", ("samples", "bytes of a brick", "all bricks, over the volume's bytes"), rows)

    result = run_bench(options.bench, 1, "mesh", mesh="grid:708", threads=cores)
    order = result["orders"][0]
    rays = order["caches"][0]["frames_per_second"] * 512 * 512 / 1e6
    print_table("A mesh", ("triangles", "million primary rays/s", "bytes per triangle", "seconds to build the bricks"),
                [(f"{result['triangles']:,}", f"{rays:.1f}", f"{order['bytes_per_triangle']:.1f}",
                  f"{order['build_seconds']:.2f}")])


if __name__ == "__main__":
    main()
