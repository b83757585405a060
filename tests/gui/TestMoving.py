# SPDX-License-Identifier: BSD-3-Clause
"""Run by ParaView's application, which has loaded the plugin, alone or connected to a server: while the mouse turns a
volume in a file that does not fit the memory, a coarser level of it is shown, if that is wanted; when the mouse is
released the view shows the finest, as it did before. DSM_TEST_CONVERT is dsm_convert, DSM_TEST_FOLDER a folder."""

import json
import os
import subprocess

import numpy
from gui_testing import Steps, check, grab
from paraview import simple

FOLDER = os.environ["DSM_TEST_FOLDER"]
EDGE = 192
MEMORY = 4  # MiB of each rank, of 27 and more
PATIENCE = 100.0  # seconds


def write_file():
    os.makedirs(FOLDER, exist_ok=True)
    path = os.path.join(FOLDER, "waves")
    z, y, x = numpy.ogrid[0 : 1 : EDGE * 1j, 0 : 1 : EDGE * 1j, 0 : 1 : EDGE * 1j]
    values = numpy.sin(21 * x) * numpy.cos(19 * y) + numpy.sin(20 * z + 3 * x)
    values.astype(numpy.float32).tofile(path + ".raw")
    # Compressed: what is not comes too soon.
    subprocess.run([os.environ["DSM_TEST_CONVERT"], "--quiet", "--compression", "deflate", "--levels", "all",
                    "--raw-size", f"{EDGE},{EDGE},{EDGE}", "--raw-type", "float32", path + ".raw", path + ".vtkhdf"],
                   check=True, timeout=60)
    os.remove(path + ".raw")
    return path + ".vtkhdf"


class Session:
    def __init__(self, view):
        self.view = view

    def get_level(self):
        self.display.SMProxy.UpdatePropertyInformation()
        rows = json.loads(str(self.display.GetProperty("DSMStatistics")).strip("'"))
        return rows[0]["CoarserLevel"]

    def drag(self):
        """There and back; returns the levels that were seen on the way."""
        width, height = self.view.ViewSize
        interactor = self.view.GetInteractor()
        seen = []
        interactor.SetEventInformation(width // 2, height // 2)
        interactor.InvokeEvent("LeftButtonPressEvent")
        for step in (1, 2, 3, 4, 3, 2, 1, 0):
            interactor.SetEventInformation(width // 2 + 25 * step, height // 2)
            interactor.InvokeEvent("MouseMoveEvent")
            yield
            seen.append(self.get_level())
        interactor.InvokeEvent("LeftButtonReleaseEvent")
        return seen

    def rest(self):
        """Until the still picture is there."""
        last = None
        while last is None or self.get_level() != 0 or (grab(self.view) != last).any():
            last = grab(self.view)
            for _ in range(10):
                yield
        return last

    def go(self):
        path = write_file()
        source = simple.DSMVolumeReader(FileName=path)
        self.display = display = simple.Show(source, self.view)
        display.Representation = "DSM Ray Traced"
        display.ColorArrayName = [None, ""]
        display.DSMIsoValues = [0.8]
        display.DSMMemory = MEMORY
        display.DSMThreads = 1
        display.DSMLook = "Plain"
        simple.ResetCamera(self.view)
        simple.Render(self.view)
        yield from self.rest()
        levels = yield from self.drag()
        check(max(levels) == 0, f"while it is off, moving pictures are of the finest: {levels}")
        yield from self.rest()

        for turn in range(2):
            display.DSMCoarserDataWhileMoving = 1
            levels = yield from self.drag()
            check(max(levels) > 0, f"coarser levels stand in: {levels}")
            shown = yield from self.rest()
            display.DSMCoarserDataWhileMoving = 0
            simple.Render(self.view)
            expected = yield from self.rest()
            check((shown == expected).all(), "the mouse is released, and the view is of the finest")
        display.DSMCoarserDataWhileMoving = 1
        picture = os.path.join(FOLDER, "moving.png")
        simple.SaveScreenshot(picture, self.view)
        check(self.get_level() == 0, "a screenshot is of the finest")
        simple.Delete(source)
        os.remove(path)


simple.GetLayout().SetSize(400, 300)
active = simple.GetActiveViewOrCreate("RenderView")
steps = Steps(active, Session(active).go(), PATIENCE, "the view does not come to rest")
