# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of a pyramid on a server, as of a microscope's images: seconds, bytes that the server is asked for, and how
much the picture changes where the level of detail does. Called as

    OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 PYTHONPATH=build/lib/python3/dist-packages
        xvfb-run -a -s "-screen 0 1280x1024x24 -noreset" pvbatch tests/benchmarks/levels_by_view.py
        [--plugin build/lib/DSMRayTracer/DSMRayTracer.so] [--size 8192 8192 4096] [--delay MILLISECONDS]
        [--levels Automatic|Finest] [--medium] [--pixels-per-sample 1] [--frames 50]

On one rank. serve_pyramid.py makes the pyramid; the kept chunks of other runs are not used. Pictures have 512 x 512
pixels and show the isosurface of 127.5, or with --medium the volume.

Bytes are given as MiB, and beside "one sample a pixel": the bytes of a level whose samples are about one pixel wide
at the middle of the volume, for all pixels and for all of its samples along z. The line of the zoom by 2 also gives
its bytes over all bytes before it.

The slow zoom begins where the first picture was, and comes as near as the zoom by 2. A difference is that of two
neighbors' pixels, in 255ths, as the mean of a picture and as its largest one. The mean over those of the frames around
it, two before and two after, shows a change of the level, because the camera's motion is even."""

import argparse
import json
import math
import os
import statistics
import subprocess
import sys
import tempfile
import time
import urllib.request

import numpy
from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy

HERE = os.path.dirname(os.path.abspath(__file__))
PLUGIN = os.path.join(HERE, "..", "..", "build", "lib", "DSMRayTracer", "DSMRayTracer.so")
ARRAY = "pyramid"
ISOVALUE = 127.5
PIXELS = 512  # along each edge of a picture
ORBIT, DEGREES = 12, 5.0
# The window around the volume is below the first of these values.
OPACITIES = [64.0, 0.0, 0.5, 0.0, 255.0, 0.8, 0.5, 0.0]
UNITS_OF_OPACITY = 20  # along the longest edge


class Server:
    """serve_pyramid.py in a process, which ends with this one."""

    def __init__(self, options):
        command = ["/usr/bin/python3", os.path.join(HERE, "serve_pyramid.py"), "--end-with-input",
                   "--delay", str(options.delay), "--size", *map(str, options.size)]
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        words = self.process.stdout.readline().split()
        if len(words) != 2:
            raise SystemExit("serve_pyramid.py did not start: its output has no line 'port N'")
        self.address = f"http://127.0.0.1:{words[1]}"

    def get_bytes(self):
        """Bytes of the chunks that were fetched until now, by level."""
        with urllib.request.urlopen(self.address + "/stats", timeout=60) as answer:
            rows = json.load(answer)["by_level"]
        return {int(level): row["bytes"] for level, row in rows.items()}


class Report:
    """Prints lines with the bytes that were fetched since the line before."""

    def __init__(self, server):
        self.server = server
        self.before = server.get_bytes()
        self.sample_a_pixel = None

    def say(self, what):
        """Returns the new bytes."""
        now = self.server.get_bytes()
        new = {level: count - self.before[level] for level, count in now.items() if count > self.before[level]}
        self.before = now
        total = sum(new.values())
        levels = ", ".join(f"level {level}: {count / 2**20:.2f}" for level, count in new.items())
        text = f"{total / 2**20:.2f} MiB" + (f" ({levels})" if new else "")
        if self.sample_a_pixel:
            text += f", {total / self.sample_a_pixel:.3f} of one sample a pixel"
        print(f"{what}; {text}", flush=True)

    def get_total(self):
        return sum(self.before.values())


def take(view):
    """Seconds to the finished picture, and its pixels."""
    start = time.perf_counter()
    image = view.SMProxy.CaptureWindow(1)
    seconds = time.perf_counter() - start
    pixels = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(PIXELS, PIXELS, -1)
    return seconds, pixels[:, :, :3].astype(int)


def show(source, view, options):
    display = simple.Show(source, view)
    if options.medium:
        simple.ColorBy(display, ("POINTS", ARRAY))
        simple.GetColorTransferFunction(ARRAY).RescaleTransferFunction(0.0, 255.0)
        simple.GetOpacityTransferFunction(ARRAY).Points = OPACITIES
        display.Representation = "DSM Volume"
        display.ScalarOpacityUnitDistance = max(options.size) / UNITS_OF_OPACITY
    else:
        display.Representation = "DSM Ray Traced"
        display.ColorArrayName = [None, ""]
        display.DSMIsoValues = [ISOVALUE]
    display.DSMLevelOfDetail = options.levels
    display.DSMPixelsPerSample = options.pixels_per_sample
    view.CameraViewUp = [0, 1, 0]
    view.CameraFocalPoint = [0, 0, 0]
    view.CameraPosition = [0.6, 0.5, 1.0]
    simple.ResetCamera(view)


def count_sample_a_pixel(camera, size):
    """Bytes of the level whose samples are about one pixel wide, its number, and the width of a pixel in samples."""
    pixel = 2 * camera.GetDistance() * math.tan(math.radians(camera.GetViewAngle()) / 2) / PIXELS
    level = max(0, round(math.log2(pixel)))
    return PIXELS**2 * math.ceil(size[2] / 2**level), level, pixel


def zoom_slowly(view, frames):
    """Seconds, and mean and largest difference to the frame before, of each frame."""
    camera = view.GetActiveCamera()
    _, before = take(view)
    found = []
    for _ in range(frames):
        camera.Dolly(2 ** (1 / frames))
        seconds, pixels = take(view)
        apart = numpy.abs(pixels - before)
        found.append((seconds, apart.mean(), apart.max()))
        before = pixels
    return zip(*found)


def find_jumps(means):
    """The mean difference of each frame over the median of those around it."""
    found = []
    for frame, mean in enumerate(means):
        around = means[max(0, frame - 2) : frame] + means[frame + 1 : frame + 3]
        found.append(mean / max(1e-9, statistics.median(around or [mean])))
    return found


def get_peak():
    """MiB that this process has had in memory at most."""
    with open("/proc/self/status", encoding="utf-8") as status:
        (line,) = [line for line in status if line.startswith("VmHWM:")]
    return int(line.split()[1]) / 1024


def measure(server, options):
    report = Report(server)
    view = simple.CreateRenderView(ViewSize=[PIXELS, PIXELS])
    view.OrientationAxesVisibility = 0
    take(view)  # what is made for the first frame of any view is not counted

    start = time.perf_counter()
    source = simple.OpenDataFile(server.address + "/pyramid.zarr")
    source.UpdatePipeline()
    report.say(f"opened: {time.perf_counter() - start:.2f} s")

    start = time.perf_counter()
    show(source, view, options)
    camera = view.GetActiveCamera()
    report.sample_a_pixel, level, pixel = count_sample_a_pixel(camera, options.size)
    take(view)
    report.say(f"first picture: {time.perf_counter() - start:.2f} s")
    print(f"    a pixel is {pixel:.2f} samples of level 0 wide; one sample a pixel: level {level}, "
          f"{report.sample_a_pixel / 2**20:.2f} MiB; with the opening: "
          f"{report.get_total() / report.sample_a_pixel:.3f} of it", flush=True)
    place = camera.GetPosition()

    before = report.get_total()
    camera.Dolly(2.0)
    report.sample_a_pixel, *_ = count_sample_a_pixel(camera, options.size)
    seconds, _ = take(view)
    report.say(f"zoom by 2: {seconds:.2f} s")
    if before:
        print(f"    {(report.get_total() - before) / before:.3f} of the bytes before", flush=True)

    orbit = []
    for _ in range(ORBIT):
        camera.Azimuth(DEGREES)
        orbit.append(take(view)[0])
    report.say(f"orbit of {ORBIT} pictures: {statistics.mean(orbit):.2f} s a picture, {max(orbit):.2f} s at most")

    camera.SetPosition(place)
    seconds, means, largest = zoom_slowly(view, options.frames)
    report.say(f"slow zoom of {options.frames} frames: {statistics.mean(seconds):.2f} s a frame, "
               f"{max(seconds):.2f} s at most")
    jumps = find_jumps(means)
    print(f"    difference of neighbors: mean {max(means):.3f} at most (frame {means.index(max(means)) + 1}), median "
          f"of the means {statistics.median(means):.3f}; largest {max(largest)}\n"
          f"    mean over those around it: {max(jumps):.2f} at most (frame {jumps.index(max(jumps)) + 1})\n"
          f"VmHWM: {get_peak():.0f} MiB", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--plugin", type=os.path.abspath, default=os.path.abspath(PLUGIN))
    parser.add_argument("--size", type=int, nargs=3, default=[8192, 8192, 4096], metavar=("X", "Y", "Z"))
    parser.add_argument("--delay", type=float, default=0.0, help="milliseconds before each answer of the server")
    parser.add_argument("--levels", choices=("Automatic", "Finest"), default="Automatic", help="DSMLevelOfDetail")
    parser.add_argument("--pixels-per-sample", type=float, default=1.0, help="DSMPixelsPerSample")
    parser.add_argument("--medium", action="store_true", help="DSM Volume instead of isosurfaces")
    parser.add_argument("--frames", type=int, default=50, help="of the slow zoom")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as kept:
        os.environ["XDG_CACHE_HOME"] = kept
        simple.LoadPlugin(options.plugin, remote=False, ns=vars(simple))
        server = Server(options)
        try:
            measure(server, options)
        finally:
            server.process.stdin.close()
            server.process.wait(10)


main()
