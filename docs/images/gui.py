#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Makes gui_plugin.png and gui_isosurface.png, pictures of ParaView's application, and gui_isosurface.txt, the labels
of the properties that the panel has below Representation:

    python3 docs/images/gui.py build/lib/DSMRayTracer/DSMRayTracer.so

ParaView's test player goes through the steps on a screen of its own, whose pixels Xvfb writes into a file. It needs
Debian's packages xvfb, openbox, libqt5svg5 and python3-numpy, and python3 with VTK. The test
paraview.Scripts.1 (TestPanel.py) fails where the panel has other properties than gui_isosurface.txt."""

import os
import struct
import subprocess
import sys
import tempfile
import time

import numpy

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [os.path.join(HERE, "..", "..", "tests", "gui"), HERE]
import file_dialog
from pixels import write

PLUGIN = os.path.abspath(sys.argv[1])
SIZE = (1300, 1000)
LABELS = os.path.join(HERE, "gui_isosurface.txt")
STILL = 5.0  # seconds without any change: nothing more will come
PATIENCE = 180.0

# The window manager's: the main window takes the whole screen.
RULES = """<openbox_config xmlns="http://openbox.org/3.4/rc"><applications>
<application type="normal"><maximized>yes</maximized><decor>no</decor></application>
</applications></openbox_config>"""

WINDOW = "pqClientMainWindow"
MANAGER = WINDOW + "/PluginManagerDialog"
LOAD = [
    (WINDOW + "/menubar", "activate", "menuTools"),
    (WINDOW + "/menubar/menuTools", "activate", "actionManage_Plugins"),
    (MANAGER + "/splitter/localGroup/loadLocal", "activate", ""),
]
SHOW = [
    (MANAGER + "/buttonBox/1QPushButton0", "activate", ""),
    (WINDOW + "/menubar", "activate", "menuSources"),
    (WINDOW + "/menubar/menuSources/Alphabetical", "activate", "DSMSampleVolume"),
    (WINDOW + "/propertiesDock/propertiesPanel/Accept", "activate", ""),
    (WINDOW + "/representationToolbar/displayRepresentation/comboBox", "set_string", "DSM Ray Traced"),
]


def read_screen(path):
    """The pixels of a file in XWD's format, the lowest row first."""
    with open(path, "rb") as file:
        content = file.read()
    header = struct.unpack(">25I", content[:100])
    width, height, row, colors = header[4], header[5], header[12], header[19]
    begin = header[0] + 12 * colors
    rows = numpy.frombuffer(content, numpy.uint8, row * height, begin).reshape(height, row)
    return rows[::-1, : 4 * width].reshape(height, width, 4)[:, :, 2::-1]


def wait_for_stillness(path, process):
    last, since, start = None, time.monotonic(), time.monotonic()
    while time.monotonic() - start < PATIENCE:
        time.sleep(1.0)
        if process.poll() is not None:
            raise RuntimeError("ParaView ended before the picture was there")
        # The bars at the bottom tell of the memory that is in use.
        now = read_screen(path)[40:]
        if last is None or (now != last).any():
            last, since = now, time.monotonic()
        elif time.monotonic() - since > STILL and time.monotonic() - start > 4 * STILL:
            return
    raise RuntimeError("the window did not come to rest")


def take_picture(folder, name, steps):
    session = os.path.join(folder, "session.xml")
    with open(session, "w", encoding="utf-8") as text:
        events = [f'<pqevent object="{what}" command="{command}" arguments="{value}" />'
                  for what, command, value in steps]
        text.write("\n".join(['<?xml version="1.0" ?>', "<pqevents>", *events, "</pqevents>", ""]))
    paraview = subprocess.Popen(["paraview", "--dr", f"--test-script={session}"])
    try:
        wait_for_stillness(os.path.join(folder, "Xvfb_screen0"), paraview)
        write(os.path.join(HERE, name), read_screen(os.path.join(folder, "Xvfb_screen0")))
    finally:
        paraview.kill()
        paraview.wait()


def main():
    with tempfile.TemporaryDirectory() as folder:
        read, told = os.pipe()
        screen = subprocess.Popen(["Xvfb", "-displayfd", str(told), "-fbdir", folder, "-noreset", "-nocursor",
                                   "-screen", "0",
                                   f"{SIZE[0]}x{SIZE[1]}x24"], pass_fds=[told])
        with os.fdopen(read) as lines:
            os.environ.update(DISPLAY=":" + lines.readline().strip(), HOME=folder)
        rules = os.path.join(folder, "openbox.xml")
        with open(rules, "w", encoding="utf-8") as text:
            text.write(RULES)
        manager = subprocess.Popen(["openbox", "--config-file", rules])
        try:
            load = LOAD + [(MANAGER + "/" + file_dialog.get_name("paraview"), "filesSelected", PLUGIN)]
            take_picture(folder, "gui_plugin.png", load)
            take_picture(folder, "gui_isosurface.png", load + SHOW)
            subprocess.run(["pvpython", "--force-offscreen-rendering",
                            os.path.join(HERE, "../../tests/paraview/run.py"),
                            "TestPanel.py", PLUGIN, folder], env={**os.environ, "DSM_TEST_PANEL": LABELS}, check=True)
        finally:
            for process in (manager, screen):
                process.terminate()
                process.wait()


main()
