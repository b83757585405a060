#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A volume that is larger than the memory of all ranks, opened, shown and turned in ParaView and in dsm_bench: what
each rank has in memory, what it reads, how long a picture takes, and how long ParaView's own reader takes.

    tests/benchmarks/large_volume.py build --gib 8 --folder /var/tmp

`build` is the project's build folder. Writes a VTKHDF file of chunks with h5py, and what dsm_convert makes of it, to
the folder, and deletes them. What a process has in memory before it opens anything is told apart. Files leave the
system's cache before they are opened. With --keep the files stay, and are taken the next time."""

import argparse
import json
import os
import shutil
import subprocess
import sys
import time

from measuring import get_rows

ISOVALUES = [-1.0, -0.5, 0.0, 0.5, 1.0]
CHUNK = 64
BEYOND = 150  # MiB that a rank may take beyond its limit and what it had before


def write_volume(path, gib):
    import h5py
    import numpy

    edge = CHUNK
    while edge**3 * 4 < gib * 2**30:
        edge += CHUNK
    along = numpy.linspace(0, 1, edge, dtype=numpy.float32)
    plane = numpy.sin(20 * along)[:, None] * numpy.cos(17 * along)[None, :]
    with h5py.File(path, "w") as file:
        image = file.create_group("VTKHDF")
        image.attrs["Version"] = [1, 0]
        image.attrs["Type"] = numpy.bytes_("ImageData")
        image.attrs["WholeExtent"] = [0, edge - 1] * 3
        image.attrs["Origin"], image.attrs["Spacing"] = [0.0] * 3, [1.0] * 3
        image.attrs["Direction"] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
        values = image.create_dataset("PointData/f", (edge,) * 3, "f4", chunks=(CHUNK,) * 3)
        for first in range(0, edge, CHUNK):
            rows = numpy.sin(23 * along[first : first + CHUNK])
            values[first : first + CHUNK] = plane[None] + rows[:, None, None]


def forget(path):
    """The system keeps nothing of the file in memory."""
    file = os.open(path, os.O_RDONLY)
    os.fsync(file)
    os.posix_fadvise(file, 0, 0, os.POSIX_FADV_DONTNEED)
    os.close(file)


def look(pids):
    """Of each process: MiB that it has had in memory at most, that it has now, and that it has read."""
    found = []
    for pid in pids:
        status = dict(line.split(":", 1) for line in open(f"/proc/{pid}/status") if ":" in line)
        read = dict(line.split(":") for line in open(f"/proc/{pid}/io"))
        sizes = [int(status[key].split()[0]) >> 10 for key in ("VmHWM", "VmRSS")]
        found.append((*sizes, int(read["rchar"]) >> 20))
    return found


def show(plugin, path, memory, places):
    """In pvbatch."""
    import math

    from paraview import simple

    with open(f"/proc/{os.getppid()}/task/{os.getppid()}/children") as children:
        pids = [int(pid) for pid in children.read().split()]
    simple.LoadPlugin(plugin, ns=vars(simple))
    view = simple.CreateRenderView(ViewSize=[800, 600])
    view.UseFXAA = 0
    simple.Render(view)
    forget(path)
    before = look(pids)
    start = time.time()
    volume = simple.DSMVolumeReader(FileName=path)
    display = simple.Show(volume, view)
    edge = volume.GetDataInformation().GetExtent()[1] + 1
    simple.ColorBy(display, None)
    display.Representation = "DSM Ray Traced"
    display.DSMMemory = memory
    display.DSMIsoValues = [ISOVALUES[-1]]
    camera = view.GetActiveCamera()
    middle = edge / 2
    far = 1.9 * edge

    def place(step, steps):
        angle = 2 * math.pi * step / steps
        camera.SetFocalPoint(middle, middle, middle)
        camera.SetPosition(
            middle + far * math.cos(angle), middle + 0.4 * far, middle + far * math.sin(angle)
        )
        camera.SetViewUp(0, 1, 0)
        view.CameraPosition, view.CameraFocalPoint = camera.GetPosition(), camera.GetFocalPoint()
        view.CameraViewUp = camera.GetViewUp()
        view.StillRender()

    place(0, places)
    first = time.time() - start
    opened = look(pids)
    rows = get_rows(display)
    seconds = []
    for value in ISOVALUES:
        display.DSMIsoValues = [value]
        for step in range(places):
            start = time.time()
            place(step, places)
            seconds.append(time.time() - start)
    after = look(pids)
    seconds.sort()
    beyond = [b[0] - a[1] - memory for a, b in zip(before, after)]
    report = {
        "first_picture_seconds": round(first, 2),
        "first_picture_mib_read": [b[2] - a[2] for a, b in zip(before, opened)],
        "first_picture_mib_of_bricks": [row["BytesCached"] >> 20 for row in rows],
        "pictures": len(seconds),
        "median_seconds": round(seconds[len(seconds) // 2], 2),
        "longest_seconds": round(seconds[-1], 2),
        "orbit_mib_read": [b[2] - a[2] for a, b in zip(opened, after)],
        "mib_before": [a[1] for a in before],
        "peak_mib": [b[0] for b in after],
        "limit_mib": memory,
        "mib_beyond": beyond,
    }
    print("REPORT " + json.dumps(report), flush=True)


def load(plugin, path, picture):
    """In pvbatch, on one rank: with ParaView's own reader, and what a picture, if it is wanted, takes beside."""
    from paraview import simple

    simple.LoadPlugin(plugin, ns=vars(simple))
    view = simple.CreateRenderView(ViewSize=[800, 600])
    simple.Render(view)
    forget(path)
    start = time.time()
    reader = simple.VTKHDFReader(FileName=path)
    reader.UpdatePipeline()
    report = {"seconds": round(time.time() - start, 2)}
    if reader.GetDataInformation().GetPointDataInformation().GetNumberOfArrays() == 0:
        print("REPORT {}", flush=True)  # VTK 9.1's reads less than 2^31 values
        return
    pids = [os.getpid()]
    loaded = look(pids)[0][1]
    if picture == "picture":
        with open("/proc/self/clear_refs", "w") as peak:
            peak.write("5")  # the peak begins anew
        display = simple.Show(reader, view)
        display.ColorArrayName = [None, ""]
        display.Representation = "DSM Ray Traced"
        display.DSMIsoValues = [ISOVALUES[-1]]
        simple.ResetCamera(view)
        simple.Render(view)
        most, held, _ = look(pids)[0]
        report.update(loaded_mib=loaded, peak_beyond_mib=most - loaded, held_beyond_mib=held - loaded)
    print("REPORT " + json.dumps(report), flush=True)


def run_paraview(options, ranks, *arguments):
    """What this script, called in pvbatch, reports."""
    environment = dict(os.environ, XDG_CACHE_HOME=os.path.join(options.folder, "caches"))
    screen = ["xvfb-run", "-a", "-s", "-noreset -screen 0 1280x1024x24"]
    command = [*screen, *options.mpirun.split(), "-np", str(ranks), "pvbatch", __file__, *arguments]
    done = subprocess.run(
        command, env=environment, check=True, stdout=subprocess.PIPE, universal_newlines=True
    )
    return next(json.loads(line[7:]) for line in done.stdout.splitlines() if line.startswith("REPORT "))


def run_bench(options, ranks, path, **more):
    command = [*options.mpirun.split(), "-np", str(ranks), os.path.join(options.build, "bin", "dsm_bench")]
    command += ["isosurface", "--volume", path, "--isovalue", "1", "--size", "800x600", "--json", "-"]
    for name, value in more.items():
        command += ["--" + name.replace("_", "-"), str(value)]
    forget(path)
    return json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)


def compare_reading(options, path):
    """Of one picture from nothing: bytes read over bytes of the distinct bricks that rays entered."""
    whole = run_bench(options, 1, path, frames=1, memory=4096, prefetch="off")
    rank = whole["opening"]["ranks"][0]
    bricks = (rank["misses"] - rank["joins"]) * whole["brick_bytes"]
    for prefetch in ("on", "off"):
        found = run_bench(options, options.ranks, path, frames=1, memory=options.memory, prefetch=prefetch)
        read = sum(rank["bytes_read"] for rank in found["opening"]["ranks"])
        print(
            f"one picture, prefetch {prefetch}: {found['opening']['seconds']:.2f} s, {read >> 20} MiB read for "
            f"{bricks >> 20} MiB of bricks: {read / bricks:.2f}",
            flush=True,
        )


def convert(options, compression, volume, path):
    converter = os.path.join(options.build, "bin", "dsm_convert")
    command = [*options.mpirun.split(), "-np", str(options.ranks), converter, "--quiet"]
    subprocess.run([*command, "--compression", compression, volume, path], check=True)


def compare_first(options, volume, packed, plugin):
    """The first picture of brick files beside what ParaView's own reader takes to load them, twice in turn.
    `packed`: with Zstandard, for which ParaView 5.11's HDF5 has no filter."""
    print("compression | MiB | first picture, s | ParaView's reader, s | MiB read by a rank")
    for compression in ("none", "deflate", "zstd"):
        path = packed
        if compression != "zstd":
            path = os.path.join(options.folder, f"first_{compression}.vtkhdf")
            convert(options, compression, volume, path)
        for _ in range(2):
            ours = run_paraview(options, options.ranks, "--show", plugin, path, str(options.memory), "1")
            theirs = {} if path == packed else run_paraview(options, 1, "--load", plugin, path, "none")
            print(
                f"{compression} | {os.path.getsize(path) >> 20} | {ours['first_picture_seconds']} | "
                f"{theirs.get('seconds', 'cannot')} | {ours['first_picture_mib_read']}",
                flush=True,
            )
        if path != packed:
            os.remove(path)


def compare_caches(options, path):
    """Frames of an orbit with what it needs in memory, and with a quarter of that, prefetch on and off."""
    warm = run_bench(options, options.ranks, path, frames=options.places, repeat=3, memory=6144)
    needed = max(rank["cache_bytes"] for rank in warm["ranks"]) >> 20
    rows = [("all that it needs", "on", warm)]
    # A part of the memory is for chunks and tables (28 bytes a brick).
    quarter = needed // 4 + int(options.gib * 2**30 / 16**3 / 4 * 28 * 1.1) // 2**20 + 16
    for prefetch in ("on", "off"):
        found = run_bench(
            options, options.ranks, path, frames=options.places, repeat=2, memory=quarter, prefetch=prefetch
        )
        rows.append((f"a quarter ({quarter} MiB)", prefetch, found))
    print(f"orbit of {options.places}, {needed} MiB of bricks in a rank")
    print("cache | prefetch | frames/s | over all | misses | MiB read | idle | picture")
    for name, prefetch, found in rows:
        speed = found["frames_per_second"]
        read = sum(rank["bytes_read"] for rank in found["ranks"]) >> 20
        print(
            f"{name} | {prefetch} | {speed:.2f} | {speed / warm['frames_per_second']:.2f} | {found['misses']} | "
            f"{read} | {found['idle_part']:.2f} | {found['image_hash']}",
            flush=True,
        )


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", help="the project's build folder")
    parser.add_argument("--gib", type=float, default=8.0)
    parser.add_argument("--ranks", type=int, default=2)
    parser.add_argument("--memory", type=int, default=512, help="MiB of each rank")
    parser.add_argument("--places", type=int, default=20, help="of the camera, for each of five isovalues")
    parser.add_argument("--folder", default="/var/tmp")
    parser.add_argument("--keep", action="store_true", help="the files")
    parser.add_argument("--parts", default="open,first,reader,bytes,caches", help="those to run")
    parser.add_argument("--mpirun", default="mpirun --oversubscribe --allow-run-as-root --bind-to none")
    options = parser.parse_args()
    options.build = os.path.abspath(options.build)
    options.folder = os.path.join(os.path.abspath(options.folder), "dsm-large-volume")
    os.makedirs(options.folder, exist_ok=True)
    plugin = os.path.join(options.build, "lib/DSMRayTracer/DSMRayTracer.so")
    names = ("volume.vtkhdf", "zstd.vtkhdf", "small.vtkhdf")
    volume, packed, small = (os.path.join(options.folder, name) for name in names)
    parts = options.parts.split(",")
    too_much = []
    try:
        if not os.path.exists(volume):
            write_volume(volume, options.gib)
        if not os.path.exists(small):
            write_volume(small, 0.5)
        if not os.path.exists(packed):
            convert(options, "zstd", volume, packed)
        for path in (volume, packed, small):
            print(f"{os.path.basename(path)}: {os.path.getsize(path) >> 20} MiB", flush=True)
        for path in (packed, volume, volume) if "open" in parts else ():
            report = run_paraview(
                options, options.ranks, "--show", plugin, path, str(options.memory), str(options.places)
            )
            print(f"{os.path.basename(path)}: {json.dumps(report, indent=2)}", flush=True)
            too_much += [path for beyond in report["mib_beyond"] if beyond > BEYOND]
        if "reader" in parts:
            for path, picture in ((small, "picture"), (volume, "none")):
                report = run_paraview(options, 1, "--load", plugin, path, picture)
                print(f"ParaView's own reader, {os.path.basename(path)}: {json.dumps(report)}", flush=True)
        if "first" in parts:
            compare_first(options, volume, packed, plugin)
        if "bytes" in parts:
            compare_reading(options, packed)
        if "caches" in parts:
            compare_caches(options, packed)
    finally:
        if not options.keep:
            shutil.rmtree(options.folder)
    if too_much:
        raise SystemExit(f"more than {BEYOND} MiB beyond the limit: {too_much}")


if len(sys.argv) > 1 and sys.argv[1] == "--show":
    show(sys.argv[2], sys.argv[3], *map(int, sys.argv[4:6]))
elif len(sys.argv) > 1 and sys.argv[1] == "--load":
    load(*sys.argv[2:5])
elif __name__ == "__main__":
    main()
