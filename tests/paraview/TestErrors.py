# SPDX-License-Identifier: BSD-3-Clause
"""What cannot be drawn is named, together with what to do; the picture stays background, and the
session goes on."""

from dsm_testing import *

load_plugin()
view = create_view()

GOOD = """
image.SetExtent(piece)
add(image, distance(piece), 'other')
add(image, distance(piece))
"""


def expect(source, words, isovalues=(0.7,), array="f", empty=True, **properties):
    """Shows a source and looks for the words in what is reported, which must be reported once."""
    with Messages() as messages:
        display = show(source, view, list(isovalues), array, **properties)
        place_camera(view)
        pixels = render(view)
        first = messages.text
        render(view)
        again = messages.text
    for word in words:
        check(word in first, f"'{word}' is in: {first.strip()}")
    if words:
        check(first.count(words[0]) == again.count(words[0]) == 1, "it is said once")
    if not words:
        check(first.strip() == "", f"nothing is reported: {first.strip()}")
    check(get_covered(pixels).any() != empty, "the picture " + ("is empty" if empty else "is drawn"))
    return display


def expect_then_delete(source, *arguments, **keywords):
    expect(source, *arguments, **keywords)
    simple.Delete(source)


# How the ranks keep the bricks is said with the first picture, and is no error.
first = image_source(GOOD)
show(first, view, [0.7], "f")
render(view)
simple.Delete(first)

expect_then_delete(image_source(GOOD), ["'nonsense' does not exist", "'f', 'other'"],
                   array="nonsense")

TEXTS = """
from vtkmodules.vtkCommonCore import vtkStringArray
image.SetExtent(piece)
add(image, distance(piece))
texts = vtkStringArray(); texts.SetName('names')
texts.SetNumberOfValues(image.GetNumberOfPoints())
image.GetPointData().AddArray(texts)
"""
expect_then_delete(image_source(TEXTS), ["'names' contains text", "'f'"], array="names")

CELLS = """
image.SetExtent(piece)
array = numpy_to_vtk(np.zeros(image.GetNumberOfCells()), deep=True); array.SetName('onCells')
image.GetCellData().AddArray(array)
"""
expect_then_delete(image_source(CELLS), ["'onCells' is a cell array", "['CELLS', 'onCells']"], array="onCells")

expect_then_delete(image_source(GOOD), ["Isovalue 2 of 2 is not a number"],
                   isovalues=[0.7, float("nan")], empty=False)
expect_then_delete(image_source(GOOD), ["The isovalue is infinite"], isovalues=[float("inf")])
expect_then_delete(image_source(GOOD), [], isovalues=[1000.0])
# Without any, the data suggest one.
expect_then_delete(image_source(GOOD), [], isovalues=[], empty=False)
CONSTANT = "image.SetExtent(piece)\nadd(image, 0.0 * points(piece)[0] + 3.0)\n"
expect_then_delete(image_source(CONSTANT), ["'f' has the same value everywhere"], isovalues=[])
# Values beyond 32-bit floats.
for scale in (1e51, 1e-60):
    scaled = f"image.SetExtent(piece)\nadd(image, distance(piece) * {scale})\n"
    expect_then_delete(image_source(scaled), [], isovalues=[], empty=False)
    expect_then_delete(image_source(scaled), [], isovalues=[0.7 * scale], empty=False)

expect_then_delete(image_source("image.SetExtent(piece)\nadd(image, points(piece)[0])\n",
                                (0, 20, 0, 20, 3, 3)), ["no cells along z", "volume"])
expect_then_delete(image_source("image.SetExtent(0, -1, 0, -1, 0, -1)\n"), [])

# Samples that are nowhere. ParaView itself cannot know where to look then.
PLACED = """
image.SetExtent(piece)
image.%s(%s)
add(image, distance(piece))
"""
for method, value, words in (
    ("SetSpacing", "1, 0, 1", "spacing along y is 0"),
    ("SetSpacing", "1, 1, np.nan", "spacing along z is not a number"),
    ("SetOrigin", "-np.inf, 0, 0", "origin along x is infinite"),
):
    expect_then_delete(image_source(PLACED % (method, value)), [words])

VECTOR = "image.SetExtent(piece)\nadd(image, np.stack(points(piece), axis=1), 'v')\n"
expect_then_delete(image_source(VECTOR),
                   ["'v' has the components 0 to 2, and 3 for the magnitude"], array="v", DSMIsoComponent=7)

grid = simple.ProgrammableSource(OutputDataSetType="vtkRectilinearGrid")
grid.ScriptRequestInformation = IMAGE_SOURCE_INFORMATION % "0, 4, 0, 4, 0, 4"
grid.Script = """
from vtkmodules.util.numpy_support import numpy_to_vtk
import numpy as np
grid = self.GetOutputDataObject(0)
grid.SetDimensions(5, 5, 5)
for set in (grid.SetXCoordinates, grid.SetYCoordinates, grid.SetZCoordinates):
    set(numpy_to_vtk(np.array([0.0, 1.0, 2.0, 2.0, 3.0]), deep=True))
array = numpy_to_vtk(np.arange(125.0), deep=True); array.SetName('f')
grid.GetPointData().SetScalars(array)
"""
expect_then_delete(grid, ["coordinates along x neither rise nor fall everywhere (at index 3)"], [60.0])

# A color array that cannot be one: the surface appears, in its solid color.
both = image_source(GOOD + """
array = numpy_to_vtk(np.zeros(image.GetNumberOfCells()), deep=True); array.SetName('onCells')
image.GetCellData().AddArray(array)
array = numpy_to_vtk(np.zeros((image.GetNumberOfCells(), 5)), deep=True); array.SetName('five')
image.GetCellData().AddArray(array)
""")
with Messages() as messages:
    display = show(both, view, [0.7], "f")
    display.ColorArrayName = ["POINTS", "onCells"]
    display.LookupTable = simple.GetColorTransferFunction("onCells")
    place_camera(view)
    pixels = render(view)
    text = messages.text
check("color array 'onCells'" in text and "['CELLS', 'onCells']" in text, "points have no such array: " + text)
check("Warning" in text and "ERROR" not in text, "that is a warning, as the surface is there")
check(get_covered(pixels).any(), "the surface is still drawn")
with Messages() as messages:
    display.ColorArrayName = ["CELLS", "f"]
    check_equal(render(view), pixels, "the points' array of the name does not colour it either")
    text = messages.text
check("ERROR" not in text, "which is a warning, too: ParaView's Surface says nothing")
check("color array 'f' does not exist" in text and "'five', 'onCells'" in text, "the cells' array is meant: " + text)
with Messages() as messages:
    display.ColorArrayName = ["CELLS", "five"]
    display.MapScalars = 0
    check_equal(render(view), pixels, "five numbers are no colour")
    text = messages.text
check("'five' does not contain colors" in text and "Map Scalars" in text, "that is said: " + text)
simple.Delete(both)

# After all that, the same view still draws.
good = image_source(GOOD)
display = expect(good, [], empty=False)
with Messages() as messages:
    display.DSMIsoArray = ["POINTS", "gone"]
    check(not get_covered(render(view)).any(), "nothing is drawn while the array is wrong")
    check("'gone' does not exist" in messages.text, "which is reported")
    display.DSMIsoArray = ["POINTS", "other"]
    check(get_covered(render(view)).any(), "and the surface is back when it is right again")
    before = messages.text
    display.DSMIsoArray = ["POINTS", "gone"]
    render(view)
    check(messages.text.count("'gone'") > before.count("'gone'"), "the same mistake is told anew")

# Numbers that make no sense are said, once for all displays, and again when they are set again later.
for name, bad, kept, good in (
    ("DSMCacheSize", 0, "using 1 (minimum)", 256),
    ("DSMMemory", -5, "using 0 (minimum)", 0),
    ("DSMThreads", 99999, "using 1024 (maximum)", 0),
    ("DSMSilenceLimit", -1, "using 0 (minimum)", 60),
):
    for _ in range(2):
        with Messages() as messages:
            setattr(display, name, bad)
            display.UpdateVTKObjects()
            said = [line for line in messages.text.splitlines() if "out of range" in line]
            check(len(said) == 1 and name in said[0] and f"{bad} is out of range; {kept}" in said[0],
                  f"{name} is {bad}: {said}")
            setattr(display, name, good)
            display.UpdateVTKObjects()

# Nor does it bring them anew to show something else meanwhile.
with Messages() as messages:
    display.DSMCacheSize = 0
    for radius in (1, 2):
        other = simple.Sphere(Radius=radius)
        show_traced(other, view)
        render(view)
        simple.Delete(other)
    said = [line for line in messages.text.splitlines() if "out of range" in line]
    check(len(said) == 1, f"told once, with other displays beside: {said}")
    display.DSMCacheSize = 256

# Where all is behind the camera, VTK's clipping range is all but nothing. ParaView's first picture may be such a one.
behind = create_view()
with Messages() as messages:
    far = simple.Wavelet(WholeExtent=[0, 10, 0, 10, 7, 17], Center=[5, 5, 12])
    show(far, behind, [150.0])
    for kind in (simple.Sphere(Center=[5, 5, 50]), None):
        behind.CameraPosition, behind.CameraFocalPoint = [5.0, 5.0, -100.0], [5.0, 5.0, -200.0]
        check(not get_covered(render(behind)).any(), "nothing is behind the camera to be seen")
        behind.CameraPosition, behind.CameraFocalPoint = [5.0, 5.0, -100.0], [5.0, 5.0, 0.0]
        check(get_covered(render(behind)).any(), "and all before it")
        if kind:
            show_traced(kind, behind)
    said = [line for line in messages.text.splitlines() if "ERR" in line]
    check(not said, f"and nothing is said: {said}")

# Coarser data of a dataset of which no block has bricks: one is flat, one lacks the array.
flat = simple.Wavelet(WholeExtent=[-5, 5, -5, 5, 0, 0])
other = simple.PassArrays(Input=simple.Calculator(Input=simple.Wavelet(WholeExtent=[-5, 5, -5, 5, -5, 5]),
                                                  ResultArrayName="other", Function="RTData*2"),
                          PointDataArrays=["other"])
display = show(simple.GroupDatasets(Input=[other, flat]), behind, [130.0], "RTData")
display.DSMCoarserDataWhileMoving = 1
render(behind)
display.DSMCoarserDataWhileMoving = 0

# A single point has a size, too.
point = create_view()
show_traced(simple.ProbeLocation(Input=simple.Wavelet(), ProbeType="Fixed Radius Point Source"), point)
place_camera(point)
check(get_covered(render(point)).any(), "a single point is seen")
