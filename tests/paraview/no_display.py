# SPDX-License-Identifier: BSD-3-Clause
"""Without a display ParaView stops at the first picture; by then the user must have been told why, and
what to do, and no rank may be left behind.

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
display.Representation = "DSM Ray Traced"
simple.Render()
"""

environment = {name: value for name, value in os.environ.items() if name != "DISPLAY"}
with tempfile.TemporaryDirectory() as folder:
    path = os.path.join(folder, "script.py")
    with open(path, "w", encoding="utf-8") as script:
        script.write(SCRIPT.format(plugin=sys.argv[1]))
    # A rank that waits for ever is a timeout.
    run = subprocess.run(sys.argv[2:] + [path], env=environment, timeout=60, check=False,
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
told = "There is no display to draw on" in run.stdout and "xvfb-run" in run.stdout
print("told" if told else run.stdout)
sys.exit(0 if told else 1)
