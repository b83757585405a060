# SPDX-License-Identifier: BSD-3-Clause
"""Debug views: what they show has the colours it should, over the same pixels."""

from vtkmodules.vtkIOImage import vtkPNGReader

from dsm_testing import *

load_plugin()
view = create_view()
view.UseFXAA = 0
volume = simple.DSMSampleVolume(Dimensions=[64, 64, 64])
display = show(volume, view, [0.5], "f", DSMMemoryOrganization="Object based", DSMHostSharing=0)
place_camera(view)


def draw(mode, name=None):
    display.DSMDebugView = mode
    return render(view, name)


def count_hues(pixels):
    """The colours, without their brightness, of the pixels that are covered."""
    colors = pixels[covered].astype(float)
    colors = colors[colors.max(axis=1) > 60]
    return len({tuple(color) for color in numpy.round(4 * colors / colors.max(axis=1)[:, None])})


plain = draw("Off", "off")
display.DSMShowLegend = 0
covered = get_covered(plain)
check(covered.mean() > 0.05, "there is a surface")
for mode in ("Owner of the data", "Rank that traced", "Brick", "Normal", "Depth",
             "Tiles that changed hands", "Level"):
    pixels = draw(mode)
    check((get_covered(pixels) == covered).mean() > 0.995, mode + " covers the same pixels")
owners = count_hues(draw("Owner of the data"))
check(get_ranks() <= owners <= 2 * get_ranks(), f"{owners} hues for {get_ranks()} owners")
tracers = count_hues(draw("Rank that traced"))
check(1 <= tracers <= 2 * get_ranks(), f"{tracers} hues for {get_ranks()} ranks that traced")
check(count_hues(draw("Brick", "brick")) > 8, "bricks have many colours")
changed = draw("Tiles that changed hands")[covered].astype(int)
is_red = changed[:, 0] > 2 * changed[:, 1] + 20
check(get_ranks() > 1 or not is_red.any(), "one rank keeps its tiles")
display.DSMScheduler = "Central queue"
draw("Rank that traced")
display.DSMScheduler = "Work stealing"
# The legend reaches over the picture, on several ranks too; what is shown does not.
position = list(view.CameraPosition)
for _ in range(3):
    render(view)
    place_camera(view)
check(numpy.allclose(position, view.CameraPosition), "a reset of the camera finds what is shown")
# Published anew, nothing is cached; and drawn once, since what was fetched stays.
display.DSMDebugView = "Misses"
display.DSMHostSharing = 1
render(view)
display.DSMHostSharing = 0
image = view.SMProxy.CaptureWindow(1)
width, height, _ = image.GetDimensions()
misses = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, -1)[:, :, :3]
check((misses[covered].max() > 0) == (get_ranks() > 1), "tiles wait for what other ranks own")
draw("Normal", "normal")
draw("Depth", "depth")

# The legend says which color is whose, at the lower left, and the figures stand above.
without = draw("Owner of the data")
display.DSMShowLegend = 1
legend = render(view)
changed = abs(legend - without).max(axis=2) > 0
rows, columns = numpy.nonzero(changed)
check(changed.mean() > 0.02, "there is a legend")
check(rows.max() < 100 and columns.max() < 200, "in its corner")
panel = legend[: rows.max() + 1, : columns.max() + 1].reshape(-1, 3)
colors = {tuple(color) for color in panel if color.max() - color.min() > 60}
check(len(colors) >= get_ranks(), f"{len(colors)} colours in the legend of {get_ranks()} ranks")
simple.SaveScreenshot(os.path.join(OUTPUT, f"legend.{get_ranks()}.png"), view)
check_equal(draw("Off"), plain, "and off again", 0)

display.DSMShowStatistics = 1
view.ViewSize = [420, 240]
annotated = render(view)
display.SMProxy.UpdatePropertyInformation()
summary = display.GetPropertyValue("DSMStatisticsSummary")
simple.SaveScreenshot(os.path.join(OUTPUT, f"statistics.{get_ranks()}.png"), view)
display.DSMShowStatistics = 0
changed = abs(annotated - render(view)).max(axis=2) > 0
rows, columns = numpy.nonzero(changed)
check(changed.mean() > 0.05 and rows.min() > 120, "the figures stand at the upper border")
ranks = "1 rank," if get_ranks() == 1 else f"{get_ranks()} ranks,"
check(ranks in summary and " ms, " in summary, f"and say: {summary!r}")
check("samples" not in summary, "of one sample there is nothing to say")
display.DSMSamplesPerPixel = 4
render(view)
display.SMProxy.UpdatePropertyInformation()
summary = display.GetPropertyValue("DSMStatisticsSummary")
check(" ms, 4 of 4 samples, " in summary, f"how many samples the picture has: {summary!r}")
check("object based" in summary.lower(), "how the bricks are kept")

# A screenshot that is larger than the window is rendered in tiles; the figures and the legend are drawn once.
display.DSMSamplesPerPixel = 1


def read(path):
    reader = vtkPNGReader()
    reader.SetFileName(path)
    reader.Update()
    width, height, _ = reader.GetOutput().GetDimensions()
    pixels = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())
    return pixels.reshape(height, width, -1)[:, :, :3].astype(int)


def save(name):
    """The rows and columns where annotations are, of a screenshot of twice the window's size."""
    path = os.path.join(OUTPUT, f"{name}.{get_ranks()}.png")
    display.DSMShowStatistics = display.DSMShowLegend = 0
    simple.SaveScreenshot(path, view, ImageResolution=[840, 480])
    without = read(path)
    display.DSMShowStatistics = int(name == "statistics_in_tiles")
    display.DSMShowLegend = int(name == "legend_in_tiles")
    simple.SaveScreenshot(path, view, ImageResolution=[840, 480])
    return numpy.nonzero(abs(read(path) - without).max(axis=2) > 60)


rows, columns = save("statistics_in_tiles")
check(rows.min() > 240 and columns.min() < 40, f"figures once, at the upper left: rows from {rows.min()} on")
display.DSMDebugView = "Brick"
rows, columns = save("legend_in_tiles")
check(rows.max() < 200 and columns.max() < 420, f"a legend once, at the lower left: rows up to {rows.max()}")
