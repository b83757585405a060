# SPDX-License-Identifier: BSD-3-Clause
"""A user at the far end of a network: how long ParaView's application takes to answer the mouse, to show a changed
setting, and how many bytes it gets, while a picture takes seconds. Run by the application, which has loaded the plugin
and is connected to a server through tests/paraview/slow_link.py:

    PYTHONPATH=tests/gui paraview --dr --plugins=DSMRayTracer --server-url=cs://127.0.0.1:PORT --script=far_client.py

DSM_FAR_LINK is the process id of slow_link.py, whose standard input and output are DSM_FAR_LINK_IN and
DSM_FAR_LINK_OUT (pipes); without it bytes are not counted. DSM_FAR_SHOW is a comma separated list of isosurface,
volume, Contour, Volume; DSM_FAR_SECONDS how long a whole picture of a traced one takes at least (10).

The mouse is moved through the X server, as by hand."""

import os
import subprocess
import time

from gui_testing import Steps, grab, say
from paraview import simple
from vtkmodules.vtkRenderingCore import vtkCamera

SHOWN = os.environ.get("DSM_FAR_SHOW", "isosurface,volume,Contour,Volume").split(",")
SECONDS = float(os.environ.get("DSM_FAR_SECONDS", "10"))
SIZE = (1000, 700)
EXTENT = int(os.environ.get("DSM_FAR_EXTENT", "60"))
PRESSES = int(os.environ.get("DSM_FAR_PRESSES", "12"))
DRAG = 100  # moves of the mouse
PATIENCE = 3600.0

# Presses the left button at a place, drags and releases it; tells when.
MOUSE = """
import ctypes, sys, time
x11, xtst = ctypes.CDLL('libX11.so.6'), ctypes.CDLL('libXtst.so.6')
x11.XOpenDisplay.restype = ctypes.c_void_p
display = ctypes.c_void_p(x11.XOpenDisplay(None))
x, y, moves, pause = (float(word) for word in sys.argv[1:])
def act(call, *arguments):
    call(display, *arguments)
    x11.XSync(display, 0)
act(xtst.XTestFakeMotionEvent, -1, int(x), int(y), 0)
time.sleep(0.05)
print(time.monotonic(), flush=True)
act(xtst.XTestFakeButtonEvent, 1, 1, 0)
for move in range(int(moves)):
    act(xtst.XTestFakeMotionEvent, -1, int(x) + 2 * move + 2, int(y) + move % 20, 0)
    time.sleep(pause)
act(xtst.XTestFakeButtonEvent, 1, 0, 0)
print(time.monotonic(), flush=True)
"""


def count_bytes():
    if "DSM_FAR_LINK_IN" not in os.environ:
        return 0
    with open(os.environ["DSM_FAR_LINK_IN"], "w") as ask:
        ask.write("\n")
    with open(os.environ["DSM_FAR_LINK_OUT"]) as answer:
        return int(answer.readline())


def describe(times):
    ordered = sorted(times)
    return f"median {ordered[len(ordered) // 2]:.3f}, longest {ordered[-1]:.3f} s" if ordered else "none"


class Session:
    def __init__(self, view):
        self.view = view
        self.renders = []  # (start, end, interactive) of each
        self.pressed = []
        view.SMProxy.AddObserver("StartEvent", self.begin)
        view.SMProxy.AddObserver("EndEvent", self.end)
        view.GetInteractor().AddObserver("LeftButtonPressEvent", lambda *_: self.pressed.append(time.monotonic()), 10.0)
        self.interacting = False
        interactor = view.GetInteractor()
        interactor.AddObserver("StartInteractionEvent", lambda *_: setattr(self, "interacting", True), 10.0)
        interactor.AddObserver("EndInteractionEvent", lambda *_: setattr(self, "interacting", False), 10.0)

    def begin(self, *_):
        self.started = time.monotonic()

    def end(self, *_):
        self.renders.append((self.started, time.monotonic(), self.interacting))

    def is_whole(self, display):
        samples = display.SMProxy.GetProperty("DSMSamples") if self.traced else None
        if not samples:
            return True
        samples.GetParent().UpdatePropertyInformation(samples)
        return samples.GetElement(0) >= samples.GetElement(1)

    def wait(self, display):
        """Until the picture is whole, without asking for it too often."""
        start = time.monotonic()
        quiet = 0
        while quiet < 8:
            before = len(self.renders)
            for _ in range(5):
                yield
            if len(self.renders) == before and self.is_whole(display):
                quiet += 1
                if quiet == 1:
                    done = self.renders[-1][1] if self.renders else start
            else:
                quiet = 0
        return done - start

    def act(self, moves, pause=0.03):
        window = self.view.GetRenderWindow()
        place = [str(start + size // 2) for start, size in zip(window.GetPosition(), window.GetSize())]
        return subprocess.Popen(["/usr/bin/python3", "-c", MOUSE, *place, str(moves), str(pause)],
                                stdout=subprocess.PIPE, text=True)

    def show(self, what):
        source = simple.Wavelet(WholeExtent=[-EXTENT, EXTENT] * 3)
        self.traced = what in ("isosurface", "volume")
        if what == "Contour":
            source = simple.Contour(Input=source, ContourBy=["POINTS", "RTData"], Isosurfaces=[157.0])
        display = simple.Show(source, self.view)
        display.SetRepresentationType({"isosurface": "DSM Ray Traced", "volume": "DSM Volume", "Contour": "Surface",
                                       "Volume": "Volume"}[what])
        if what != "Contour":
            simple.ColorBy(display, ("POINTS", "RTData"))
        if what == "isosurface":
            display.DSMIsoValues = [157.0]
            display.DSMShadows = 1
            display.DSMAmbientOcclusionSamples = 4
        if what in ("volume", "Volume"):
            display.Shade = 1
        if what == "volume":
            display.DSMShadows = 1
        if self.traced:
            display.DSMSamplesPerPixel = 1
        simple.ResetCamera(self.view)
        simple.Render(self.view)
        return source, display

    def change(self, what, display, number):
        """A setting that shows something else."""
        if what == "isosurface":
            display.DSMIsoValues = [150.0 + number]
        elif what == "Contour":
            self.source.Isosurfaces = [150.0 + number]
        else:
            display.SpecularPower = 20.0 + number
            display.Specular = 0.2

    def go(self):
        for what in SHOWN:
            self.source, display = self.show(what)
            seconds = yield from self.wait(display)
            # A picture that takes as long as is wanted.
            while self.traced:
                start = time.monotonic()
                self.change(what, display, 1)
                simple.Render(self.view)
                yield from self.wait(display)
                seconds = self.renders[-1][1] - start
                if seconds > SECONDS:
                    break
                rays = max(1, display.DSMAmbientOcclusionSamples)
                display.DSMAmbientOcclusionSamples = max(rays + 1, int(rays * min(8.0, 1.2 * SECONDS / seconds)))
            rays = f", {display.DSMAmbientOcclusionSamples} occlusion rays" if self.traced else ""
            say(f"{what}: a whole picture takes {seconds:.1f} s{rays}")
            whole = grab(self.view)
            camera = vtkCamera()
            camera.DeepCopy(self.view.SMProxy.GetActiveCamera())

            firsts, bytes_before = [], count_bytes()
            for number in range(4):
                start = time.monotonic()
                before = len(self.renders)
                self.change(what, display, 2 + number)
                simple.Render(self.view)
                firsts.append(self.renders[before][1] - start)
                for _ in range(10):
                    yield
            say(f"{what}: first picture after a change: {describe(firsts)}")

            # Presses in the middle of a still frame.
            heard, seen, ended = [], [], []
            for number in range(PRESSES):
                self.change(what, display, 6 + number)
                simple.Render(self.view)
                for _ in range(5 + 3 * number % 11):
                    yield
                self.pressed.clear()
                before = len(self.renders)
                mouse = self.act(4)
                while mouse.poll() is None or self.interacting:
                    yield
                lines = [float(line) for line in mouse.stdout]
                for _ in range(3):
                    yield
                if self.pressed:
                    heard.append(self.pressed[0] - lines[0])
                later = [end - lines[0] for start, end, moving in self.renders[before:] if end > lines[0] and moving]
                if later:
                    seen.append(later[0])
            say(f"{what}: from a press until the application hears of it: {describe(heard)}; until a new picture: "
                f"{describe(seen)}")

            yield from self.wait(display)
            before, bytes_before = len(self.renders), count_bytes()
            mouse = self.act(DRAG, 0.05)
            while mouse.poll() is None or self.interacting:
                yield
            times = [end - start for start, end, moving in self.renders[before:] if moving]
            say(f"{what}: {len(times)} pictures of a drag: {describe(times)}, "
                f"{(count_bytes() - bytes_before) / 1024 / max(1, len(times)):.0f} KiB each")
            yield from self.wait(display)

            self.view.SMProxy.GetActiveCamera().DeepCopy(camera)
            self.view.SMProxy.SynchronizeCameraProperties()
            self.change(what, display, 1)
            before, bytes_before, start = len(self.renders), count_bytes(), time.monotonic()
            simple.Render(self.view)
            yield from self.wait(display)
            say(f"{what}: the whole picture again: {self.renders[-1][1] - start:.1f} s, {len(self.renders) - before} "
                f"pictures, {(count_bytes() - bytes_before) / 1024:.0f} KiB; "
                f"{(grab(self.view) != whole).any(axis=1).sum()} pixels differ")
            simple.Delete(display)
            simple.Delete(self.source)


active = simple.GetActiveViewOrCreate("RenderView")
active.OrientationAxesVisibility = 0
simple.GetLayout().SetSize(*SIZE)
steps = Steps(active, Session(active).go(), PATIENCE, "the measurement takes too long")
