# SPDX-License-Identifier: BSD-3-Clause
"""A picture shows each level of a pyramid where its samples are about a pixel wide: like the finest level, without a
seam, the same on any ranks, and out of few bytes. Called as run.py does, with a program that writes a pyramid, a Python
and a folder behind the other arguments."""

import subprocess

from dsm_testing import *

WRITE, PYTHON, FOLDER = sys.argv[3:6]
os.environ["XDG_CACHE_HOME"] = os.path.join(OUTPUT, "caches", str(get_ranks()))
SIZE = (2048, 2048, 1024)  # of which the chunks of a box are there
BOX = (896, 1152, 896, 1152, 320, 1024)
PIXELS = 128
ISOVALUE = 110.0

load_plugin()
path = os.path.join(FOLDER, f"pyramid{get_ranks()}.zarr")
if not os.path.isdir(path):
    environment = {name: value for name, value in os.environ.items() if not name.startswith(("OMPI", "PMIX"))}
    subprocess.run([PYTHON, WRITE, "--size", *map(str, SIZE), "--write", path, "--box", *map(str, BOX)],
                   check=True, timeout=100, env=environment)

view = create_view(PIXELS, PIXELS)
view.UseFXAA = 0
source = simple.OpenDataFile(path)
source.UpdatePipeline()
array = source.PointData.GetArray(0).GetName()
low, high = source.PointData.GetArray(0).GetRange()
check(0.0 <= low < 60.0 and 180.0 < high < 256.0, f"the range is that of a coarser level: {low} to {high}")


def look(depth):
    """Looks into the box from a place that is so far from its front; the far end is at a level of its own."""
    view.CameraViewUp = [0, 1, 0]
    view.CameraPosition = [1024 + 0.3 * depth, 1024 + 0.2 * depth, 1024 + depth]
    view.CameraFocalPoint = [1024, 1024, 700]


def compare(name, depth):
    look(depth)
    display.DSMLevelOfDetail = "Automatic"
    picture = render(view, f"ByView{name}{depth}")
    display.DSMLevelOfDetail = "Finest"
    finest = render(view)
    apart = abs(picture - finest)
    check(get_covered(finest).mean() > 0.3, f"{name}, {depth}: something is shown")
    check(0 < apart.max(), f"{name}, {depth}: coarser levels are shown")
    check(apart.mean() <= 2.0, f"{name}, {depth}: like the finest: {apart.mean():.3f} of 255")
    wrong = (get_covered(picture) != get_covered(finest)).mean()
    check(wrong < 0.01, f"{name}, {depth}: covers the same pixels but {100 * wrong:.2f} %")
    return picture


display = show(source, view, [ISOVALUE], array)
simple.Render(view)  # which moves the camera, the first time
with Messages() as messages:
    pictures = [compare("Isosurface", depth) for depth in (60, 150)]
    check(abs(pictures[0] - pictures[1]).mean() > 2.0, "the camera moves")
    display.DSMLevelOfDetail = "Automatic"
    display.DSMShadows = 1
    render(view, "ByViewShadows")
    display.DSMShadows = 0
    display.DSMLevelOfDetail = "Automatic"
    look(150)
    check_equal(render(view), pictures[1], "the way there does not matter", 0)
    source.OwnOrigin = 1
    check_equal(render(view), pictures[1], "nor does a new dataset with the same values", 0)
    display.DSMDebugView, display.DSMShowLegend = "Level", 0
    colors = render(view).reshape(-1, 3)
    colors = colors[colors.max(axis=1) > 80]
    reds = (colors[:, 0] > 2 * colors[:, 1:].max(axis=1)).mean()
    check(0.1 < reds < 0.98, f"the finest level has {100 * reds:.0f} % of the picture, others the rest")
    display.DSMDebugView = "Off"
    simple.Hide(source, view)
    display = simple.GetDisplayProperties(source, view)
    display.Representation = "DSM Volume"
    simple.ColorBy(display, ("POINTS", array))
    simple.GetColorTransferFunction(array).RescaleTransferFunction(0.0, 255.0)
    simple.GetOpacityTransferFunction(array).Points = [0, 0, 0.5, 0, 90, 0, 0.5, 0, 150, 0.5, 0.5, 0, 255, 1, 0.5, 0]
    display.ScalarOpacityUnitDistance = 20.0
    simple.Show(source, view)
    compare("Volume", 150)
    display.Representation = "DSM Slices"
    compare("Slices", 150)
check("ERROR:" not in messages.text and "Warning:" not in messages.text, f"no message: {messages.text}")
