# SPDX-License-Identifier: BSD-3-Clause
"""Called as `pvbatch run.py TestX.py PLUGIN OUTPUT`. Runs a test in a namespace of its own: ParaView
executes programmable sources in that of the main script, where they replace names like `max`."""

import os
import runpy
import sys

folder = os.path.dirname(os.path.abspath(sys.argv[0]))
sys.path.insert(0, folder)
sys.argv = sys.argv[1:]
runpy.run_path(os.path.join(folder, sys.argv[0]))
