# SPDX-License-Identifier: BSD-3-Clause
"""Views: several at once, resized, larger screenshots; hiding, showing, deleting; the frame report."""

from dsm_testing import *
from vtkmodules.vtkIOImage import vtkPNGReader

load_plugin()
ISOVALUES = [130.0, 200.0]
source = simple.Wavelet()
first = create_view()
display = show(source, first, ISOVALUES)
place_camera(first)
picture = render(first, "FirstView")
check(get_covered(picture).any(), "the first view shows the surface")

# The report has a row for every rank, and adds up.
def get_resident():
    return sum(row["BytesResident"] for row in get_rows(display))


rows = get_rows(display)
resident = get_resident()
check([row["Rank"] for row in rows] == list(range(get_ranks())), "every rank reports")
check(sum(row["Tiles"] for row in rows) == (300 + 15) // 16 * ((240 + 15) // 16), "all tiles traced")
check(all(row["Accesses"] == row["Hits"] + row["Misses"] for row in rows), "accesses add up")
check(all(row["BytesResident"] > 0 for row in rows), "every rank owns bricks")
check(float(str(display.GetProperty("DSMFrameTime"))) > 0.0, "the frame took some time")

# Threads and memory change the speed only.
display.DSMCacheSize = 1
display.DSMThreads = 3
check_equal(render(first), picture, "with a small cache and three threads")
check(all(row["Threads"] == 3 and row["CacheCapacity"] <= 1 << 20 for row in get_rows(display)),
      "as was asked for")
display.DSMCacheSize = 256
display.DSMThreads = 0

# Sizes.
first.ViewSize = [333, 257]
odd = render(first, "OddSize")
check(odd.shape[:2] == (257, 333), "the view has its new size")
first.ViewSize = [1, 1]
render(first)
first.ViewSize = [300, 240]
check_equal(render(first), picture, "back to the old size")
path = os.path.join(OUTPUT, f"Large.{get_ranks()}.png")
simple.SaveScreenshot(path, first, ImageResolution=[900, 720])
reader = vtkPNGReader()
reader.SetFileName(path)
reader.Update()
large = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars()).reshape(720, 900, -1)
large = large[:, :, :3].astype(int)
small = large[1::3, 1::3]
wrong = (get_covered(small) != get_covered(picture)).mean()
check(wrong < 0.01, f"a screenshot three times as large shows the same ({100 * wrong:.2f} %)")
check_equal(render(first), picture, "and changes nothing")

# Each other pixel while interacting, by way of the view's image reduction.
first.StillRenderImageReductionFactor = 2
reduced = render(first)
wrong = (get_covered(reduced) != get_covered(picture)).mean()
check(wrong < 0.02, f"a reduced image shows the same ({100 * wrong:.2f} %)")
first.StillRenderImageReductionFactor = 1
first.SMProxy.InteractiveRender()
check_equal(render(first), picture, "still rendering after interactive rendering")

# A selection, which renders the view in passes of its own.
outline = show_surface(simple.Outline(source), first)
simple.SelectSurfacePoints(Rectangle=[0, 0, 299, 239], View=first)
simple.ClearSelection(source)
simple.ClearSelection()
simple.Delete(outline)
check_equal(render(first), picture, "after a selection")

# Stereo: an eye's picture is red, the other's is blue.
first.StereoType = "Red-Blue"
first.StereoRender = 1
stereo = render(first)
check((stereo[:, :, 0] != stereo[:, :, 2]).any() and get_covered(stereo).any(), "stereo")
first.StereoRender = 0
check_equal(render(first), picture, "and mono")

# The camera: parallel, inside the volume, a narrow clipping range.
first.CameraParallelProjection = 1
check(get_covered(render(first, "Parallel")).any(), "parallel projection")
first.CameraParallelProjection = 0
position = list(first.CameraPosition)
first.CameraPosition = [1.0, 2.0, 3.0]
first.CameraFocalPoint = [0.0, 0.0, -10.0]
check(get_covered(render(first, "Inside")).any(), "from inside the volume")
first.CameraFocalPoint = [0.0, 0.0, 0.0]
first.CameraPosition = position

# Moved by the representation's own transform.
PLACE = ([3.0, 0.0, 0.0], [0.0, 30.0, 0.0], [1.0, 0.5, 1.0])
transform(display, *PLACE)
moved = render(first, "Transformed")
surface = flying_edges(source, ISOVALUES)
simple.Hide(source, first)
triangles = show_surface(surface, first)
transform(triangles, *PLACE)
check_same_surface(moved, render(first), "Transformed", 0.02)
simple.Delete(surface)
simple.Show(source, first)
transform(display)

# A second view of the same source, with other settings, leaves the first alone.
second = create_view(200, 200)
other = show(source, second, [157.0])
other.DiffuseColor = other.AmbientColor = [1.0, 0.5, 0.0]
other.Specular = 0.6
place_camera(second, (1.0, 0.1, 0.0))
orange = render(second, "SecondView")
brightest = orange[get_covered(orange)].max(axis=0)
check(brightest[0] > 200 and brightest[2] < brightest[0], "the second view is orange")
check_equal(render(first), picture, "the first view is as before")

# Hiding, showing, changing the representation, deleting.
simple.Hide(source, first)
check(not get_covered(render(first)).any(), "hidden")
simple.Show(source, first)
check_equal(render(first), picture, "shown again")
display.Representation = "Outline"
check(get_covered(render(first)).mean() < 0.1, "as an outline")
display.Representation = REPRESENTATION
check_equal(render(first), picture, "ray traced again")
simple.Delete(other)
check(not get_covered(render(second)).any(), "deleted from the second view")
check_equal(render(first), picture, "still in the first view")
simple.Delete(second)
check_equal(render(first), picture, "without the second view")

check(get_resident() == resident, "the bricks of the deleted representation are gone")

# Two volumes in one view hide one another by depth.
shifted = simple.Wavelet(Center=[6.0, 0.0, 0.0])
show(shifted, first, [157.0])
render(first, "TwoVolumes")
simple.Delete(shifted)
check_equal(render(first), picture, "the second volume is gone")
check(get_resident() == resident, "and its bricks")
simple.Delete(source)
check(not get_covered(render(first)).any(), "nothing is left")

# A comparative view: each of its cells keeps what it was given, whatever the source has become since.
def compare(traced, surface, source, name, values):
    pictures = []
    for show_it in (traced, surface):
        view = simple.CreateView("ComparativeRenderView", ViewSize=[300, 150], Dimensions=[2, 1])
        view.OrientationAxesVisibility = 0
        show_it(view)
        cue = servermanager.animation.ComparativeAnimationCue()
        cue.AnimatedProxy, cue.AnimatedPropertyName = source, name
        for column, value in enumerate(values):
            cue.SMProxy.UpdateValue(column, 0, value)
        view.Cues = [cue]
        view.CameraPosition, view.CameraFocalPoint = [0.0, 0.0, 12.0 * values[-1] ** 0.5], [0.0, 0.0, 0.0]
        pictures.append(render(view))
        simple.Delete(view)
    for what, cell in (("first", numpy.s_[:, :149]), ("last", numpy.s_[:, 151:])):
        mine, expected = (picture[cell] for picture in pictures)
        check_same_surface(mine, expected, f"the {what} cell of {name}", 0.02)


wavelet, sphere = simple.Wavelet(), simple.Sphere(ThetaResolution=32, PhiResolution=32)
edges = flying_edges(wavelet, [160.0])
compare(lambda view: show(wavelet, view, [160.0]), lambda view: show_surface(edges, view), wavelet, "XFreq", (5, 20))
compare(lambda view: show_traced(sphere, view), lambda view: show_surface(sphere, view), sphere, "Radius", (1, 3))
