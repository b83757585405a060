# SPDX-License-Identifier: BSD-3-Clause
"""What ParaView's test player calls the dialog in which the Plugin Manager asks for a file."""

import re
import subprocess


def get_name(paraview):
    said = subprocess.run([paraview, "--version"], stdout=subprocess.PIPE, text=True, check=True, timeout=60).stdout
    version = tuple(map(int, re.search(r"(\d+)\.(\d+)", said).groups()))
    return "1pqFileDialog0" if (5, 12) <= version < (6, 0) else "pqFileDialog"
