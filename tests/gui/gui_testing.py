# SPDX-License-Identifier: BSD-3-Clause
"""What the scripts that ParaView's application runs share (--script)."""

import os
import time
import traceback

from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkRenderingCore import vtkWindowToImageFilter


def say(text):
    os.write(1, (text + "\n").encode())  # the application keeps what is printed


def check(condition, what):
    if not condition:
        raise AssertionError(what)
    say("ok: " + what)


def list_undo_steps():
    """What the application can undo, the last first."""
    stack = servermanager.vtkSMProxyManager.GetProxyManager().GetUndoStackBuilder().GetUndoStack()
    return [stack.GetUndoSetLabel(number) for number in range(stack.GetNumberOfUndoSets())]


def finish(code):
    simple.Disconnect()
    os._exit(code)


def run(test):
    """The application ends with what came of `test`."""
    try:
        test()
    except BaseException:
        say(traceback.format_exc())
        finish(1)
    finish(0)


def grab(view):
    """What the view's window shows: a row a pixel, red first."""
    image = vtkWindowToImageFilter()
    image.SetInput(view.GetRenderWindow())
    image.ShouldRerenderOff()
    image.ReadFrontBufferOff()
    image.Update()
    return vtk_to_numpy(image.GetOutput().GetPointData().GetScalars())[:, :3].astype(int)


class Steps:
    """Goes on with a generator between the application's other events, which ends with it."""

    def __init__(self, view, steps, patience, late):
        """`patience`: seconds for all steps; `late`: what is wrong when they are not enough."""
        self.steps, self.late = steps, late
        self.deadline = time.monotonic() + patience
        interactor = view.GetInteractor()
        interactor.AddObserver("TimerEvent", self.look)
        interactor.CreateRepeatingTimer(50)

    def look(self, *_):
        if self.steps.gi_running:
            return  # an animation handles events, too
        try:
            if time.monotonic() > self.deadline:
                raise AssertionError(self.late)
            next(self.steps)
        except StopIteration:
            finish(0)
        except BaseException:
            say(traceback.format_exc())
            finish(1)
