# SPDX-License-Identifier: BSD-3-Clause
"""Uses the ray tracer as somebody does who has much time: opens, shows, changes and deletes datasets in
three views, or, with --toggle, draws one scene with all options changing at random. Fails when an
error is reported, when OpenGL reports one, or when the ranks keep more and more memory. A hang ends
with the time limit that the caller sets.

    mpirun -np 4 pvbatch tests/paraview/run.py ../load/use_for_long.py PLUGIN OUTPUT [OPTIONS]
    --seconds=S   how long; 1800 if left out. --datasets=N at a time, 20 if left out
    --toggle      options instead of datasets; --frames=N of them, 500 if left out
    --seed=N      of the random numbers; printed, so that a run can be repeated

What the ranks keep is read again and again with the datasets closed, or the options as they were: what
is shown then is the same. Buffers of OpenGL come and go by the tens of MiB, for one view or two, so the
least of the second half of the readings is compared with the least of the first. ParaView keeps about
14 KiB on rank 0 for each dataset that was shown, also as a Surface. All readings are printed, in KiB of
each rank."""

import argparse
import ctypes
import gc
import random
import time

from dsm_testing import *

VIEWS = 3
# What ParaView itself keeps for each proxy, and OpenGL for a view. What grows all the time grows by twice as much
# until it is seen, as halves are compared.
KIBIBYTES_PER_RANK = 16 * 1024
FEWEST_READINGS = 9


def parse_arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("--seconds", type=float, default=1800)
    parser.add_argument("--datasets", type=int, default=20)
    parser.add_argument("--toggle", action="store_true")
    parser.add_argument("--frames", type=int, default=500)
    parser.add_argument("--seed", type=int, default=1)
    return parser.parse_args(sys.argv[3:])


# What was allocated and not freed; resident memory also has pages that the allocator keeps for later.
MEMORY = """
import ctypes
from vtkmodules.vtkCommonCore import vtkIntArray, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray
NAMES = 'arena ordblks smblks hblks hblkhd usmblks fsmblks uordblks fordblks keepcost'
class Allocated(ctypes.Structure):
    _fields_ = [(name, ctypes.c_size_t) for name in NAMES.split()]
mallinfo = ctypes.CDLL('libc.so.6').mallinfo2
mallinfo.restype = Allocated
allocated = mallinfo()
with open('/proc/self/status') as status:
    shared = next(int(line.split()[1]) for line in status if line.startswith('RssShmem:'))
array = vtkIntArray()
array.SetName('KiB')
array.InsertNextValue((allocated.uordblks + allocated.hblkhd) // 1024 + shared)
points = vtkPoints()
points.InsertNextPoint(0.0, 0.0, 0.0)
cells = vtkCellArray()
cells.InsertNextCell(1, [0])
self.GetOutputDataObject(0).SetPoints(points)
self.GetOutputDataObject(0).SetVerts(cells)
self.GetOutputDataObject(0).GetPointData().AddArray(array)
"""


class Memory:
    """What all ranks keep."""

    def __init__(self):
        self.source = simple.ProgrammableSource(OutputDataSetType="vtkPolyData")
        self.start = time.monotonic()
        self.readings = []

    def read(self):
        """ParaView joins what the ranks make."""
        gc.collect()
        self.source.Script = MEMORY + f"# {len(self.readings)}\n"
        column = servermanager.Fetch(self.source).GetPointData().GetArray("KiB")
        values = [column.GetValue(row) for row in range(column.GetNumberOfTuples())]
        text = " ".join(str(value) for value in values)
        # Not with print, which ends in the window that collects the messages.
        line = f"{time.monotonic() - self.start:6.0f} s, KiB of the ranks: {text}"
        sys.__stdout__.write(line + "\n")
        sys.__stdout__.flush()
        self.readings.append(values)

    def check(self):
        """The first reading, which finds caches still empty, does not count."""
        readings = self.readings[1:]
        half = len(readings) // 2
        check(half > 0, f"memory was read {len(self.readings)} times")
        for rank in range(len(readings[0])):
            early = min(reading[rank] for reading in readings[:half])
            late = min(reading[rank] for reading in readings[half:])
            check(late - early < KIBIBYTES_PER_RANK, f"rank {rank} keeps {early} KiB early, {late} KiB late")


OPTIONS = {
    "DSMShadows": (0, 1),
    "DSMLightRadius": (0.0, 0.05),
    "DSMAmbientOcclusionSamples": (0, 1, 2),
    "DSMAmbientOcclusionDistance": (0.0, 1.0),
    "DSMReflectivity": (0.0, 0.4),
    "DSMMaxBounces": (1, 3),
    "DSMSamplesPerPixel": (1, 1, 2, 4),
    "DSMDebugView": ("Off", "Off", "Owner of the data", "Normal", "Depth"),
    "DSMMemoryOrganization": ("Automatic", "Replicated", "Object based", "Page based"),
    "DSMHostSharing": (0, 1),
    "DSMMemory": (0, 256),
    "DSMCacheSize": (1, 64),
    "DSMThreads": (0, 1, 3),
    "Opacity": (1.0, 1.0, 0.5),
}
VOLUME_OPTIONS = {"DSMIsoValues": ([0.3], [0.5], [0.3, 0.7], [])}
MESH_OPTIONS = {"DSMLineRadius": (0.0, 0.02), "DSMPointRadius": (0.0, 0.03)}


def toggle_one(random_numbers, display, own_options):
    choices = {**OPTIONS, **own_options}
    name = random_numbers.choice(sorted(choices))
    setattr(display, name, random_numbers.choice(choices[name]))


def move_camera(random_numbers, view):
    place_camera(view, [random_numbers.uniform(-1, 1) for _ in range(2)] + [1.0])


def create_sample(random_numbers):
    size = random_numbers.choice((12, 20, 31))
    return simple.DSMSampleVolume(Dimensions=[size] * 3), "f", [0.5]


def create_image(random_numbers):
    source = simple.Wavelet()
    source.WholeExtent = [-random_numbers.choice((6, 10)), 10, -10, 10, -10, 10]
    return source, "RTData", [130.0, 200.0]


def create_surface(random_numbers):
    kind = random_numbers.choice(("Sphere", "Cone", "Superquadric", "Line"))
    return getattr(simple, kind)(), None, None


KINDS = (create_sample, create_image, create_surface)


class Dataset:
    def __init__(self, random_numbers, views):
        self.source, array, isovalues = random_numbers.choice(KINDS)(random_numbers)
        self.is_volume = array is not None
        self.isovalues = isovalues
        self.displays = []
        for view in random_numbers.sample(views, random_numbers.choice((1, 1, 2, VIEWS))):
            display = simple.Show(self.source, view)
            display.Representation = REPRESENTATION
            if self.is_volume:
                display.DSMIsoArray = ["POINTS", array]
                display.DSMIsoValues = isovalues
            transform(display, [random_numbers.uniform(-2, 2) for _ in range(3)])
            self.displays.append((view, display))

    def change(self, random_numbers):
        view, display = random_numbers.choice(self.displays)
        action = random_numbers.randrange(6)
        if action == 0:
            simple.Hide(self.source, view)
        elif action == 1:
            simple.Show(self.source, view)
        elif action == 2:
            display.Representation = random_numbers.choice(("Outline", REPRESENTATION, REPRESENTATION))
        elif action == 3 and self.is_volume:
            display.DSMIsoValues = [value + random_numbers.uniform(-0.1, 0.1) for value in self.isovalues]
        elif action == 4:
            self.source.UpdatePipeline()
            arrays = list(self.source.PointData.keys())
            if arrays:
                simple.ColorBy(display, ("POINTS", random_numbers.choice(arrays)))
        else:
            toggle_one(random_numbers, display, {} if self.is_volume else MESH_OPTIONS)

    def delete(self):
        simple.Delete(self.source)


def use(arguments, random_numbers, memory):
    views = [create_view(240, 180) for _ in range(VIEWS)]
    datasets, frames, opened, rounds = [], 0, 0, 0
    start = time.monotonic()
    until_read = min(arguments.seconds / 12, 60.0)

    def read_memory():
        while datasets:
            datasets.pop().delete()
        for view in views:
            simple.Render(view)
        memory.read()

    # Some rounds, also where they take longer than that.
    while time.monotonic() < start + arguments.seconds or len(memory.readings) < FEWEST_READINGS:
        while len(datasets) < arguments.datasets:
            datasets.append(Dataset(random_numbers, views))
            opened += 1
        for dataset in random_numbers.sample(datasets, min(6, arguments.datasets)):
            dataset.change(random_numbers)
        for view in views:
            move_camera(random_numbers, view)
            simple.Render(view)
            frames += 1
            check_open_gl(view)
        for _ in range(min(random_numbers.choice((1, 2, 5)), len(datasets))):
            datasets.pop(random_numbers.randrange(len(datasets))).delete()
        rounds += 1
        if rounds % 2 == 0 and time.monotonic() > start + until_read * len(memory.readings):
            read_memory()
    memory.check()
    check(opened > arguments.datasets, f"{frames} frames with {opened} datasets")


OPEN_GL = ctypes.CDLL("libGL.so.1")


def check_open_gl(view):
    """On rank 0; the other ranks draw with the same calls."""
    view.GetRenderWindow().MakeCurrent()
    error = OPEN_GL.glGetError()
    if error:
        raise AssertionError(f"OpenGL reports error {error:#x}")


def toggle(arguments, random_numbers, memory):
    view = create_view(200, 150)
    volume = show(simple.DSMSampleVolume(Dimensions=[32] * 3), view, [0.5], "f")
    surface = simple.Show(simple.Sphere(Center=[1.0, 0.6, 0.3], Radius=0.5), view)
    surface.Representation = REPRESENTATION
    lines = simple.Show(simple.Line(Point1=[-1.0, -1.0, 1.0], Point2=[1.0, 1.0, 1.0]), view)
    lines.Representation = REPRESENTATION
    displays = ((volume, VOLUME_OPTIONS), (surface, MESH_OPTIONS), (lines, MESH_OPTIONS))

    def read_memory():
        for display, own_options in displays:
            for name, choices in {**OPTIONS, **own_options}.items():
                setattr(display, name, choices[0])
        simple.Render(view)
        memory.read()

    for frame in range(arguments.frames):
        for _ in range(random_numbers.choice((1, 1, 2, 4))):
            toggle_one(random_numbers, *random_numbers.choice(displays))
        if frame % 10 == 0:
            move_camera(random_numbers, view)
        simple.Render(view)
        check_open_gl(view)
        if frame % max(1, arguments.frames // 10) == 0:
            read_memory()
    memory.check()
    for display, _ in displays:
        display.DSMDebugView = "Off"
        display.Opacity = 1.0
    volume.DSMIsoValues = [0.5]
    check(get_covered(render(view)).mean() > 0.02, f"after {arguments.frames} frames there is a picture")


def main():
    arguments = parse_arguments()
    load_plugin()
    random_numbers = random.Random(arguments.seed)
    memory = Memory()
    with Messages() as messages:
        (toggle if arguments.toggle else use)(arguments, random_numbers, memory)
        said = messages.text
    print(said, flush=True)
    check("ERR" not in said and "rror" not in said, f"no error is reported (seed {arguments.seed})")


main()
