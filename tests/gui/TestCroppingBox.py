# SPDX-License-Identifier: BSD-3-Clause
"""Run by ParaView's application, which has loaded the plugin: the box in the view is the one that a dataset is cropped
to, with and without reference bounds."""

from gui_testing import Steps, check
from paraview import simple

PATIENCE = 60.0  # seconds


def find_boxes(view):
    """The widgets in the view that have reference bounds; that of *Transforming* has none."""
    hidden = view.SMProxy.GetProperty("HiddenRepresentations")
    proxies = [hidden.GetProxy(number) for number in range(hidden.GetNumberOfProxies())]
    return [proxy for proxy in proxies
            if proxy.GetXMLName() == "BoxWidgetRepresentation" and get(proxy, "UseReferenceBounds") == [1]]


def get(proxy, name):
    values = proxy.GetProperty(name)
    return [values.GetElement(number) for number in range(values.GetNumberOfElements())]


def go(view):
    source = simple.Wavelet()
    display = simple.Show(source, view)
    display.Representation = "DSM Ray Traced"
    display.DSMCropping = 1
    simple.SetActiveSource(source)
    simple.Render(view)
    while not find_boxes(view):
        yield
    (box,) = find_boxes(view)
    check(get(box, "ReferenceBounds") == [-10, 10] * 3, f"the data's: {get(box, 'ReferenceBounds')}")
    while get(box, "PlaceWidget") != [-10, 10] * 3:
        yield
    display.DSMCroppingUsesBox = 0
    while get(box, "PlaceWidget") != [0, 1] * 3:
        yield
    check(get(box, "UseReferenceBounds") == [0], "without them it is placed at a box from 0 to 1")
    display.DSMCroppingUsesBox = 1
    while get(box, "PlaceWidget") != [-10, 10] * 3:
        yield
    check(get(box, "UseReferenceBounds") == [1], "and with them at the data again")


simple.GetLayout().SetSize(400, 300)
active = simple.GetActiveViewOrCreate("RenderView")
simple.Render(active)
steps = Steps(active, go(active), PATIENCE, "the box is not placed where the dataset is cropped")
