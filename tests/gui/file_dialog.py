# SPDX-License-Identifier: BSD-3-Clause
"""What ParaView's test player calls the dialog in which the Plugin Manager asks for a file."""

import re
import subprocess


def get_version(paraview):
    said = subprocess.run([paraview, "--version"], stdout=subprocess.PIPE, text=True, check=True, timeout=60).stdout
    return tuple(map(int, re.search(r"(\d+)\.(\d+)", said).groups()))


def get_name(paraview):
    return "1pqFileDialog0" if (5, 12) <= get_version(paraview) < (6, 0) else "pqFileDialog"
