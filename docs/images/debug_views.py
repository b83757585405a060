# SPDX-License-Identifier: BSD-3-Clause
"""Makes debug_views.png and handed_tiles.png:
    xvfb-run -a -s "-noreset -screen 0 1280x1024x24" mpirun -np 4 pvbatch debug_views.py PLUGIN FOLDER"""

import os
import sys

import numpy
from paraview import simple

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from pictures import draw, write

PLUGIN, FOLDER = sys.argv[1:]
VIEWS = ("Owner of the data", "Rank that traced", "Brick", "Tile time",
         "Misses", "Tiles that changed hands", "Normal", "Depth")

simple.LoadPlugin(os.path.abspath(PLUGIN), remote=False, ns=vars(simple))
view = simple.CreateRenderView(ViewSize=[420, 360])
view.OrientationAxesVisibility = 0
volume = simple.DSMSampleVolume(Dimensions=[128] * 3)
display = simple.Show(volume, view)
display.Representation = "DSM Ray Traced"
display.DSMIsoArray = ["POINTS", "f"]
display.DSMIsoValues = [0.5]
display.DSMMemoryOrganization = "Object based"
display.DSMHostSharing = 0
display.DSMCacheSize = 1
simple.ResetCamera(view)
view.GetActiveCamera().Dolly(1.55)
camera = view.GetActiveCamera()


def draw_moved(scheduler, mode):
    """The last of some frames with a camera that moves."""
    display.DSMScheduler = scheduler
    display.DSMDebugView = mode
    for _ in range(4):
        camera.Azimuth(4.0)
        pixels = draw(view)
    camera.Azimuth(-16.0)
    return pixels


sheet = [draw_moved("Work stealing", mode) for mode in VIEWS]
# The first row of pixels is the lowest one.
write(os.path.join(FOLDER, "debug_views.png"),
      numpy.vstack([numpy.hstack(sheet[4:]), numpy.hstack(sheet[:4])]))
display.DSMCacheSize = 0
write(os.path.join(FOLDER, "handed_tiles.png"), numpy.hstack(
    [draw_moved(scheduler, "Tiles that changed hands") for scheduler in ("Work stealing", "Central queue")]))
