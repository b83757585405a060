# SPDX-License-Identifier: BSD-3-Clause
"""A view has one light, and a session one memory: what is set for one display is set for all, the last word
counts, and every display tells what holds."""

import re
import runpy

from paraview import smstate

from dsm_testing import *

load_plugin()
LIGHT = {
    "DSMShadows": 1, "DSMLightRadius": 0.02, "DSMAmbientOcclusionSamples": 2, "DSMAmbientOcclusionDistance": 0.75,
    "DSMEnvironmentLight": 0.5, "DSMMaxBounces": 3, "DSMSamplesPerPixel": 2, "DSMDebugView": "Normal",
    "DSMShowLegend": 0, "DSMShowStatistics": 0,
}
view = create_view()
view.UseFXAA = 0
cone = simple.Cone(Resolution=40, Height=4.0)
volume = simple.DSMSampleVolume(Dimensions=[24, 24, 24])


def read(display, names=LIGHT):
    return {name: display.GetPropertyValue(name) for name in names}


# Shadows that one switched on are switched off at another.
first = show_traced(cone, view)
second = show(volume, view, [0.7], "f")
plain = place_camera(view) or render(view)
first.DSMShadows = 1
check(second.DSMShadows == 1, "what is set for one is set for all")
shaded = render(view)
check((shaded != plain).any(), "there are shadows")
second.DSMShadows = 0
check(first.DSMShadows == 0, "the last word counts")
check_equal(render(view), plain, "and the shadows are gone", 0)

# A first look, which ends when light is set.
first.DSMLook = "With depth"
check(second.DSMLook == "With depth", "a view has one look")
deep = render(view, "depth")
check((deep.sum(axis=2) < plain.sum(axis=2) - 20).any() and (deep <= plain + 1).all(),
      "some of it is in a faint shadow")
first.DSMShadows = 1
check_equal(render(view), shaded, "shadows take the place of the first look", 0)
check((shaded.sum(axis=2) < deep.sum(axis=2) - 20).any(), "and are darker")
first.DSMShadows = 0
first.DSMLook = "Plain"
check_equal(render(view), plain, "the plain look is back", 0)

# Each of the options but the reflectivity, whoever is asked.
first.DSMReflectivity = 0.5
for name, value in LIGHT.items():
    setattr(second, name, value)
check(read(first) == LIGHT and read(second) == LIGHT, "all of the light is shared")
check(second.DSMReflectivity == 0.0, "what part of it a surface mirrors is its own")
simple.Hide(volume, view)
second.DSMMaxBounces = 4
check(first.DSMMaxBounces == 4, "a hidden display may be asked, too")
second.DSMMaxBounces = 3

# Who comes later, in whichever way it is shown; who is in another view has no say.
sphere = simple.Sphere()
third = simple.Show(sphere, view)
third.Representation = "Surface"
check(read(third) == LIGHT and first.DSMShadows == 1, "a Surface tells the light, and leaves it alone")
third.DSMShadows = 0
third.Representation = REPRESENTATION
check(first.DSMShadows == third.DSMShadows == 0, "what is set before the display is traced counts")
third.DSMShadows = 1
for way in ("DSM Slices", "DSM Volume"):
    cube = simple.Wavelet(WholeExtent=[-2, 2] * 3)
    late = simple.Show(cube, view)
    late.SetRepresentationType(way)
    check(read(late) == LIGHT, f"{way} that comes first tells the light, which is in effect")
    late.DSMShadows = 0
    check(first.DSMShadows == 0, "and switches it off")
    late.DSMShadows = 1
    simple.Delete(cube)
other = create_view()
elsewhere = show_traced(sphere, other)
check(elsewhere.DSMShadows == 0, "another view has a light of its own")
elsewhere.DSMShadows = 1
elsewhere.DSMShadows = 0
check(first.DSMShadows == 1, "that leaves the first alone")
fourth = simple.Show(simple.Cylinder(), other)
fourth.DSMLightRadius = 0.25
fourth.Representation = REPRESENTATION
check(elsewhere.DSMLightRadius == 0.25, "what a script sets before it chooses how to show is a word, too")
for source in (cone, volume, sphere):
    simple.Hide(source, view)
    simple.Delete(source)
again = show_traced(simple.Cone(), view)
check(read(again) == LIGHT, "a view keeps its light when all datasets are gone")

# A state brings its light, whatever the defaults, also where two displays differ, as they could before.
simple.ResetSession()
load_plugin()
view = create_view()
display = show_traced(simple.Cone(), view, DSMShadows=1, DSMSamplesPerPixel=4)
path = os.path.join(OUTPUT, f"options.{get_ranks()}")
simple.SaveState(path + ".pvsm")
with open(path + ".py", "w", encoding="utf-8") as text:
    text.write(smstate.get_state())
expected = read(display)
for suffix in (".pvsm", ".py") if can_load_states() else (".py",):
    simple.ResetSession()
    load_plugin()
    if suffix == ".py":
        runpy.run_path(path + suffix)
    else:
        simple.LoadState(path + suffix)
    (source,) = simple.GetSources().values()
    check(read(simple.GetRepresentation(source, simple.GetActiveView())) == expected, suffix + " brings it back")

# The settings page has the look that new displays begin with; what is set for a view is the view's.
simple.ResetSession()
load_plugin()
controller = servermanager.vtkSMParaViewPipelineController()
controller.UpdateSettingsProxies(servermanager.ActiveConnection.Session)
settings = servermanager.ProxyManager().SMProxyManager.GetProxy("settings", "DSMRayTracerSettings")
servermanager.vtkSMPropertyHelper(settings, "DSMLook").Set(1)
settings.UpdateVTKObjects()
view = create_view()
first = show_traced(simple.Cone(), view)
check(first.DSMLook == "With depth", "the page's look")
check(re.search("DSMLook ?= ?'With depth'", smstate.get_state()), "which a Python state has, too")
first.DSMLook = "Plain"
second = show_traced(simple.Sphere(), view)
check((first.DSMLook, second.DSMLook) == ("Plain", "Plain"), "who comes later takes the view's")
check(show_traced(simple.Sphere(), create_view()).DSMLook == "With depth", "another view begins with the page's")
servermanager.vtkSMPropertyHelper(settings, "DSMLook").Set(0)
settings.UpdateVTKObjects()

# The memory of a session, in all its views; a cache can be lowered.
MEMORY = {
    "DSMMemoryOrganization": "Object based", "DSMHostSharing": 0, "DSMMemory": 123, "DSMCacheSize": 33,
    "DSMThreads": 2, "DSMScheduler": "Central queue", "DSMSilenceLimit": 90, "DSMScratchDirectory": "/nowhere",
    "DSMCoarserDataWhileMoving": 1, "DSMLevelOfDetail": "Finest", "DSMPixelsPerSample": 2.0,
}
simple.ResetSession()
load_plugin()
view = create_view()
other = create_view()
first = show_traced(simple.Cone(), view)
second = show(simple.DSMSampleVolume(Dimensions=[24, 24, 24]), other, [0.7], "f")
for name, value in MEMORY.items():
    setattr(first, name, value)
check(read(second, MEMORY) == MEMORY, "a session has one memory")
second.DSMCacheSize = 9
check(first.DSMCacheSize == 9, "which can be made smaller")
