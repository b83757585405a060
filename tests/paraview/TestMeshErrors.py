# SPDX-License-Identifier: BSD-3-Clause
"""What is wrong with a surface is named, together with what to do; whatever else is in the view is
still drawn, and the surface too, once it can be."""

from dsm_testing import *

load_plugin()
view = create_view()
view.UseFXAA = 0


def render_and_listen():
    """The picture, and what was said about it; that must not be said again for the next one."""
    with Messages() as messages:
        pixels = render(view)
        first = messages.text
        again = render(view)
        check(messages.text == first, "what is wrong is said once")
    check_equal(again, pixels, "and the next picture is the same", tolerance=0)
    return pixels, first


# A small surface that stays in the view all the while, on the left of what comes.
companion = simple.Sphere(Center=[-1.5, 0, 0], ThetaResolution=32, PhiResolution=24)
small = show_traced(companion, view, DSMMemory=64)
# 290,000 triangles, on each of 4 ranks more than a MiB.
large = simple.Sphere(Center=[1.5, 0, 0], ThetaResolution=480, PhiResolution=300)
display = show_traced(large, view, DSMMemory=64, DSMMemoryOrganization="Object based")
place_camera(view, (0, 0, 1))
with Messages():
    both = render(view)
middle = both.shape[1] // 2


def check_alone(pixels, what):
    """Of the two surfaces, the small one is there, as it was."""
    check_equal(pixels[:, :middle], both[:, :middle], what + ": the other surface is drawn", 0)
    check(not get_covered(pixels)[:, middle:].any(), what + ": it is not")


check(get_covered(both)[:, middle:].any(), "the large surface is there")

# More than the memory holds: the demand of both counts, so the small one asks for as little.
simple.Hide(large, view)
small.DSMMemory = display.DSMMemory = 1
simple.Show(large, view)
large.PhiResolution = 301
pixels, text = render_and_listen()
check("the surface: The data owned by rank " in text, "it is said what is too large: " + text)
check("DSMMemory" in text and " bytes" in text, "how much is needed, and what to change")
check("use at least" in text and "ranks with as much memory" in text, "how many ranks would do")
check_alone(pixels, "A surface that does not fit the memory")
small.DSMMemory = display.DSMMemory = 64
pixels, text = render_and_listen()
check("ERROR" not in text, "with enough memory nothing is wrong: " + text)
check(get_covered(pixels)[:, middle:].any(), "and it is drawn")

# Arrays that cannot color it: the surface appears in its solid color.
ARRAYS = """
from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkStringArray
output = self.GetOutputDataObject(0)
short = vtkDoubleArray()
short.SetName("short")
short.SetNumberOfTuples(7)
names = vtkStringArray()
names.SetName("names")
names.SetNumberOfValues(output.GetNumberOfCells())
if output.GetNumberOfCells():
    output.GetCellData().AddArray(short)
    output.GetCellData().AddArray(names)
"""
simple.Delete(large)
ball = simple.Sphere(Center=[1.5, 0, 0], ThetaResolution=480, PhiResolution=301)
colored = simple.ProgrammableFilter(Input=ball, Script=ARRAYS)
with Messages() as messages:
    display = show_traced(colored, view, DSMMemory=64)
    solid = render(view)
check(get_covered(solid)[:, middle:].any(), "without a colour array it is drawn")
for array, words in (("short", ["'short' has 7 values", "shown without them"]),
                     ("names", ["'names' contains text", "Categories"]),
                     ("nothing", ["'nothing' does not exist", "'short'"])):
    display.ColorArrayName = ["CELLS", array]
    pixels, text = render_and_listen()
    for word in words:
        check(word in text, f"'{word}' is in: {text}")
    check(("ERROR" in text) == (array != "nothing"), "what is not there is a warning, as the surface is there")
    check_equal(pixels, solid, f"colour by {array}: the surface has its solid colour")
display.ColorArrayName = [None, ""]
pixels, text = render_and_listen()
check("ERROR" not in text, "without a colour array nothing is wrong: " + text)
