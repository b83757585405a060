# SPDX-License-Identifier: BSD-3-Clause
"""Builds an example against the installed package, as its user would, runs it, and looks at the picture.

usage: run_example.py EXAMPLE CMAKE PREFIX BUILD [MPIRUN ...]
EXAMPLE is one of the functions below; MPIRUN starts ranks when -np N is appended.
"""
import os
import shutil
import subprocess
import sys

from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader

SKIPPED = 77
PROJECT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
EXAMPLE, CMAKE, PREFIX, BUILD = sys.argv[1:5]
MPIRUN = sys.argv[5:]


def build():
    """The folder that the example was built in, from nothing."""
    shutil.rmtree(BUILD, ignore_errors=True)
    source = os.path.join(PROJECT, "examples", EXAMPLE)
    configured = subprocess.run(
        [CMAKE, "-S", source, "-B", BUILD, "-G", "Ninja", "-Wno-dev", "-DCMAKE_PREFIX_PATH=" + PREFIX],
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if configured.returncode != 0:
        if "RenderingParallel" in configured.stdout:
            print("skipped: this VTK has no module RenderingParallel")
            sys.exit(SKIPPED)
        print(configured.stdout)
        sys.exit("the example could not be configured")
    subprocess.run([CMAKE, "--build", BUILD], check=True)
    return BUILD


def read(name):
    """The pixels of a PNG file in the build folder, from the top row down."""
    reader = vtkPNGReader()
    reader.SetFileName(os.path.join(BUILD, name))
    reader.Update()
    image = reader.GetOutput()
    width, height, _ = image.GetDimensions()
    pixels = vtk_to_numpy(image.GetPointData().GetScalars())
    return pixels.reshape(height, width, -1)[::-1].astype(int)


def check(condition, text):
    if not condition:
        sys.exit("FAILED: " + text)


def is_surface(pixels):
    """Where the isosurface's colour is: red over green over blue, and lit."""
    return (pixels[..., 0] > pixels[..., 1] + 10) & (pixels[..., 1] > pixels[..., 2] + 10)


def check_isosurface(pixels, share):
    """The centre is covered, the corners are not, and as many pixels are as ought to be."""
    height, width, _ = pixels.shape
    surface = is_surface(pixels)
    check(surface[height // 2, width // 2], f"the centre is {pixels[height // 2, width // 2]}")
    check(not surface[0, 0] and not surface[-1, -1], "a corner is covered")
    low, high = share
    check(low < surface.mean() < high, f"the isosurface covers {surface.mean():.3f} of the picture")


def draw_with_floor(command):
    """The picture of the examples that have a floor with a shadow on it."""
    subprocess.run(command + [os.path.join(BUILD, "picture.png")], check=True)
    pixels = read("picture.png")
    check(pixels.shape[:2] == (450, 600), f"the size is {pixels.shape}")
    check_isosurface(pixels, (0.05, 0.3))
    grey = (abs(pixels[..., 0] - pixels[..., 1]) < 3) & (abs(pixels[..., 1] - pixels[..., 2]) < 3)
    check((grey & (pixels[..., 0] > 100)).mean() > 0.05, "the floor is not lit")
    check((grey & (pixels[..., 0] < 20)).mean() > 0.005, "nothing casts a shadow on the floor")
    return pixels


def cpp():
    draw_with_floor([os.path.join(build(), "isosurface")])


def python():
    """With the ranks of MPI, too; the picture is that of the C++ example."""
    build()
    script = os.path.join(PROJECT, "examples", "python", "isosurface.py")
    folder = subprocess.run(
        ["find", PREFIX, "-name", "dsmraytracer", "-path", "*-packages/*"], stdout=subprocess.PIPE, text=True,
        check=True)
    os.environ["PYTHONPATH"] = os.path.dirname(folder.stdout.split()[0])
    alone = draw_with_floor([sys.executable, script])
    check((read("isosurface.png") == alone).all(), "the target of CMake draws something else")
    draw_without_display(os.path.join(PROJECT, "examples", "python", "without_display.py"))
    if MPIRUN:
        ranks = draw_with_floor(MPIRUN + ["-np", "2", sys.executable, script])
        check((ranks == alone).all(), "two ranks draw another picture than one process")


def draw_without_display(script):
    """One process and two ranks draw the same, and need neither a display nor OpenGL."""
    environment = {name: value for name, value in os.environ.items() if "DISPLAY" not in name}
    pictures = []
    for start in [[]] + ([MPIRUN + ["-np", "2"]] if MPIRUN else []):
        subprocess.run(start + [sys.executable, script, os.path.join(BUILD, "picture.png")],
                       env=environment, check=True)
        pictures.append(read("picture.png"))
    check_isosurface(pictures[0][..., :3], (0.05, 0.3))
    check((pictures[0] == pictures[-1]).all(), "two ranks draw another picture without a display")


def draw_with_ranks(program):
    pictures = []
    for ranks in (1, 2):
        name = f"ranks{ranks}.png"
        subprocess.run(MPIRUN + ["-np", str(ranks), os.path.join(BUILD, program), os.path.join(BUILD, name)],
                       check=True)
        pictures.append(read(name))
        check_isosurface(pictures[-1], (0.15, 0.4))
    check((pictures[0] == pictures[1]).all(), "two ranks draw another picture than one")
    return pictures[0]


def mpi():
    build()
    draw_with_ranks("ranks")


def mpi_window():
    build()
    pixels = draw_with_ranks("window")
    white = (pixels.min(axis=-1) > 150) & (pixels.max(axis=-1) - pixels.min(axis=-1) < 3)
    check(white.mean() > 0.02, "the ball of the last rank is missing")


{"cpp": cpp, "python": python, "mpi": mpi, "mpi_window": mpi_window}[EXAMPLE]()
