# SPDX-License-Identifier: BSD-3-Clause
"""Run by ParaView's application, which has loaded the plugin: the box in the view is the one that a dataset is cropped
to, with and without reference bounds. A drag of it is one step to undo; the plugin itself is none."""

from gui_testing import Steps, check, list_undo_steps
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


def drag(view, place, distance):
    """The mouse drags what is at a place in the world to the right, for so many pixels."""
    renderer, interactor = view.GetRenderer(), view.GetInteractor()
    renderer.SetWorldPoint(*place, 1.0)
    renderer.WorldToDisplay()
    x, y, _ = renderer.GetDisplayPoint()
    for moved in range(0, distance + 1, 10):
        interactor.SetEventInformation(int(x) + moved, int(y), 0, 0, "\0", 0, None)
        interactor.InvokeEvent("MouseMoveEvent")
        if moved == 0:
            interactor.InvokeEvent("LeftButtonPressEvent")
        yield
    interactor.InvokeEvent("LeftButtonReleaseEvent")
    for _ in range(10):  # what is applied later
        yield


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
    simple.ResetCamera(view)
    simple.Render(view)
    before = list_undo_steps()
    yield from drag(view, (-10.0, 0.0, 0.0), 40)
    check(any(display.DSMCroppingPosition), f"the mouse moves the box: {display.DSMCroppingPosition}")
    after = list_undo_steps()  # the last ones
    check(after == ["Drag", *before][: len(after)], f"which is one step to undo: {after}")


check(list_undo_steps() == [], f"there is nothing to undo when the plugin was loaded: {list_undo_steps()}")
simple.GetLayout().SetSize(400, 300)
active = simple.GetActiveViewOrCreate("RenderView")
simple.Render(active)
steps = Steps(active, go(active), PATIENCE, "the box is not placed where the dataset is cropped")
