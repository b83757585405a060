# SPDX-License-Identifier: BSD-3-Clause
"""Where the data suggest no isovalue, an automatic one is the middle of their range, or 0, until they do. State files
tell whether it is automatic. ParaView's Python alone, or with a server at the port that is given."""

from dsm_testing import *
from paraview import smstate

if len(sys.argv) > 3:
    connect(sys.argv[3])
load_plugin()
view = create_view()

image = "image.SetExtent(piece)\nadd(image, %s)\n"


def change(source, values):
    other = image_source(image % values)
    source.Script = other.Script
    simple.Delete(other)


cases = {"a constant array": ("0 * distance(piece) + 7", 7.0),
         "nothing but NaN": ("distance(piece) * float('nan')", 0.0)}
for name, (values, expected) in cases.items():
    source = image_source(image % values)
    display = show_traced(source, view)
    place_camera(view)
    render(view)
    check(display.DSMIsoValue == expected, f"{name}: the isovalue is {display.DSMIsoValue}")
    change(source, "distance(piece)")
    picture = render(view)
    check(get_covered(picture).any(), "data that suggest one are shown at it")
    value = display.DSMIsoValue
    check(0.4 < value < 1.0 and value == display.GetPropertyValue("DSMSuggestedIsoValue"), f"which is told: {value}")
    check_equal(render(view), picture, "and stays", 0)
    change(source, values)
    render(view)
    check(display.DSMIsoValue == (expected or value), f"{name} again: {display.DSMIsoValue}")
    simple.Delete(source)

def go_on(path):
    """Loads a state in which the array was constant; shows other values."""
    for old in simple.GetSources().values():
        simple.Delete(old)
    for old in simple.GetRenderViews():
        simple.Delete(old)
    if path.endswith(".py"):
        with open(path, encoding="utf-8") as text:
            exec(compile(text.read(), path, "exec"), {"__name__": "state"})
    else:
        simple.LoadState(path)
    view = simple.GetActiveView()
    (source,) = simple.GetSources().values()
    display = simple.GetRepresentation(source, view)
    check(display.DSMIsoValue == 7.0, f"{path} has the isovalue {display.DSMIsoValue}")
    is_automatic = display.DSMIsoValueAutomatic
    change(source, "distance(piece)")
    return view, source, display, is_automatic, get_covered(render(view)).any()


source = image_source(image % cases["a constant array"][0])
show_traced(source, view)
place_camera(view)
render(view)
simple.SaveState(os.path.join(OUTPUT, "unchosen.pvsm"))
with open(os.path.join(OUTPUT, "unchosen.py"), "w", encoding="utf-8") as text:
    text.write(smstate.get_state())
simple.GetRepresentation(source, view).DSMIsoValueAutomatic = 0
simple.SaveState(os.path.join(OUTPUT, "chosen.pvsm"))
for name in ("unchosen.pvsm", "unchosen.py"):
    view, source, display, is_automatic, is_shown = go_on(os.path.join(OUTPUT, name))
    check(is_automatic and is_shown, "which is automatic: the surface is there")
    check(0.4 < display.DSMIsoValue < 1.0, f"and the isovalue becomes {display.DSMIsoValue}")
view, source, display, is_automatic, is_shown = go_on(os.path.join(OUTPUT, "chosen.pvsm"))
check(not is_automatic and not is_shown and display.DSMIsoValue == 7.0, "what was chosen stays")
simple.Delete(source)

flat = image_source(image % "distance(piece)", (0, 24, 0, 24, 12, 12))
flat.Script = flat.Script.replace("0.5 * (high - low)", "max(0.5 * (high - low), 1)")
display = show_traced(flat, view)
render(view)
check(0.4 < display.DSMIsoValue < 0.9, f"a flat image: the isovalue is {display.DSMIsoValue}")
check(display.DSMIsoValueAutomatic == 1, "which is automatic")
check(display.DSMShow == "Surface", "its outer surface is shown")
stand_in = display.DSMIsoValue
display.DSMIsoValue = 0.25
display.DSMIsoValue = stand_in
check(display.DSMIsoValueAutomatic == 0, "the same number can be chosen")
simple.Delete(flat)

CELLS = """
image.SetExtent(piece)
values = numpy_to_vtk(np.arange(float(image.GetNumberOfCells())), deep=True)
values.SetName('c')
image.GetCellData().AddArray(values)
"""
cells = image_source(CELLS)
display = show_traced(cells, view)
with Messages():
    render(view)
check(display.DSMIsoArray[1] == "c", f"data of cells only: the array is {display.DSMIsoArray}")
check(display.DSMIsoValue > 0.0, f"data of cells only: the isovalue is {display.DSMIsoValue}")
simple.Delete(cells)

# Data without an array show their outer surface; once they have one, its isosurfaces, unless that was chosen.
for chosen in (False, True):
    empty = image_source("image.SetExtent(piece)\n")
    display = show_traced(empty, view)
    place_camera(view)
    outside = render(view)
    check(display.DSMShow == "Surface" and get_covered(outside).any(), "without an array, the outer surface is shown")
    if chosen:
        display.DSMShow = "Isosurfaces"
        display.DSMShow = "Surface"
    change(empty, "distance(piece)")
    picture = render(view)
    expected = "Surface" if chosen else "Isosurfaces"
    check(display.DSMShow == expected, f"with an array: {display.DSMShow}")
    picture = render(view)
    check((picture == outside).all() == chosen and get_covered(picture).any(), "which is what is seen")
    simple.Delete(empty)

# Memory that is too small, and then raised.
volume = simple.DSMSampleVolume(Dimensions=[96, 96, 96])
display = show_traced(volume, view)
place_camera(view)
display.DSMMemory = 1
with Messages():
    refused = render(view)
check(not get_covered(refused).any(), "too little memory")
check(abs(display.DSMIsoValue) > 1e-3, f"the isovalue is {display.DSMIsoValue}")
display.DSMMemory = 0
picture = render(view)
check(get_covered(picture).any(), "enough memory")
check(display.DSMIsoValue == display.GetPropertyValue("DSMSuggestedIsoValue"), "and the data's isovalue")
check_equal(render(view), picture, "which the picture has", 0)

# An array is chosen, and no longer automatic, when it is set to what it is: by its name, or with its association.
for chosen in ("RTData", ["POINTS", "RTData"]):
    display = show_traced(simple.Wavelet(), view)
    render(view)
    check(display.DSMIsoArrayAutomatic == 1 and list(display.DSMIsoArray) == ["POINTS", "RTData"],
          "an array is automatic")
    display.DSMIsoArray = chosen
    check(display.DSMIsoArrayAutomatic == 0, f"until it is set to {chosen}")
