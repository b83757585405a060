# SPDX-License-Identifier: BSD-3-Clause
"""Run by ParaView's application, which has loaded the plugin, alone or connected to a server: what a state file
or a Python state brings back is refined while the view is still, as what was shown before was.
DSM_TEST_STATE names the files."""

import os
import time
import traceback

from gui_testing import check, finish, say
from paraview import simple, smstate

SAMPLES = 64
STATE = os.environ["DSM_TEST_STATE"]
PATIENCE = 200.0  # seconds


def get_samples(display):
    samples = display.SMProxy.GetProperty("DSMSamples")
    samples.GetParent().UpdatePropertyInformation(samples)
    return samples.GetElement(0)


def show(view):
    display = simple.Show(simple.Wavelet(), view)
    display.Representation = "DSM Ray Traced"
    display.DSMIsoValue = 157.0
    display.DSMAmbientOcclusionSamples = 1
    display.DSMSamplesPerPixel = SAMPLES
    simple.ResetCamera(view)


def load(name):
    for source in simple.GetSources().values():
        simple.Delete(source)
    before = simple.GetRenderViews()
    if name.endswith(".py"):
        with open(name, encoding="utf-8") as text:
            exec(compile(text.read(), name, "exec"), {"__name__": "state"})
    else:
        simple.LoadState(name)
    (view,) = [view for view in simple.GetRenderViews() if view not in before]
    return view


def go(view):
    """The view of each step, and how it came about."""
    show(view)
    yield view, "a dataset"
    simple.SaveState(STATE + ".pvsm")
    with open(STATE + ".py", "w", encoding="utf-8") as text:
        text.write(smstate.get_state())  # SaveState writes XML, whatever the name
    for suffix in (".pvsm", ".py"):
        yield load(STATE + suffix), "a state (" + suffix + ")"


class Steps:
    """Goes on between the application's other events."""

    def __init__(self, view):
        self.deadline = time.monotonic() + PATIENCE
        self.steps = go(view)
        self.begin()
        interactor = view.GetInteractor()
        interactor.AddObserver("TimerEvent", self.look)
        interactor.CreateRepeatingTimer(50)

    def begin(self):
        view, self.what = next(self.steps)
        simple.Render(view)
        (source,) = simple.GetSources().values()
        self.display = simple.GetRepresentation(source, view)
        first = get_samples(self.display)
        # Those of a draft do not count.
        check(first < SAMPLES, f"{self.what} is shown with {first} samples at first")

    def look(self, *_):
        try:
            if time.monotonic() > self.deadline:
                raise AssertionError(self.what + " is not refined")
            if get_samples(self.display) < SAMPLES:
                return
            say(f"ok: {self.what} is refined")
            self.begin()
        except StopIteration:
            finish(0)
        except BaseException:
            say(traceback.format_exc())
            finish(1)


simple.GetLayout().SetSize(400, 300)
try:
    steps = Steps(simple.GetActiveViewOrCreate("RenderView"))
except BaseException:
    say(traceback.format_exc())
    os._exit(1)
