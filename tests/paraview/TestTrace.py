# SPDX-License-Identifier: BSD-3-Clause
"""ParaView's trace records our properties when they are changed, as the application's panels change them, and
running it brings them back."""

import re

from dsm_testing import *
from paraview import smstate, smtrace

load_plugin()
CHANGES = {
    "DSMIsoValue": 0.7, "DSMIsoValueAutomatic": 0, "DSMIsoValues": [0.5, 0.8], "DSMIsoComponent": 1, "DSMThreads": 1,
    "DSMCacheSize": 33,
    "DSMMemoryOrganization": "Object based", "DSMHostSharing": 0, "DSMScheduler": "Central queue",
    "DSMSilenceLimit": 90,
    "DSMMemory": 123, "DSMScratchDirectory": "/nowhere", "DSMShadows": 1, "DSMLightRadius": 0.02,
    "DSMAmbientOcclusionSamples": 2,
    "DSMAmbientOcclusionDistance": 0.75, "DSMReflectivity": 0.25, "DSMMaxBounces": 3,
    "DSMSamplesPerPixel": 2, "DSMDebugView": "Brick", "DSMShowLegend": 0, "DSMShowStatistics": 1,
    "DSMClip": 1, "DSMClipOrigin": [0.25, 0.0, 0.0], "DSMClipNormal": [-1.0, 0.5, 0.0],
    "DSMCropping": 1, "DSMCroppingBox": [-2.0, 2.0, -1.0, 0.5, -2.0, 2.0],
    "DSMCroppingPosition": [0.1, 0.0, 0.0], "DSMCroppingRotation": [0.0, 0.0, 5.0], "DSMCroppingScale": [1.0, 0.9, 1.0],
}
MESH_CHANGES = {"DSMLineRadius": 0.1, "DSMPointRadius": 0.2, "DSMReflectivity": 0.5}


def change(proxy, changes):
    """Changes properties the way that a panel does, which tells the trace."""
    item = smtrace._create_trace_item_internal("PropertiesModified", kwargs={"proxy": proxy.SMProxy})
    for name, value in changes.items():
        setattr(proxy, name, value)
    item.finalize()


def read(proxy, names):
    values = [proxy.GetPropertyValue(name) for name in names]
    return [list(value) if hasattr(value, "__len__") and not isinstance(value, str) else value for value in values]


# The application's first look, which scripts do not have.
controller = servermanager.vtkSMParaViewPipelineController()
controller.UpdateSettingsProxies(servermanager.ActiveConnection.Session)
page = servermanager.ProxyManager().SMProxyManager.GetProxy("settings", "DSMRayTracerSettings")


def set_first_look(number):
    servermanager.vtkSMPropertyHelper(page, "DSMLook").Set(number)
    page.UpdateVTKObjects()


def tell_properties(text):
    """The text with one property on each line: ParaView 6.0 and later set several in one call."""
    lines, target = [], None
    for line in text.splitlines():
        if begin := re.match(r"(\w+)\.Set\($", line):
            target = begin[1]
        elif target and line.startswith(")"):
            target = None
        else:
            lines.append(re.sub(r"^ {4}(\w+)=", rf"{target}.\1 = ", line) if target else line)
    return "\n".join(lines)


set_first_look(1)
smtrace.start_trace()
view = simple.GetActiveViewOrCreate("RenderView")
volume = simple.DSMSampleVolume(Dimensions=[24, 24, 24])
display = simple.Show(volume, view)
display.SetRepresentationType(REPRESENTATION)
change(display, CHANGES)
mesh = simple.Cone()
meshDisplay = simple.Show(mesh, view)
meshDisplay.SetRepresentationType(REPRESENTATION)
change(meshDisplay, MESH_CHANGES)
ball = simple.Sphere()
other = simple.CreateRenderView()
ballDisplay = simple.Show(ball, other)
ballDisplay.SetRepresentationType(REPRESENTATION)
pipe = simple.Cylinder()
simple.Show(pipe, other)
simple.Render(other)
text = smtrace.stop_trace()
told = tell_properties(text)
check("cylinder1Display.Representation = " in told and "cylinder1Display.DSM" not in told,
      "a Surface is traced without ours")
simple.Delete(pipe)
set_first_look(0)
check(ballDisplay.DSMLook == "With depth", "a display keeps the look with which it began")
for name in list(CHANGES) + list(MESH_CHANGES):
    check(f"Display.{name} = " in told, name + " is in the trace")
check(not any(word in text for word in ("DSMSamples ", "DSMStatistics", "DSMSuggested")), "what is only told is not")

expected = read(display, CHANGES), read(meshDisplay, MESH_CHANGES)
for proxy in (ball, other, mesh, volume, view):
    simple.Delete(proxy)
exec(text, {})
views = simple.GetViews()
found = {source.GetXMLName(): next(filter(None, (servermanager.GetRepresentation(source, view) for view in views)))
         for source in simple.GetSources().values()}
check(found["SphereSource"].DSMLook == "With depth", "run again, it gives the other view the same look")
check(read(found["DSMSampleVolume"], CHANGES) == expected[0], "run again, it gives the volume the same settings")
check(read(found["ConeSource"], MESH_CHANGES) == expected[1], "and the mesh")
for source in found:
    expected = "Surface" if source == "CylinderSource" else REPRESENTATION
    check(found[source].Representation == expected, f"{source} is shown as {expected}")

# Python states of what is shown in ParaView's own ways do without the plugin, whatever the kind of data.
OURS = re.compile(r"Display\.(DSM\w+)")
for source in simple.GetSources().values():
    simple.Delete(source)
states = simple.CreateRenderView()
for kind in ("Wavelet", "AMRGaussianPulseSource", "HyperTreeGridRandom", "Cone"):
    source = getattr(simple, kind)()
    display = simple.Show(source, states)
    display.Representation = "Outline"
    simple.Render(states)
    state = tell_properties(smstate.get_state())
    check(not OURS.findall(state), f"{kind}: a Python state without ours")
    # ParaView itself has no Volume of trees.
    check("ScalarOpacity" not in state or not kind.startswith("HyperTree"), "nor what trees have of Volume")
    display.SetRepresentationType(REPRESENTATION)
    simple.Render(states)
    check("DSMCroppingBox" in OURS.findall(tell_properties(smstate.get_state())), "ours are there when it is traced")
    display.SetRepresentationType("Outline")
    found = OURS.findall(tell_properties(smstate.get_state()))
    check(not found, f"and go when it is not: {found}")
    simple.Delete(source)
