# SPDX-License-Identifier: BSD-3-Clause
"""What matters most stands directly below Representation in the application's panel, which shows properties in
their order, but those of a group after one another, where the group begins."""

from dsm_testing import *

load_plugin()


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
LIGHT = ["DSMShadows", "DSMAmbientOcclusionSamples", "DSMSamplesPerPixel"]
for source, own in (
    (simple.Wavelet(), ["DSMIsoArray", "DSMIsoValue", "DSMIsoValues", "DSMIsoComponent"]),
    (simple.Cone(), []),
):
    names = list_panel(simple.Show(source, view))
    first = names.index("Representation")
    expected = own + LIGHT
    check(names[first + 1 : first + 1 + len(expected)] == expected, f"{source.GetXMLName()}: {names[: first + 9]}")
