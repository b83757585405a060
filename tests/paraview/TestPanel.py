# SPDX-License-Identifier: BSD-3-Clause
"""What matters most stands directly below Representation in the application's panel, which shows properties in
their order, but those of a group after one another, where the group begins. A picture of the panel in the documents has
the same properties; docs/images/gui.py sets DSM_TEST_PANEL to have their labels written."""

from dsm_testing import *

load_plugin()
PICTURED = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "docs", "images", "gui_isosurface.txt")


def list_panel(display):
    """The names of the properties as the panel lists them."""
    proxy = display.SMProxy
    groups = {}
    for number in range(proxy.GetNumberOfPropertyGroups()):
        group = proxy.GetPropertyGroup(number)
        for member in range(group.GetNumberOfProperties()):
            if group.GetProperty(member):
                groups[group.GetProperty(member)] = group.GetXMLLabel() or number
    listed = {}
    iterator = servermanager.vtkSMOrderedPropertyIterator()
    iterator.SetProxy(proxy)
    iterator.Begin()
    while not iterator.IsAtEnd():
        listed.setdefault(groups.get(iterator.GetProperty(), iterator.GetKey()), []).append(iterator.GetKey())
        iterator.Next()
    return [name for names in listed.values() for name in names]


view = create_view()
SLICES = [f"DSMSlice{axis}{part}" for axis in "XYZ" for part in ("", "Index", "Indices")] + ["DSMSlicePlane"]
LIGHT = ["DSMShadows", "DSMAmbientOcclusionSamples", "DSMSamplesPerPixel"]
ISOSURFACES = ["DSMShow", "DSMIsoArray", "DSMIsoArrayAutomatic", "DSMIsoComponent", "DSMIgnoreValues", "DSMValidRange",
               "DSMMaskArray", "DSMMaskRange", "DSMMaskValues", "DSMIsoValue", "DSMIsoValueAutomatic",
               "DSMValueRange", "DSMIsoValues"]
# Of surfaces, the panel shows DSMShow, and what depends on it, only where there are blocks that have isosurfaces.
# Slices of grids of cells are by a plane.
for source, own, is_pictured in ((simple.Wavelet(), ISOSURFACES + SLICES, True),
                                 (simple.Cone(), ISOSURFACES + ["DSMSlicePlane"], False)):
    names = list_panel(simple.Show(source, view))
    first = names.index("Representation")
    expected = own + LIGHT
    check(names[first + 1 : first + 1 + len(expected)] == expected, f"{source.GetXMLName()}: {names[: first + 9]}")
    switches = [("DSMClip", "DSMClipOrigin"), ("DSMCropping", "DSMCroppingPosition")]
    for switch, control in switches + [("DSMCap", "DSMCapSide")]:
        below = names[names.index(switch) + 1]
        check(below == control, f"what {switch} switches on stands directly below: {below}")
    proxy = simple.GetRepresentation(source, view).SMProxy
    if is_pictured:
        # What says where slices are is there for slices only.
        visible = [name for name in names[first:]
                   if proxy.GetProperty(name).GetPanelVisibility() == "default" and name not in SLICES]
        labels = [proxy.GetProperty(name).GetXMLLabel() for name in visible[: visible.index(LIGHT[-1]) + 1]]
        if "DSM_TEST_PANEL" in os.environ:
            with open(os.environ["DSM_TEST_PANEL"], "w", encoding="utf-8") as text:
                text.writelines(label + "\n" for label in labels)
        else:
            with open(PICTURED, encoding="utf-8") as text:
                pictured = text.read().splitlines()
            check(labels == pictured, f"the documents' picture shows these properties, {labels}; if not, run "
                                      f"docs/images/gui.py")
    widgets = {}
    for number in range(proxy.GetNumberOfPropertyGroups()):
        group = proxy.GetPropertyGroup(number)
        if group.GetPanelWidget():
            widgets[group.GetPanelWidget()] = group
    for widget, functions in (
        ("InteractivePlane", ("Origin", "Normal")),
        ("InteractiveBox", ("Position", "Rotation", "Scale", "ReferenceBounds", "UseReferenceBounds")),
    ):
        check(widget in widgets, f"{source.GetXMLName()}: there is a widget in the view, {widget}")
        for function in functions + ("Input",):
            check(widgets[widget].GetProperty(function) is not None, f"which knows its {function}")
    shown = [name for name in names if proxy.GetProperty(name).GetPanelVisibility() != "never"]
    hidden = [name for name in shown if "DSM" in name and "DSM" in (proxy.GetProperty(name).GetXMLLabel() or "")]
    check(hidden == [], f"nobody has to know what DSM means: {hidden}")
    labels = [proxy.GetPropertyGroup(number).GetXMLLabel() or "" for number in range(proxy.GetNumberOfPropertyGroups())]
    check(not any("DSM" in label for label in labels), f"groups have names in ParaView's words: {labels}")
    for name in ("DSMMemory", "DSMThreads", "DSMScheduler", "DSMCacheSize"):
        check(proxy.GetProperty(name).GetPanelVisibility() == "never", name + " is on the settings page only")

# What has no effect is hidden or disabled: the panel asks the decorators in a property's hints.


def ask(element, proxy, mode):
    """Whether the panel shows or enables what has these hints, expression or decorator."""
    nested = [element.GetNestedElement(number) for number in range(element.GetNumberOfNestedElements())]
    if element.GetName() == "PropertyWidgetDecorator" and element.GetAttribute("type") == "GenericDecorator":
        asked = proxy.GetProperty(element.GetAttribute("property"))
        if element.GetAttribute("mode") != mode or not asked:
            return True
        value = asked.GetElement(0)
        text = f"{value:g}" if isinstance(value, float) else str(value)
        return (text == element.GetAttribute("value")) != (element.GetAttribute("inverse") == "1")
    answers = [ask(one, proxy, mode) for one in nested if one.GetName() in ("PropertyWidgetDecorator", "Expression")]
    return any(answers) if element.GetAttribute("type") == "or" else all(answers)


def is_active(display, name):
    hints = display.SMProxy.GetProperty(name).GetHints()
    return not hints or (ask(hints, display.SMProxy, "visibility") and ask(hints, display.SMProxy, "enabled_state"))


SURFACES = ["Opacity", "PointSize", "LineWidth", "EdgeColor", "BackfaceRepresentation", "DSMReflectivity",
            "DSMMaxBounces"]
LIT = ["DSMShadows", "DSMAmbientOcclusionSamples", "DSMEnvironmentLight"]
for source in (simple.Wavelet(), simple.AMRGaussianPulseSource(), simple.HyperTreeGridRandom()):
    display = simple.Show(source, view)
    for way in (REPRESENTATION, "DSM Slices", "DSM Volume"):
        display.SetRepresentationType(way)
        active = [name for name in SURFACES + LIT if is_active(display, name)]
        expected = [] if way == "DSM Volume" else SURFACES + LIT
        check(active == expected, f"{source.GetXMLName()} as {way} has {active}")
    check(not is_active(display, "VolumeAnisotropy"), "nothing is scattered in a direction")
    check(not is_active(display, "DSMScattering"), "a volume that shines by itself scatters no light")
    display.Shade = 1
    lit = [name for name in LIT + ["VolumeAnisotropy"] if not is_active(display, name)]
    check(not lit, f"a shaded volume is lit, but not by {lit}")
    for light in ("DSMShadows", "DSMAmbientOcclusionSamples"):
        check(not is_active(display, "DSMScattering"), f"nothing is scattered before {light}")
        setattr(display, light, 1)
        check(is_active(display, "DSMScattering"), f"light is scattered with {light}")
        setattr(display, light, 0)
    simple.Delete(source)
