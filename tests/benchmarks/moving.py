# SPDX-License-Identifier: BSD-3-Clause
"""A drag of the camera over a volume in a file that is not in memory yet: frame times with and without coarser data
while moving. Called as
    pvbatch moving.py PLUGIN FILE ISOVALUE [MEMORY...]
FILE has levels (dsm_convert --levels); MEMORY in MiB of each rank. The system's own copy of the file is dropped
first."""

import os
import sys
import time

from measuring import get_rows
from paraview import simple

PLUGIN, FILE, ISOVALUE = sys.argv[1:4]
MEMORIES = [int(text) for text in sys.argv[4:]] or [64, 1024]
FRAMES = 24


def drop_cached_file():
    descriptor = os.open(FILE, os.O_RDONLY)
    os.posix_fadvise(descriptor, 0, 0, os.POSIX_FADV_DONTNEED)
    os.close(descriptor)


def drag(memory, coarser):
    simple.ResetSession()
    simple.LoadPlugin(PLUGIN, ns=vars(simple))
    view = simple.CreateRenderView(ViewSize=[800, 600], OrientationAxesVisibility=0)
    view.LODThreshold = 0.0
    source = simple.DSMVolumeReader(FileName=FILE)
    display = simple.Show(source, view)
    display.Representation = "DSM Ray Traced"
    display.ColorArrayName = [None, ""]
    display.DSMIsoValues = [float(ISOVALUE)]
    display.DSMMemory = memory
    display.DSMCoarserDataWhileMoving = coarser
    camera = view.GetActiveCamera()
    simple.ResetCamera(view)
    simple.Render(view)  # what is asked of the file when it is opened, and the first picture's bricks
    drop_cached_file()
    seconds, levels = [], []
    for _ in range(FRAMES):
        camera.Azimuth(9.0)
        camera.Elevation(1.5)
        start = time.monotonic()
        view.SMProxy.InteractiveRender()
        seconds.append(time.monotonic() - start)
        levels.append(get_rows(display)[0]["CoarserLevel"])
    start = time.monotonic()
    simple.Render(view)
    return seconds, levels, time.monotonic() - start


print(f"{'MiB':>5} {'coarser':>8} {'median':>8} {'longest':>8} {'drag':>8} {'still':>8}  levels of the frames")
for memory in MEMORIES:
    for coarser in (0, 1):
        seconds, levels, still = drag(memory, coarser)
        ordered = sorted(seconds)
        print(f"{memory:5} {'on' if coarser else 'off':>8} {1e3 * ordered[FRAMES // 2]:6.0f}ms "
              f"{1e3 * ordered[-1]:6.0f}ms "
              f"{sum(seconds):7.1f}s {still:7.2f}s  {''.join(map(str, levels))}", flush=True)
