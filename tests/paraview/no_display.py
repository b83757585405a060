# SPDX-License-Identifier: BSD-3-Clause
"""Without a display ParaView stops at the first picture; by then the user must have been told why, and
what to do, and no rank may be left behind. Who does not use the plugin hears nothing of it. Since 6.0,
ParaView finds another way to draw, if there is one, and here it is only to look for one that is seldom there.

usage: no_display.py PLUGIN COMMAND ... (that starts pvbatch, the script is added)
"""

import os
import subprocess
import sys
import tempfile

SCRIPT = """
from paraview import simple
simple.LoadPlugin({plugin!r}, remote=False, ns=vars(simple))
display = simple.Show(simple.DSMSampleVolume(Dimensions=[16, 16, 16]), simple.CreateRenderView())
"""
TRACED = """
display.Representation = "DSM Ray Traced"
simple.Render()
print("drawn", flush=True)
"""


def run(script):
    """What is printed."""
    environment = {name: value for name, value in os.environ.items() if name != "DISPLAY"}
    environment["VTK_DEFAULT_OPENGL_WINDOW"] = "vtkOSOpenGLRenderWindow"
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "script.py")
        with open(path, "w", encoding="utf-8") as file:
            file.write(script.format(plugin=sys.argv[1]))
        # A rank that waits for ever is a timeout.
        return subprocess.run(sys.argv[2:] + [path], env=environment, timeout=60, check=False,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True).stdout


unused, used = run(SCRIPT), run(SCRIPT + TRACED)
silent = "No display is available" not in unused
told = "No display is available" in used and "xvfb-run" in used
drawn = "drawn" in used
print("told" if told else "drawn" if drawn else used)
print("silent" if silent else unused)
sys.exit(0 if told != drawn and silent else 1)
