# SPDX-License-Identifier: BSD-3-Clause
"""Run by ParaView's application, which has loaded the plugin, alone or connected to a server: a dataset that is shown
for the first time shows depth, as the settings page says; while the camera moves the picture is the plain one. State
files bring the look that they were saved with. DSM_TEST_STATE names the files."""

import os
import runpy

import numpy
from gui_testing import check, grab, run
from paraview import simple, smstate

STATE = os.environ["DSM_TEST_STATE"]


def render(view):
    view.SMProxy.StillRender()
    return grab(view)


def render_in_passing(view):
    view.SMProxy.InteractiveRender()
    return grab(view)


def save(name):
    """As a state and as a Python state."""
    simple.SaveState(STATE + name + ".pvsm")
    with open(STATE + name + ".py", "w", encoding="utf-8") as text:
        text.write(smstate.get_state())


def load(name):
    for source in simple.GetSources().values():
        simple.Delete(source)
    before = simple.GetRenderViews()
    if name.endswith(".py"):
        runpy.run_path(name)
    else:
        simple.LoadState(name)
    (view,) = [view for view in simple.GetRenderViews() if view not in before]
    (source,) = simple.GetSources().values()
    return view, simple.GetRepresentation(source, view)


def look_at_all():
    view = simple.GetActiveViewOrCreate("RenderView")
    view.OrientationAxesVisibility = 0
    view.UseFXAA = 0
    display = simple.Show(simple.Wavelet(), view)
    display.Representation = "DSM Ray Traced"
    display.ColorArrayName = [None, ""]
    display.DSMIsoValue = 157.0
    view.ViewSize = [300, 240]
    view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = [40, 35, 60], [0, 0, 0], [0, 1, 0]
    simple.ResetCamera(view)
    check(display.DSMLook == "With depth", "what is shown first shows depth")
    deep = render(view)
    save("")

    display.DSMLook = "Plain"
    plain = render(view)
    darker = deep.sum(axis=1) < plain.sum(axis=1) - 60
    check(0.02 < darker.mean() < 0.3, f"faint shadows are on {100 * darker.mean():.1f} % of the view")
    check((deep <= plain + 1).all() and deep[darker].min() > 40,
          f"nothing is brighter, and nothing black: {deep[darker].min()}")
    save(".plain")
    moving = render_in_passing(view)
    display.DSMLook = "With depth"
    check(numpy.array_equal(render_in_passing(view), moving), "a picture in passing is the plain one")

    for name, expected in ((".pvsm", "With depth"), (".py", "With depth"), (".plain.pvsm", "Plain"),
                           (".plain.py", "Plain")):
        view, display = load(STATE + name)
        check(display.DSMLook == expected, f"{name}: {expected}")


run(look_at_all)
