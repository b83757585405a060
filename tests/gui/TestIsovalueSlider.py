# SPDX-License-Identifier: BSD-3-Clause
"""Run by ParaView's application, which has loaded the plugin, alone or connected to a server: the first isovalue
is the one that the data suggest; while the panel's slider is dragged, which sets the unchecked value of the
property only, the view shows it; and an animation track can change the isovalue."""

import os
import time
import traceback

from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkRenderingCore import vtkWindowToImageFilter

PATIENCE = 60.0  # seconds


def say(text):
    os.write(1, (text + "\n").encode())  # the application keeps what is printed


def check(condition, what):
    if not condition:
        raise AssertionError(what)
    say("ok: " + what)


class Steps:
    """Goes on with a generator between the application's other events."""

    def __init__(self, view):
        self.view = view
        self.steps = self.go()
        self.deadline = time.monotonic() + PATIENCE
        interactor = view.GetInteractor()
        interactor.AddObserver("TimerEvent", self.look)
        interactor.CreateRepeatingTimer(50)

    def look(self, *_):
        if self.steps.gi_running:
            return  # an animation handles events, too
        code = None
        try:
            if time.monotonic() > self.deadline:
                raise AssertionError("the view does not show the value")
            next(self.steps)
        except StopIteration:
            code = 0
        except BaseException:
            say(traceback.format_exc())
            code = 1
        if code is not None:
            simple.Disconnect()
            os._exit(code)

    def get_covered(self):
        image = vtkWindowToImageFilter()
        image.SetInput(self.view.GetRenderWindow())
        image.ShouldRerenderOff()
        image.ReadFrontBufferOff()
        image.Update()
        pixels = vtk_to_numpy(image.GetOutput().GetPointData().GetScalars()).astype(int)
        return (abs(pixels - pixels[0]) > 8).any(axis=1).sum()

    def go(self):
        source = simple.Wavelet()
        display = simple.Show(source, self.view)
        display.Representation = "DSM Ray Traced"
        simple.ResetCamera(self.view)
        simple.Render(self.view)
        first = display.DSMIsoValue
        check(100.0 < first < 250.0, f"the first isovalue is {first}")
        check(first == display.GetPropertyValue("DSMSuggestedIsoValue"), "as the data suggest")
        yield
        covered = self.get_covered()
        check(covered > 1000, f"it covers {covered} pixels")

        single = display.SMProxy.GetProperty("DSMIsoValue")
        for value in (220.0, 240.0, 255.0):
            single.SetUncheckedElement(0, value)
            while self.get_covered() >= covered:
                yield
            covered = self.get_covered()
            check(single.GetElement(0) == first, f"{value} is shown, and not yet set: {covered} pixels")
        display.DSMIsoValue = 255.0
        simple.Render(self.view)
        check(self.get_covered() == covered, "once it is set, the picture is the same")

        scene = simple.GetAnimationScene()
        track = simple.GetAnimationTrack("DSMIsoValue", 0, display)
        frames = []
        for time_, value in ((0.0, 150.0), (1.0, 250.0)):
            frame = simple.CompositeKeyFrame()
            frame.KeyTime = time_
            frame.KeyValues = [value]
            frames.append(frame)
        track.KeyFrames = frames
        scene.NumberOfFrames = 3
        scene.GoToFirst()
        seen = [display.DSMIsoValue]
        pixels = [self.get_covered()]
        for _ in range(2):
            scene.GoToNext()
            seen.append(display.DSMIsoValue)
            pixels.append(self.get_covered())
        check(seen == [150.0, 200.0, 250.0], f"an animation has isovalues {seen}")
        check(pixels[0] > pixels[1] > pixels[2], f"and shows them: {pixels}")


simple.GetLayout().SetSize(400, 300)
active = simple.GetActiveViewOrCreate("RenderView")
active.OrientationAxesVisibility = 0
simple.Render(active)
kept = Steps(active)
