# SPDX-License-Identifier: BSD-3-Clause
"""Run by ParaView's application, which has loaded the plugin, alone or connected to a server: the first isovalue
is the one that the data suggest, and so is what the reset button gives; while the panel's slider is dragged, which
sets the unchecked value of the property only, the view shows it, and so it does with the index of a slice; an
animation track can change the isovalue; another array has an isovalue of its own, also back and forth; where none is
suggested, the panel shows a number that the user has not chosen, again also after a choice is undone; a list of several
begins with the one that is there; and a display that was made before there were data has their array and their box
once they are there."""

import os
import tempfile

import numpy
from gui_testing import Steps, check, grab
from paraview import servermanager, simple

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
        yield from self.choose_arrays()
        yield from self.undo_choice()
        yield from self.begin_list(display)

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
        yield from self.drag_slice()
        self.show_before_there_are_data()

    def choose_arrays(self):
        calculator = simple.Calculator(Input=simple.Wavelet(), ResultArrayName="other", Function="RTData/1000")
        display = simple.Show(calculator, self.view)
        display.Representation = "DSM Ray Traced"
        display.DSMIsoArray = ["POINTS", "RTData"]
        display.DSMIsoValue = 200.0
        for other in simple.GetSources().values():
            if other.SMProxy != calculator.SMProxy:
                simple.Hide(other, self.view)
        simple.Render(self.view)
        check(display.DSMIsoValue == 200.0, "an isovalue that is set with the array is kept")
        yield
        covered = self.get_covered()
        builder = servermanager.vtkSMProxyManager.GetProxyManager().GetUndoStackBuilder()
        stack = builder.GetUndoStack()
        builder.Begin("Another array")
        display.DSMIsoArray = ["POINTS", "other"]
        builder.End()
        builder.PushToStack()
        simple.Render(self.view)
        yield
        chosen = display.DSMIsoValue
        check(0.05 < chosen < 0.25, f"another array has the isovalue {chosen}")
        check(chosen == display.GetPropertyValue("DSMSuggestedIsoValue"), "as its data suggest")
        check(self.get_covered() > 1000, f"which covers {self.get_covered()} pixels")
        self.step(builder, stack.Undo)
        simple.Render(self.view)
        yield
        check(display.DSMIsoArray[1] == "RTData" and display.DSMIsoValue == 200.0,
              f"Undo brings back both: {display.DSMIsoArray[1]}, {display.DSMIsoValue}")
        check(self.get_covered() == covered, f"and the picture: {self.get_covered()} pixels of {covered}")
        self.step(builder, stack.Redo)
        simple.Render(self.view)
        yield
        check(display.DSMIsoArray[1] == "other" and display.DSMIsoValue == chosen,
              f"Redo does so, too: {display.DSMIsoArray[1]}, {display.DSMIsoValue}")
        display.DSMIsoArray = ["POINTS", "RTData"]
        display.DSMIsoValue = 220.0
        simple.Render(self.view)
        check(display.DSMIsoValue == 220.0, "what a script sets after the array counts")
        display.DSMIsoArray = ["POINTS", "other"]
        display.DSMIsoValue = 0.2
        display.DSMIsoArray = ["POINTS", "RTData"]
        display.DSMIsoArray = ["POINTS", "other"]
        simple.Render(self.view)
        check(display.DSMIsoValue == chosen, "and only then")
        simple.Delete(calculator)
        for other in simple.GetSources().values():
            if other.SMProxy.GetXMLName() == "RTAnalyticSource":
                simple.Show(other, self.view)

    def undo_choice(self):
        calculator = simple.Calculator(Input=simple.Wavelet(), ResultArrayName="level", Function="7")
        display = simple.Show(calculator, self.view)
        display.Representation = "DSM Ray Traced"
        display.DSMIsoArray = ["POINTS", "level"]
        simple.Render(self.view)
        yield
        check(display.DSMIsoValue == 7.0, f"a constant array has the isovalue {display.DSMIsoValue}")
        builder = servermanager.vtkSMProxyManager.GetProxyManager().GetUndoStackBuilder()
        stack = builder.GetUndoStack()
        builder.Begin("An isovalue")
        display.DSMIsoValue = 3.0
        builder.End()
        builder.PushToStack()
        simple.Render(self.view)
        yield
        check(display.DSMIsoValue == 3.0, "what is chosen counts")
        self.step(builder, stack.Undo)
        simple.Render(self.view)
        check(display.DSMIsoValue == 7.0, f"Undo brings back {display.DSMIsoValue}")
        calculator.Function = "RTData/1000"
        simple.Render(self.view)
        yield
        check(0.05 < display.DSMIsoValue < 0.25, f"which is nobody's choice: {display.DSMIsoValue}")
        simple.Delete(calculator)

    @staticmethod
    def step(builder, go):
        """As the application does."""
        builder.SetIgnoreAllChanges(True)
        go()
        servermanager.ProxyManager().UpdateRegisteredProxies(1)
        builder.SetIgnoreAllChanges(False)

    def begin_list(self, display):
        """As the panel's + does: 0 in the panel, then in the property."""
        values = display.SMProxy.GetProperty("DSMIsoValues")
        told = []
        tag = values.AddObserver("UncheckedPropertyModifiedEvent", lambda *_: told.append(values.GetNumberOfElements()))
        values.SetNumberOfUncheckedElements(1)
        values.SetUncheckedElement(0, 0.0)
        display.DSMIsoValues = [0.0]
        simple.Render(self.view)
        yield
        check(list(display.DSMIsoValues) == [display.DSMIsoValue], f"a list begins with {display.DSMIsoValues}")
        told.clear()
        display.DSMIsoValues = []
        check(told and told[-1] == 0, "what depends on the list is told that a script has emptied it")
        values.RemoveObserver(tag)
        display.DSMIsoValues = [0.0]
        simple.Render(self.view)
        check(list(display.DSMIsoValues) == [0.0], "a script may mean 0")
        values.ResetToDomainDefaults(True)
        reset = values.GetUncheckedElement(0)
        check(reset == display.GetPropertyValue("DSMSuggestedIsoValue"), f"the list's reset button gives {reset}")
        values.ClearUncheckedElements()
        display.DSMIsoValues = []
        simple.Render(self.view)

    def drag_slice(self):
        source = simple.Wavelet()
        display = simple.Show(source, self.view)
        display.Representation = "DSM Slices"
        simple.Render(self.view)
        yield
        check(display.ColorArrayName[1] == "RTData", "slices are colored at first")
        index = display.SMProxy.GetProperty("DSMSliceZIndex")
        for value in (13, 16):
            before = grab(self.view)
            index.SetUncheckedElement(0, value)
            while (grab(self.view) == before).all():
                yield
            check(index.GetElement(0) == 10, f"slice {value} is shown, and not yet set")
        shown = grab(self.view)
        display.DSMSliceZIndex = 16
        simple.Render(self.view)
        check((grab(self.view) == shown).all(), "once it is set, the picture is the same")
        simple.Delete(source)

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
            check(display.DSMIsoArray[1] == "late", f"there is one now: {display.DSMIsoArray}")
            check(list(display.DSMCroppingBox) == [0, 7] * 3, f"and a box to crop to: {display.DSMCroppingBox}")
            check(0.0 < display.DSMIsoValue < 511.0, f"and an isovalue: {display.DSMIsoValue}")
            simple.Delete(source)


simple.GetLayout().SetSize(400, 300)
active = simple.GetActiveViewOrCreate("RenderView")
active.OrientationAxesVisibility = 0
simple.Render(active)
steps = Steps(active, Session(active).go(), PATIENCE, "the view does not show the value")
