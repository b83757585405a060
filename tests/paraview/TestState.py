# SPDX-License-Identifier: BSD-3-Clause
"""A state file brings back the representation with all of its settings, and the same picture."""

from xml.etree import ElementTree

from dsm_testing import *

load_plugin()
SETTINGS = {
    "Representation": REPRESENTATION, "DSMIsoValue": 0.7, "DSMIsoValueAutomatic": 0,
    "DSMIsoArrayAutomatic": 0, "DSMIsoValues": [0.5, 0.8], "DSMIsoComponent": 0,
    "DSMThreads": 1, "DSMCacheSize": 33, "DSMMemoryOrganization": "Object based",
    "DSMHostSharing": 0, "DSMCoarserDataWhileMoving": 1, "DSMLevelOfDetail": "Finest", "DSMPixelsPerSample": 2.0,
    "DSMScheduler": "Central queue", "DSMSilenceLimit": 90,
    "DSMMemory": 123, "DSMScratchDirectory": "/nowhere/at/all",
    "DSMShadows": 1, "DSMLightRadius": 0.02,
    "DSMAmbientOcclusionSamples": 2, "DSMAmbientOcclusionDistance": 0.75, "DSMReflectivity": 0.25,
    "DSMEnvironmentLight": 0.5,
    "DSMMaxBounces": 3, "DSMSamplesPerPixel": 2, "Opacity": 0.5,
    "DSMClip": 1, "DSMClipOrigin": [0.25, 0.0, 0.0], "DSMClipNormal": [-1.0, 0.5, 0.0],
    "DSMCropping": 1, "DSMCroppingBox": [-2.0, 2.0, -1.0, 0.5, -2.0, 2.0],
    "DSMCroppingPosition": [0.1, 0.0, 0.0], "DSMCroppingRotation": [0.0, 0.0, 5.0], "DSMCroppingScale": [1.0, 0.9, 1.0],
    "DSMShowLegend": 0, "DSMShowStatistics": 0,
}


def find(kind):
    """The display of the source of a kind, in the only view."""
    sources = [source for source in simple.GetSources().values() if source.GetXMLName() == kind]
    check(len(sources) == 1, "the state has one " + kind)
    return simple.GetRepresentation(sources[0], simple.GetActiveView())


def set_up():
    view = create_view()
    view.UseFXAA = 0
    volume = simple.DSMSampleVolume(Dimensions=[40, 40, 40])
    display = simple.Show(volume, view)
    display.DSMIsoArray = ["POINTS", "f"]
    mesh = simple.Cone(Resolution=40, Height=4.0)
    meshDisplay = simple.Show(mesh, view)
    meshDisplay.Representation = REPRESENTATION
    meshDisplay.DSMReflectivity = 0.5
    meshDisplay.DSMShowEdges = 1
    for name, value in SETTINGS.items():
        setattr(display, name, value)
    display.ColorArrayName = [None, ""]
    place_camera(view)
    return view


reference = render(set_up(), "state")
check(get_covered(reference).mean() > 0.05, "there is something to compare")
path = os.path.join(OUTPUT, f"state.{get_ranks()}.pvsm")
simple.SaveState(path)
if can_load_states():
    simple.ResetSession()
    load_plugin()
    simple.LoadState(path)
    display = find("DSMSampleVolume")
    for name, value in SETTINGS.items():
        restored = display.GetPropertyValue(name)
        check(restored == value or list(restored) == list(value), f"{name} is {restored}")
    check(find("ConeSource").GetPropertyValue("DSMReflectivity") == 0.5, "the mesh has its own")
    check(find("ConeSource").GetPropertyValue("DSMShowEdges") == 1, "and its edges")
    view = simple.GetActiveView()
    check(find("ConeSource").GetPropertyValue("DSMClip") == 0, "and is not clipped")
    view.UseFXAA = 0  # a setting, which ParaView's states leave alone
    check_equal(render(view), reference, "the picture is the same", 0)

    # What is shown is in the state. One that was made before there was a choice shows what it did then: isosurfaces of
    # images, and the outer surface of AMR data and trees.
    simple.ResetSession()
    load_plugin()
    view = create_view()
    kinds = {
        "RTAnalyticSource": (simple.Wavelet(WholeExtent=[-4, 4] * 3), "Isosurfaces", "Surface"),
        "CellDataToPointData": (simple.CellDatatoPointData(Input=simple.AMRGaussianPulseSource()), "Surface",
                                "Isosurfaces"),
        "RandomHyperTreeGridSource": (simple.HyperTreeGridRandom(), "Surface", "Isosurfaces"),
    }
    for source, _, saved in kinds.values():
        display = simple.Show(source, view)
        display.Representation = REPRESENTATION
        display.DSMShow = saved
    simple.SaveState(path)
    tree = ElementTree.parse(path)
    for name in ("new", "old"):
        if name == "old":
            for proxy in tree.getroot().iter("Proxy"):
                for entry in proxy.findall("Property"):
                    if entry.get("name") == "DSMShow":
                        proxy.remove(entry)
            tree.write(path)
        simple.ResetSession()
        load_plugin()
        simple.LoadState(path)
        for kind, (_, old, saved) in kinds.items():
            shown = find(kind).DSMShow
            check(shown == (old if name == "old" else saved), f"{kind} in the {name} state: {shown}")
        if name == "old":
            with Messages() as messages:
                simple.Render(simple.GetActiveView())
            check(not messages.text, f"nothing is amiss: {messages.text}")

# The settings page and the displays have the same memory and threads: the last word counts.
simple.ResetSession()
load_plugin()
# As the application does when it loads a plugin.
controller = servermanager.vtkSMParaViewPipelineController()
controller.UpdateSettingsProxies(servermanager.ActiveConnection.Session)
settings = servermanager.ProxyManager().SMProxyManager.GetProxy("settings", "DSMRayTracerSettings")
check(settings is not None, "there is a settings page")


def set_defaults(threads, cache):
    servermanager.vtkSMPropertyHelper(settings, "DSMThreads").Set(threads)
    servermanager.vtkSMPropertyHelper(settings, "DSMCacheSize").Set(cache)
    settings.UpdateVTKObjects()


set_defaults(3, 77)
view = create_view()
first = simple.Show(simple.DSMSampleVolume(Dimensions=[20, 20, 20]), view)
check(first.DSMThreads == 3 and first.DSMCacheSize == 77, "a new display begins with the settings")
first.Representation = REPRESENTATION
first.DSMThreads = 1
check(settings.GetProperty("DSMThreads").GetElement(0) == 1, "the page shows what is set for a display")
second = simple.Show(simple.Sphere(), view)
second.Representation = REPRESENTATION
check(second.DSMThreads == 1, "as does the next display")
set_defaults(4, 78)
for display in (first, second):
    check(display.DSMThreads == 4 and display.DSMCacheSize == 78, "what is set on the page is every display's")
set_defaults(0, 256)
