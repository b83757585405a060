#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A volume that is larger than the memory of all ranks, opened, shown and turned in ParaView: what each rank has in
memory, what it reads, and how long a picture takes.

    tests/benchmarks/large_volume.py build/lib/DSMRayTracer/DSMRayTracer.so --gib 8 --folder /var/tmp

writes a file of chunks (HDF5) to the folder, runs pvbatch on it twice, since the first opening looks through all of it,
and deletes it. What the process has in memory before it opens anything is told apart."""

import argparse
import json
import os
import shutil
import subprocess
import sys
import time

ISOVALUES = [-1.0, -0.5, 0.0, 0.5, 1.0]
CHUNK = 64


def write_volume(path, gib, compressed):
    import h5py
    import numpy

    edge = CHUNK
    while edge**3 * 4 < gib * 2**30:
        edge += CHUNK
    along = numpy.linspace(0, 1, edge, dtype=numpy.float32)
    plane = numpy.sin(20 * along)[:, None] * numpy.cos(17 * along)[None, :]
    options = {"compression": "gzip", "compression_opts": 1, "shuffle": True} if compressed else {}
    with h5py.File(path, "w") as file:
        values = file.create_dataset("f", (edge,) * 3, "f4", chunks=(CHUNK,) * 3, **options)
        for first in range(0, edge, CHUNK):
            rows = numpy.sin(23 * along[first : first + CHUNK])
            values[first : first + CHUNK] = plane[None] + rows[:, None, None]
    return edge


def look(pids):
    """Of each process: MiB that it has had in memory at most, that it has now, and that it has read."""
    found = []
    for pid in pids:
        status = dict(line.split(":", 1) for line in open(f"/proc/{pid}/status") if ":" in line)
        read = dict(line.split(":") for line in open(f"/proc/{pid}/io"))
        sizes = [int(status[key].split()[0]) >> 10 for key in ("VmHWM", "VmRSS")]
        found.append((*sizes, int(read["rchar"]) >> 20))
    return found


def show(plugin, path, edge, memory, places):
    """In pvbatch."""
    import math

    from paraview import simple

    with open(f"/proc/{os.getppid()}/task/{os.getppid()}/children") as children:
        pids = [int(pid) for pid in children.read().split()]
    simple.LoadPlugin(plugin, ns=vars(simple))
    view = simple.CreateRenderView(ViewSize=[800, 600])
    view.UseFXAA = 0
    simple.Render(view)
    before = look(pids)
    start = time.time()
    volume = simple.DSMVolumeReader(FileName=path)
    display = simple.Show(volume, view)
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
        camera.SetPosition(middle + far * math.cos(angle), middle + 0.4 * far, middle + far * math.sin(angle))
        camera.SetViewUp(0, 1, 0)
        view.CameraPosition, view.CameraFocalPoint = camera.GetPosition(), camera.GetFocalPoint()
        view.CameraViewUp = camera.GetViewUp()
        view.StillRender()

    place(0, places)
    first = time.time() - start
    opened = look(pids)
    display.SMProxy.UpdatePropertyInformation()
    rows = json.loads(str(display.GetProperty("DSMStatistics")).strip("'"))
    print(f"first picture: {first:.1f} s, read {[b[2] - a[2] for a, b in zip(before, opened)]} MiB by the ranks, "
          f"bricks in memory {[row['BytesCached'] >> 20 for row in rows]} MiB", flush=True)
    seconds = []
    for value in ISOVALUES:
        display.DSMIsoValues = [value]
        for step in range(places):
            start = time.time()
            place(step, places)
            seconds.append(time.time() - start)
    after = look(pids)
    seconds.sort()
    print(f"{len(seconds)} pictures: median {seconds[len(seconds) // 2]:.2f} s, longest {seconds[-1]:.2f} s, "
          f"read {[b[2] - a[2] for a, b in zip(opened, after)]} MiB", flush=True)
    print(f"memory of each rank: {[a[1] for a in before]} MiB before, at most {[b[0] for b in after]} MiB; "
          f"limit {memory} MiB; beyond both {[b[0] - a[1] - memory for a, b in zip(before, after)]} MiB", flush=True)
    if any(b[0] - a[1] - memory > 150 for a, b in zip(before, after)):
        raise SystemExit("more than 150 MiB beyond the limit")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("plugin")
    parser.add_argument("--gib", type=float, default=8.0)
    parser.add_argument("--compressed", action="store_true")
    parser.add_argument("--ranks", type=int, default=2)
    parser.add_argument("--memory", type=int, default=512, help="MiB of each rank")
    parser.add_argument("--places", type=int, default=20, help="of the camera, for each of five isovalues")
    parser.add_argument("--folder", default="/var/tmp")
    parser.add_argument("--mpirun", default="mpirun --oversubscribe --allow-run-as-root")
    options = parser.parse_args()
    folder = os.path.join(options.folder, f"dsm-bench-{os.getpid()}")
    os.makedirs(folder)
    try:
        path = os.path.join(folder, "volume.h5")
        start = time.time()
        edge = write_volume(path, options.gib, options.compressed)
        print(f"{edge}^3 samples, {os.path.getsize(path) >> 20} MiB in the file, "
              f"written in {time.time() - start:.0f} s", flush=True)
        environment = dict(os.environ, XDG_CACHE_HOME=os.path.join(folder, "caches"))
        for opening in ("first", "second"):
            print(f"-- {opening} opening", flush=True)
            subprocess.run(
                ["xvfb-run", "-a", "-s", "-noreset -screen 0 1280x1024x24", *options.mpirun.split(), "-np", str(options.ranks), "pvbatch", __file__,
                 "--show", os.path.abspath(options.plugin), path, str(edge), str(options.memory), str(options.places)],
                env=environment, check=True,
            )
    finally:
        shutil.rmtree(folder)


if len(sys.argv) > 1 and sys.argv[1] == "--show":
    show(sys.argv[2], sys.argv[3], *map(int, sys.argv[4:7]))
elif __name__ == "__main__":
    main()
