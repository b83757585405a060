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
for script, wanted in ((FLOW, "pressure"), (FLOW + "output.PointData.SetActiveScalars('a velocity')", "a velocity")):
    flow = simple.ProgrammableFilter(Input=volume, Script=script)
    shown = simple.Show(flow, view)
    check(list(shown.DSMIsoArray) == ["POINTS", wanted], f"the array that is shown first: {shown.DSMIsoArray}")
    simple.Delete(flow)
