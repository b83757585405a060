# SPDX-License-Identifier: BSD-3-Clause
"""Run by ParaView's application, which has loaded the plugin: a script deletes all, and loads a state and then one
that is a Python script, without giving the application time between. The test fails when anything is said of OpenGL."""

import os
import sys
import tempfile
import traceback

from gui_testing import check
from paraview import simple, smstate


def get_looks():
    view = simple.GetActiveViewOrCreate("RenderView")
    simple.Render(view)
    return [(display.Representation, list(display.DSMIsoValues)) for display in view.Representations
            if display.GetProperty("DSMIsoValues")]


def test():
    view = simple.GetActiveViewOrCreate("RenderView")
    display = simple.Show(simple.Wavelet(), view)
    display.Representation = "DSM Ray Traced"
    display.DSMIsoValues = [150.0, 200.0]
    simple.Render(view)
    expected = get_looks()
    state = os.path.join(tempfile.mkdtemp(), "state.pvsm")
    simple.SaveState(state)
    script = smstate.get_state()
    simple.ResetSession()
    simple.LoadState(state)
    check(get_looks() == expected, f"a state brings back what was shown: {expected}")
    simple.ResetSession()
    simple.RemoveViewsAndLayouts()
    exec(compile(script, "state.py", "exec"), {"__name__": "state"})
    check(get_looks() == expected, "so does a state that is a script")


code = 1
try:
    test()
    code = 0
except BaseException:
    traceback.print_exc()
sys.stdout.flush()
os._exit(code)
