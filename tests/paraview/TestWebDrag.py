# SPDX-License-Identifier: BSD-3-Clause
"""A browser whose application says nothing of drags gets few samples all the same, also from a server. Called as
TestWebDrag.py PLUGIN OUTPUT [PORT]."""

from dsm_testing import *

try:
    from paraview.modules.vtkPVClientWeb import vtkPVWebApplication
    from vtkmodules.vtkWebCore import vtkWebInteractionEvent
except ImportError:
    print("skipped: this ParaView has no web modules")
    sys.exit(77)

if len(sys.argv) > 3:
    connect(sys.argv[3])
load_plugin()
view = create_view()
display = show(simple.Wavelet(), view, [150.0], "RTData", DSMSamplesPerPixel=16)
place_camera(view)
simple.Render(view)
application = vtkPVWebApplication()


def act(x, y, buttons):
    event = vtkWebInteractionEvent()
    event.SetX(x)
    event.SetY(y)
    event.SetButtons(buttons)
    application.HandleInteractionEvent(view.SMProxy, event)


def send():
    """A picture for the browser; returns the samples that it has and is to have."""
    application.InvalidateCache(view.SMProxy)
    application.StillRender(view.SMProxy, 80)
    display.SMProxy.UpdatePropertyInformation()
    return list(display.GetPropertyValue("DSMSamples"))


check(send() == [16, 16], "a still picture has all samples")
left = vtkWebInteractionEvent.LEFT_BUTTON
act(0.4, 0.5, left)
for step in range(1, 5):
    act(0.4 + 0.03 * step, 0.5, left)
    samples = send()
    check(samples[0] <= 2, f"one that is sent during a drag has {samples[0]} of {samples[1]}")
act(0.6, 0.5, 0)
check(send() == [16, 16], "the one after the drag has all samples")
