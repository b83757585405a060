# SPDX-License-Identifier: BSD-3-Clause
"""What a browser sees that ParaViewWeb or trame serve: one sample of each pixel while it drags, and all when
it lets go; and a picture that an application refines step by step is what one step gives."""

from dsm_testing import *

try:
    from paraview.modules.vtkPVClientWeb import vtkPVWebApplication
    from vtkmodules.vtkWebCore import vtkWebInteractionEvent as Event
except ImportError:
    print("skipped: this ParaView has no web modules")
    sys.exit(77)

load_plugin()
view = create_view()
source = simple.Wavelet()
display = show(source, view, [130.0], DSMSamplesPerPixel=9, DSMAmbientOcclusionSamples=1)
place_camera(view)
application = vtkPVWebApplication()


def get_samples():
    display.SMProxy.UpdatePropertyInformation()
    return list(display.GetPropertyValue("DSMSamples"))


def serve():
    """What the page gets when it asks for a picture."""
    application.InvalidateCache(view.SMProxy)
    application.StillRenderToBuffer(view.SMProxy, 0, 50)
    return get_samples()


def drag(x, pressed):
    event = Event()
    event.SetButtons(Event.LEFT_BUTTON if pressed else 0)
    event.SetX(x)
    event.SetY(0.5)
    application.HandleInteractionEvent(view.SMProxy, event)
    return get_samples()


simple.Render(view)
first = serve()
check(first == [9, 9], f"a page that is opened gets all samples: {first}")
view.UseInteractiveRenderingForScreenshots = 1  # as ParaViewWeb does for a drag
drag(0.5, True)
for step in range(1, 4):
    check(drag(0.5 + 0.05 * step, True) == [1, 9], "a drag takes one sample")
    check(serve()[0] <= 2, "and the picture for the page at most one more")
view.UseInteractiveRenderingForScreenshots = 0
drag(0.65, False)
check(serve() == [9, 9], "when it ends, the page gets all")


def count_accesses(isovalue, *steps):
    """To bricks, of each step of a picture."""
    simple.Render(view)
    display.DSMIsoValues = [isovalue]
    accesses = []
    for samples in steps:
        display.DSMSamplesPerPixel = samples
        simple.Render(view)
        rows = get_rows(display)
        accesses.append(sum(row["Accesses"] for row in rows))
    return accesses


count_accesses(150.0, 16)
display.DSMIsoValues = [130.0]
(at_once,) = count_accesses(150.0, 16)  # some first hits are known, as below
expected = render(view)
display.DSMIsoValues = [130.0]
steps = count_accesses(150.0, 1, 4, 16)
check(get_samples() == [16, 16], "an application raises the samples step by step")
check(sum(steps) == at_once, f"no sample is traced twice: {steps} of {at_once}")
check_equal(render(view), expected, "and has the picture that one step gives", 0)
