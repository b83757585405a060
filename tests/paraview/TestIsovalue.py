# SPDX-License-Identifier: BSD-3-Clause
"""Where nobody has chosen an isovalue, the data suggest one, the same on any number of ranks; what is chosen
counts."""

from dsm_testing import *

load_plugin()
view = create_view()
volume = simple.DSMSampleVolume(Dimensions=[64, 64, 64])
display = show_traced(volume, view)
place_camera(view)
suggested = render(view, "isovalue")
display.UpdatePropertyInformation()
value = display.GetPropertyValue("DSMSuggestedIsoValue")
check(0.4 < value < 0.95, f"{value} makes a sphere that the volume's border does not cut open")
check(len(display.DSMIsoValues) == 0, "the list stays empty")
display.DSMIsoValues = [value]
check_equal(render(view), suggested, "the picture is the one of that isovalue", 0)

display.DSMIsoValue = 0.2
check_equal(render(view), suggested, "a list counts instead of a single value", 0)
display.DSMIsoValues = []
single = render(view)
check(0 < get_covered(single).sum() < get_covered(suggested).sum(), "without a list, the single value counts")
display.DSMIsoValues = [0.2]
check_equal(render(view), single, "as a list of one would", 0)

# Which array is shown: the active scalars, or, without any, the first of one component, whatever names come before it.
FLOW = """
from vtkmodules.numpy_interface import algorithms
values = inputs[0].PointData.GetArray(0)
output.PointData.append(algorithms.make_vector(values, values, 2 * values), "a velocity")
output.PointData.append(values, "pressure")
"""


def display_component(display):
    return display.SMProxy.GetProperty("DSMIsoComponent").GetElement(0)


for script, wanted in ((FLOW, "pressure"), (FLOW + "output.PointData.SetActiveScalars('a velocity')", "a velocity")):
    flow = simple.ProgrammableFilter(Input=volume, Script=script)
    shown = simple.Show(flow, view)
    check(list(shown.DSMIsoArray) == ["POINTS", wanted], f"the array that is shown first: {shown.DSMIsoArray}")
    component = display_component(shown)
    check(component == (3 if wanted == "a velocity" else 0), f"a vector is shown by its magnitude: {component}")
    shown.DSMIsoArray = ["POINTS", "a velocity"]
    check(display_component(shown) == 3, "also one that is chosen later")
    shown.DSMIsoComponent = 1
    shown.DSMIsoArray = ["POINTS", "pressure"]
    check(display_component(shown) == 0, "an array of one component has no other")
    shown.DSMIsoArray = ["POINTS", "a velocity"]
    shown.DSMIsoComponent = 0
    render(view)
    check(display_component(shown) == 0, "a component that is set stays")
    simple.Delete(flow)

# An array that was chosen automatically is chosen anew when it is gone; it has an isovalue of its own.
simple.Hide(volume, view)
sample = simple.DSMSampleVolume(Dimensions=[64, 64, 64])
display = show_traced(sample, view)
place_camera(view)


def expect_automatic(what, array, least, most):
    """An automatic isovalue between these two, with a surface, and without a message."""
    with Messages() as messages:
        covered = get_covered(render(view)).mean()
    check(display.DSMIsoArray[1] == array and messages.text == "", f"{what}: {display.DSMIsoArray}{messages.text}")
    check(display.DSMIsoValueAutomatic == 1 and least < display.DSMIsoValue < most, f"it has {display.DSMIsoValue}")
    check(display.DSMIsoValue == display.GetPropertyValue("DSMSuggestedIsoValue"), "which its data suggest")
    check(covered > 0.02, f"there is a surface on {100 * covered:.0f} % of the view")
    return display.DSMIsoValue


sample.Kind = "Mixing Layer"
display.Representation = "Outline"
render(view)
told = display.DSMIsoArray, display.DSMIsoValue
check(told[0][1] == "entropy" and 100.0 < told[1] < 150.0,
      f"before it is traced, it has the array and a value of its data: {told}")
sample.Kind = "Noisy Sphere"
render(view)
display.Representation = REPRESENTATION
check(0.1 < display.DSMIsoValue < 3.0, f"before it is shown, its isovalue is in its range: {display.DSMIsoValue}")
expect_automatic("a sphere", "f", 0.4, 0.95)
sample.Kind = "Mixing Layer"
expect_automatic("another kind", "entropy", 20.0, 240.0)
display.DSMIsoValue = 200.0
render(view)
check(display.DSMIsoValueAutomatic == 0 and display.DSMIsoValue == 200.0, "a value that is set is not automatic")
display.DSMIsoValueAutomatic = 1
expect_automatic("automatic again", "entropy", 20.0, 240.0)
display.DSMIsoValue = 1.2
render(view)
sample.Kind = "Noisy Sphere"
expect_automatic("the array has gone, and its isovalue with it", "f", 0.4, 0.95)
display.DSMIsoArray = ["POINTS", "f"]
check(display.DSMIsoArrayAutomatic == 0, "an array that a script sets is not automatic")
sample.Kind = "Mixing Layer"
with Messages() as messages:
    render(view)
check("'f' does not exist" in messages.text and display.DSMIsoArray[1] == "f",
      "and stays, with an error: " + messages.text)
simple.Delete(sample)

# An automatic isovalue follows the data.
calculator = simple.Calculator(Input=simple.Wavelet(), ResultArrayName="r", Function="RTData*1.0")
display = show_traced(calculator, view)
place_camera(view)
first = expect_automatic("a calculator", "r", 100.0, 250.0)
calculator.Function = "RTData*0.001"
expect_automatic("smaller values", "r", 0.1, 0.25)
calculator.Function = "RTData*1000"
expect_automatic("greater values", "r", 1e5, 2.5e5)
calculator.Function = "RTData"
check(expect_automatic("the first ones", "r", 100.0, 250.0) == first, "have their first isovalue")
calculator.Function = "RTData*1.05"
check(expect_automatic("values that are much the same, as time steps are", "r", 100.0, 250.0) == first, "keep it")
display.DSMIsoValue = 0.0
check(display.DSMIsoValueAutomatic == 0, "0 is a value, too")
render(view)
told = display.GetPropertyValue("DSMValueRange")
check(told.startswith("39.2") and told.endswith(": isovalue outside"), f"the range is told: {told}")
calculator.Function = "RTData*0.001"
check(not get_covered(render(view)).any(), "a value that is set stays, whatever the data are")
simple.Delete(calculator)

flow = simple.Calculator(Input=simple.Wavelet(), ResultArrayName="r", Function="RTData")
display = show_traced(flow, view)
display.DSMIsoValue = 150.0
display.DSMIsoValueAutomatic = 1
check(display.DSMIsoValue == 150.0, "switched on, it has a number with the next picture")
expect_automatic("which it has", "r", 150.1, 250.0)
flow.Function = "RTData*iHat"
expect_automatic("an array that becomes a vector", "r", 150.1, 250.0)
check(display_component(display) == 3, "is shown by its magnitude")
flow.Function = "RTData"
expect_automatic("and one that becomes a scalar", "r", 150.1, 250.0)
display.DSMIsoValues = [200.0]
render(view)
display.DSMIsoValues = []
expect_automatic("after a list, too", "r", 150.1, 250.0)
told = display.GetPropertyValue("DSMValueRange")
check(told.startswith("37.3") and told.endswith(" to 276.829"), f"the range is told: {told}")
simple.Delete(flow)

# ParaView colors a new mesh by its scalars; so it does when they have another name. What somebody chooses stays.
mesh = simple.Calculator(Input=simple.Sphere(), ResultArrayName="r", Function="coordsX")
display = simple.Show(mesh, view)
display.Representation = REPRESENTATION
place_camera(view)
colored = render(view)
check(display.ColorArrayName[1] == "r", f"a mesh is colored by {display.ColorArrayName}")
mesh.ResultArrayName = "s"
with Messages() as messages:
    again = render(view)
check(display.ColorArrayName[1] == "s" and messages.text == "", f"then by {display.ColorArrayName}{messages.text}")
check_equal(again, colored, "in the same colors")
mesh.Function, mesh.AttributeType = "5", "Cell Data"
mesh.ResultArrayName = "t"
with Messages() as messages:
    render(view)
check(display.ColorArrayName[1] in (None, "") and messages.text == "",
      f"and by none: {display.ColorArrayName}{messages.text}")
simple.ColorBy(display, ("POINTS", "Normals"))
render(view)
mesh.Input = simple.Cone()
with Messages() as messages:
    render(view)
check("'Normals' does not exist" in messages.text, "what is chosen stays, with a warning: " + messages.text)

# Fills that nothing declares count neither for the first isovalue nor for the slider, but the array has them.
FILLED = """
image.SetExtent(piece)
values = distance(piece).astype(TYPE) if SCALE == 1 else (SCALE * distance(piece)).astype(TYPE)
x = points(piece)[0]
add(image, np.where(x > 30, TYPE(FILL), values))
"""
simple.Hide(mesh, view)
for kind, fill, scale in (("np.float32", 1e20, 1), ("np.float32", -3.4028235e38, 1),
                          ("np.float64", -1.7976931348623157e308, 1),
                          ("np.int16", -32768, 1000), ("np.int16", -3024, 1000)):
    script = FILLED.replace("TYPE", kind).replace("FILL", repr(fill)).replace("SCALE", str(scale))
    filled = image_source(script, in_parts=True, extent=(0, 48, 0, 48, 0, 48))
    display = show_traced(filled, view)
    place_camera(view)
    with Messages() as messages:
        covered = get_covered(render(view)).mean()
    check(0.1 * scale < display.DSMIsoValue < 2 * scale, f"{fill} in {kind}: {display.DSMIsoValue}{messages.text}")
    check(0.02 < covered < 0.9, f"a surface on {100 * covered:.0f} % of the view")
    domain = display.SMProxy.GetProperty("DSMIsoValue").FindDomain("vtkSMDoubleRangeDomain")
    check(-scale < domain.GetMinimum(0) < domain.GetMaximum(0) < 3 * scale,
          f"the slider is from {domain.GetMinimum(0)} to {domain.GetMaximum(0)}")
    shown = filled.PointData["f"].GetRange()
    check(any(abs(end - fill) <= 1e-6 * abs(fill) for end in shown), f"the range that is told stays {shown}")
    simple.Delete(filled)
