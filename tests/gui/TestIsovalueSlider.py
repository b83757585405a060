# SPDX-License-Identifier: BSD-3-Clause
"""Run by ParaView's application, which has loaded the plugin, alone or connected to a server: the first isovalue
is the one that the data suggest, and so is what the reset button gives; while the panel's slider is dragged, which sets the unchecked value of the
property only, the view shows it; an animation track can change the isovalue; and a display that was made before
there were data has their array and their box once they are there."""

import os
import tempfile

import numpy
from gui_testing import Steps, check, grab
from paraview import simple

PATIENCE = 60.0  # seconds


class Session:
    def __init__(self, view):
        self.view = view

    def get_covered(self):
        pixels = grab(self.view)
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
        single.ResetToDomainDefaults(True)  # as the reset button
        check(single.GetUncheckedElement(0) == first, f"the reset button gives {single.GetUncheckedElement(0)}")
        single.ClearUncheckedElements()

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
        simple.Hide(source, self.view)
        self.show_before_there_are_data()

    def show_before_there_are_data(self):
        """As when a file of bare values is opened, and only then its size is entered."""
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "late.raw")
            numpy.arange(512, dtype="float32").tofile(path)
            source = simple.DSMVolumeReader(FileName=path)
            display = simple.Show(source, self.view)
            simple.Render(self.view)
            check(not display.DSMIsoArray[1], "there is no array yet")
            source.RawDimensions, source.RawScalarType = [8, 8, 8], "float"
            display.Representation = "DSM Ray Traced"
            simple.Render(self.view)
            check(display.DSMIsoArray[1] == "values", f"there is one now: {display.DSMIsoArray}")
            check(list(display.DSMCroppingBox) == [0, 7] * 3, f"and a box to crop to: {display.DSMCroppingBox}")
            check(0.0 < display.DSMIsoValue < 511.0, f"and an isovalue: {display.DSMIsoValue}")
            simple.Delete(source)


simple.GetLayout().SetSize(400, 300)
active = simple.GetActiveViewOrCreate("RenderView")
active.OrientationAxesVisibility = 0
simple.Render(active)
steps = Steps(active, Session(active).go(), PATIENCE, "the view does not show the value")
