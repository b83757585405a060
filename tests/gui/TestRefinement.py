# SPDX-License-Identifier: BSD-3-Clause
"""Run by ParaView's application, which has loaded the plugin, alone or connected to a server: a still view
of 1920 x 1080 pixels gets its samples by itself, while the application goes on handling events; whatever
changes begins anew; what is saved has all samples at once. DSM_TEST_PICTURE names the pictures."""

import ctypes
import os
import subprocess
import time
import traceback

from gui_testing import check, finish, grab, say
from paraview import servermanager, simple
from vtkmodules.util.misc import calldata_type
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import VTK_INT
from vtkmodules.vtkIOImage import vtkPNGReader

SAMPLES = 16
PICTURE = os.environ["DSM_TEST_PICTURE"]
BEAT = 0.02  # seconds between two looks at the application
MOST_RAYS = 1024  # of ambient occlusion, that the display takes
PATIENCE = 250.0  # seconds for everything

HOLDS = (0.02, 0.08, 0.2, 0.4)  # seconds that the left button of the mouse is held
CLICKS = 4  # of each

# Clicks in the middle of the view, in the middle of frames, and tells when.
CLICK = """
import ctypes, sys, time
x11, xtst = ctypes.CDLL('libX11.so.6'), ctypes.CDLL('libXtst.so.6')
x11.XOpenDisplay.restype = ctypes.c_void_p
display = ctypes.c_void_p(x11.XOpenDisplay(None))
xtst.XTestFakeMotionEvent(display, -1, int(sys.argv[1]), int(sys.argv[2]), 0)
for hold in sys.argv[3:]:
    time.sleep(0.7)
    print(time.monotonic(), flush=True)
    for pressed, seconds in ((1, float(hold)), (0, 0.0)):
        xtst.XTestFakeButtonEvent(display, 1, pressed, 0)
        x11.XFlush(display)
        time.sleep(seconds)
"""


def read_picture(name):
    reader = vtkPNGReader()
    reader.SetFileName(name)
    reader.Update()
    width, height, _ = reader.GetOutput().GetDimensions()
    values = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())
    return values.reshape(height, width, -1)[:, :, :3].astype(int)


class Watch:
    """Sees, between the application's other events, how many samples the picture has."""

    def __init__(self, view, display):
        self.view, self.display = view, display
        self.wanted = SAMPLES
        self.property = display.SMProxy.GetProperty("DSMSamples")
        self.steps = self.go()
        self.start = time.monotonic()
        self.begin()
        interactor = view.GetInteractor()
        interactor.AddObserver("TimerEvent", self.look)
        self.timer = interactor.CreateRepeatingTimer(int(1000 * BEAT))

    def begin(self):
        self.last = None
        self.begun = time.monotonic()
        self.gaps = []
        self.seen = []

    def get_samples(self):
        report = self.property.GetParent()
        report.UpdatePropertyInformation(self.property)
        return self.property.GetElement(0)

    @calldata_type(VTK_INT)
    def look(self, interactor, event, timer):
        if timer != self.timer:
            return
        now = time.monotonic()
        if self.last is not None:
            self.gaps.append(now - self.last)
        samples = self.get_samples()
        if not self.seen or self.seen[-1] != samples:
            self.seen.append(samples)
        try:
            if now - self.start > PATIENCE:
                raise AssertionError(f"still waiting after {PATIENCE} s; samples seen: {self.seen}")
            next(self.steps)
        except StopIteration:
            say("the application refined its pictures")
            finish(0)
        except BaseException:
            say(traceback.format_exc())
            finish(1)
        self.last = time.monotonic()

    def wait_until_refined(self, what):
        while self.get_samples() < self.wanted:
            yield
        seconds = time.monotonic() - self.begun
        rises = all(a < b for a, b in zip(self.seen, self.seen[1:]))
        check(rises and len(self.seen) >= 4 and self.seen[-1] == self.wanted, f"{what}: samples rise: {self.seen}")
        # No render takes much longer than one sample, or the time that a render may take; on a machine that
        # does other things, too, one of them may.
        middle = sorted(self.gaps)[len(self.gaps) // 2]
        check(middle < 0.25 * seconds,
              f"{what}: took {seconds:.2f} s; events waited for {middle:.2f} s, and {max(self.gaps):.2f} s at most")

    def go(self):
        width, height = self.view.ViewSize
        check(width * height >= 1920 * 1080, f"the view has {width} x {height} pixels")
        yield from self.wait_until_refined("the first picture")

        # The mouse turns the scene.
        self.display.DSMSamplesPerPixel = self.wanted = 6
        interactor = self.view.GetInteractor()
        position = list(self.view.CameraPosition)
        interactor.SetEventInformation(width // 2, height // 2)
        interactor.InvokeEvent("LeftButtonPressEvent")
        for step in range(1, 4):
            interactor.SetEventInformation(width // 2 + 20 * step, height // 2 + 10 * step)
            interactor.InvokeEvent("MouseMoveEvent")
            yield
            check(self.get_samples() <= 1, f"while the mouse moves, there is one sample at most ({step})")
        interactor.InvokeEvent("LeftButtonReleaseEvent")
        check(list(self.view.CameraPosition) != position, "the mouse turns the scene")
        self.begin()
        while self.get_samples() < 4:
            yield
        check(self.seen[0] < 4, f"and then samples are added: {self.seen}")

        # A picture that is saved on the way.
        self.display.DSMIsoValues = [150.0]
        simple.Render(self.view)
        self.begin()
        while self.get_samples() < 2:
            yield
        before = self.get_samples()
        check(before < self.wanted, f"the view has {before} samples")
        simple.SaveScreenshot(PICTURE + ".early.png", self.view)
        check(self.get_samples() == self.wanted, "a saved picture has all samples")
        # Another change, and back.
        self.display.DSMIsoValues = [157.0]
        simple.Render(self.view)
        check(self.get_samples() < self.wanted, "another isovalue begins anew")
        self.display.DSMIsoValues = [150.0]
        simple.Render(self.view)
        self.begin()
        yield from self.wait_until_refined("another isovalue")
        simple.SaveScreenshot(PICTURE + ".late.png", self.view)
        early, late = read_picture(PICTURE + ".early.png"), read_picture(PICTURE + ".late.png")
        check(early.shape == late.shape and (early == late).all(), "early or late, the saved picture is the same")
        start = time.monotonic()
        simple.Render(self.view)
        self.redraw = time.monotonic() - start
        yield
        check(self.get_samples() == self.wanted, "nothing changes once all samples are there")
        yield from self.click_while_tracing()
        if not servermanager.ActiveConnection.IsRemote():
            yield from self.click_after_tracing()

    def click_while_tracing(self):
        """A press of the mouse ends the frame, however short it is, also that of a server."""
        try:
            ctypes.CDLL("libXtst.so.6")
        except OSError:
            say("skipped: without libXtst, nothing can press the mouse")
            return

        def time_render():
            """Times a whole picture. The first one that a render shows may be a draft."""
            self.display.DSMIsoValues = [self.display.DSMIsoValues[0] + 0.01]
            start = time.monotonic()
            simple.SaveScreenshot(PICTURE + ".whole.png", self.view)
            return time.monotonic() - start

        self.display.DSMSamplesPerPixel = 1
        while (whole := time_render()) < 3.0:
            check(self.display.DSMAmbientOcclusionSamples < MOST_RAYS, f"a frame takes time: {whole:.2f} s")
            self.display.DSMAmbientOcclusionSamples *= 4
        self.display.DSMSamplesPerPixel = self.wanted = 64
        shown = grab(self.view)
        heard = []
        interactor = self.view.GetInteractor()
        interactor.AddObserver("LeftButtonPressEvent", lambda *_: heard.append(time.monotonic()), 10.0)
        window = self.view.GetRenderWindow()
        place = [start + size // 2 for start, size in zip(window.GetPosition(), window.GetSize())]
        holds = [str(hold) for hold in HOLDS * CLICKS]
        # A click may come while a picture is drawn; then the ended frame draws the last one, and the window shows it.
        limit = max(0.3, 0.1 + 3.0 * self.redraw)
        for _ in range(2):  # another program may have taken the processor once
            heard.clear()
            clicks = subprocess.Popen(["python3", "-c", CLICK, *map(str, place), *holds], stdout=subprocess.PIPE,
                                      text=True)
            while clicks.poll() is None:
                yield
            pressed = [float(line) for line in clicks.stdout]
            while len(heard) < len(pressed) and time.monotonic() < pressed[-1] + 5.0:
                yield
            waits = sorted(after - before for before, after in zip(pressed, heard))
            check(len(pressed) == len(heard) == len(holds), f"{len(heard)} of {len(pressed)} clicks are heard of")
            told = (f"in frames of {whole:.1f} s, clicks are heard of after {waits[len(waits) // 2]:.3f} s, "
                    f"and {waits[-1]:.3f} s of {limit:.3f} s at most: {[round(wait, 3) for wait in waits]}")
            if waits[-1] < limit:
                break
            say(told)
        check(waits[0] >= 0 and waits[-1] < limit, told)
        check(self.get_samples() < self.wanted, "there was always a frame to be ended")
        # While the mouse turns the scene, pictures are as coarse as their time demands.
        width, height = self.view.ViewSize
        interactor.SetEventInformation(width // 2, height // 2)
        interactor.InvokeEvent("LeftButtonPressEvent")
        times = []
        for step in range(1, 5):
            interactor.SetEventInformation(width // 2 + 20 * step, height // 2)
            start = time.monotonic()
            interactor.InvokeEvent("MouseMoveEvent")
            times.append(time.monotonic() - start)
            yield
        interactor.InvokeEvent("LeftButtonReleaseEvent")
        check(times[0] < 0.5 * whole and max(times[1:]) < 0.15 * whole,
              f"moving pictures take {[round(seconds, 2) for seconds in times]} s")
        self.display.DSMAmbientOcclusionSamples = 1
        self.display.DSMSamplesPerPixel = self.wanted = 6
        self.display.DSMIsoValues = [140.0]
        simple.Render(self.view)
        self.begin()
        while self.get_samples() < 3:
            yield
        check((grab(self.view) != shown).any(), "the next pictures are drawn and refined")

    def click_after_tracing(self):
        """What is drawn after the traced picture, such as the orientation axes, is there soon whatever the user
        presses."""
        self.display.DSMAmbientOcclusionSamples = 0
        self.display.DSMSamplesPerPixel = self.wanted = 1
        self.view.OrientationAxesVisibility = 1
        self.display.DSMIsoValues = [141.0]
        simple.Render(self.view)
        yield
        window = self.view.GetRenderWindow()
        place = [str(start + size // 2) for start, size in zip(window.GetPosition(), window.GetSize())]
        clicks = []

        def click(*_):
            clicks.append(subprocess.call(["python3", "-c", CLICK, *place, "0.02"], stdout=subprocess.DEVNULL))

        renderer = self.view.GetRenderer()
        observer = renderer.AddObserver("EndEvent", click)
        self.display.DSMIsoValues = [142.0]
        simple.Render(self.view)
        renderer.RemoveObserver(observer)
        heard = time.monotonic()
        while time.monotonic() < heard + 2.0:
            yield
        shown = grab(self.view)
        simple.Render(self.view)
        different = (grab(self.view) != shown).any(axis=1).sum()
        check(clicks == [0] and different == 0, f"a click while axes are drawn leaves out {different} pixels")


def test():
    layout = simple.GetLayout()
    layout.SetSize(1920, 1080)
    view = simple.GetActiveViewOrCreate("RenderView")
    view.OrientationAxesVisibility = 0
    source = simple.Wavelet(WholeExtent=[-20, 20, -20, 20, -20, 20])
    display = simple.Show(source, view)
    display.Representation = "DSM Ray Traced"
    display.DSMIsoValues = [157.0]
    display.DSMAmbientOcclusionSamples = 1
    display.DSMSamplesPerPixel = SAMPLES
    simple.ResetCamera(view)
    simple.Render(view)
    return Watch(view, display)


try:
    watch = test()
except BaseException:
    say(traceback.format_exc())
    os._exit(1)
