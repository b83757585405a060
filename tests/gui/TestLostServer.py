# SPDX-License-Identifier: BSD-3-Clause
"""Run by ParaView's application, which is connected to a server of two ranks: shows a dataset, and ends rank 1; the
application ends, too. With DSM_TEST_STATE, loads that state, and compares the view with the picture beside it."""

import glob
import os
import signal
import subprocess

from gui_testing import Steps, check, grab
from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader

STATE = os.environ.get("DSM_TEST_STATE")
PATIENCE = 60.0  # seconds


def rest(view, seconds=1.0):
    """Until the picture stays as it is."""
    last = None
    while last is None or last.shape != grab(view).shape or (grab(view) != last).any():
        last = grab(view)
        for _ in range(int(20 * seconds)):
            yield


def list_ranks():
    """The server's processes, in the order of their ranks."""
    listed = subprocess.run(["pgrep", "-x", "-f", f".*pvserver .*--server-port={os.environ['DSM_TEST_PORT']}"],
                            capture_output=True, text=True).stdout.split()
    ranks = {}
    for process in listed:
        with open(f"/proc/{process}/environ", "rb") as variables:
            for variable in variables.read().split(b"\0"):
                name, _, value = variable.partition(b"=")
                if name == b"OMPI_COMM_WORLD_RANK":
                    ranks[int(value)] = int(process)
    return [ranks[rank] for rank in sorted(ranks)]


def lose(view):
    display = simple.Show(simple.Wavelet(), view)
    display.Representation = "DSM Ray Traced"
    display.DSMIsoValues = [150.0]
    display.DSMSamplesPerPixel = 2
    simple.ResetCamera(view)
    view.SMProxy.GetActiveCamera().Azimuth(30.0)
    simple.Render(view)
    yield from rest(view)
    os.kill(list_ranks()[1], signal.SIGKILL)
    while True:
        yield  # the application is ended


def load(view):
    simple.LoadState(STATE)
    view = simple.GetActiveView()
    simple.Render(view)
    yield from rest(view)
    reader = vtkPNGReader()
    reader.SetFileName(glob.glob(os.path.splitext(STATE)[0] + "-*.png")[0])
    reader.Update()
    colors = reader.GetOutput().GetPointData().GetScalars()
    expected = vtk_to_numpy(colors)[:, :3].astype(int)
    shown = grab(view)
    check(shown.shape == expected.shape, f"the view has as many pixels as before: {shown.shape}, {expected.shape}")
    # ParaView's axes and their labels are drawn anew.
    same = (abs(shown - expected) <= 2).all(axis=1).mean()
    check(same > 0.999, f"the view looks as before: {same:.5f} of the pixels")


active = simple.GetActiveViewOrCreate("RenderView")
steps = Steps(active, load(active) if STATE else lose(active), PATIENCE, "the application does not come to an end")
