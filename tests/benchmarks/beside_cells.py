# SPDX-License-Identifier: BSD-3-Clause
"""Times isosurfaces and volumes of unstructured grids: the DSM ray tracer beside ParaView's Contour and Volume, in turn
in one process.

    xvfb-run -a -s "-screen 0 1280x1024x24 -noreset" pvbatch beside_cells.py --plugin DSMRayTracer.so
        [--kinds tetrahedra,hexahedra] [--cells 100000,1000000] [--volumes 100000] [--mappers NAMES] [--threads 0]
        [--repeat 3]

Prints for each grid the seconds to the first picture of an isosurface, which makes bricks or the contour, and to that
of a new isovalue (the median); and for grids of at most --volumes cells those of a volume by each of ParaView's
mappers.
"""
import argparse
import os
import statistics
import time

import numpy
from measuring import take_picture, time_isovalues
from paraview import simple
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import VTK_HEXAHEDRON, VTK_TETRA, vtkCellArray, vtkUnstructuredGrid

# A cube of eight corners, x fastest, in tetrahedra around the diagonal from corner 0 to corner 7.
CUBE_TETRAHEDRA = ((0, 1, 3, 7), (0, 3, 2, 7), (0, 2, 6, 7), (0, 6, 4, 7), (0, 4, 5, 7), (0, 5, 1, 7))
CUBE_HEXAHEDRON = ((0, 1, 3, 2, 4, 5, 7, 6),)


def make_grid(kind, cells):
    """A bent cube of about so many cells, with the distance from a wavy sphere at its points."""
    corners, cell_type = ((CUBE_TETRAHEDRA, VTK_TETRA) if kind == "tetrahedra" else (CUBE_HEXAHEDRON, VTK_HEXAHEDRON))
    cubes = round((cells / len(corners)) ** (1 / 3))
    places = numpy.linspace(-1.0, 1.0, cubes + 1)
    z, y, x = (axis.ravel() for axis in numpy.meshgrid(places, places, places, indexing="ij"))
    points = numpy.stack([x + 0.1 * numpy.sin(2.0 * y), y + 0.1 * numpy.sin(2.0 * z), z + 0.1 * numpy.sin(2.0 * x)], 1)
    values = numpy.sqrt(x * x + y * y + z * z) + 0.05 * numpy.sin(9.0 * x) * numpy.sin(7.0 * y)
    row = cubes + 1
    low = numpy.arange(cubes)
    first = (low[None, None, :] + row * low[None, :, None] + row * row * low[:, None, None]).ravel()
    steps = numpy.array([(i & 1) + row * (i >> 1 & 1) + row * row * (i >> 2) for i in range(8)])
    numbers = (first[:, None, None] + steps[numpy.array(corners)][None]).reshape(-1)
    size = len(corners[0])
    connectivity = vtkCellArray()
    connectivity.SetData(numpy_to_vtkIdTypeArray(numpy.arange(0, len(numbers) + 1, size), deep=1),
                         numpy_to_vtkIdTypeArray(numbers, deep=1))
    grid = vtkUnstructuredGrid()
    place = vtkPoints()
    place.SetData(numpy_to_vtk(points.astype(numpy.float32), deep=1))
    grid.SetPoints(place)
    grid.SetCells(cell_type, connectivity)
    array = numpy_to_vtk(values.astype(numpy.float32), deep=1)
    array.SetName("distance")
    grid.GetPointData().SetScalars(array)
    return grid


def measure_surface(source, view, options):
    isovalues = [0.6 + 0.05 * (index % 5) for index in range(options.repeat + 1)]
    simple.ResetCamera(view)
    start = time.perf_counter()
    ours = simple.Show(source, view)
    ours.Representation = "DSM Ray Traced"
    ours.DSMShow = "Isosurfaces"
    ours.ColorArrayName = [None, ""]
    ours.DSMIsoArray = ["POINTS", "distance"]
    ours.DSMIsoValues = [isovalues[0]]
    ours.DSMThreads = options.threads
    simple.ResetCamera(view)
    take_picture(view)
    first = time.perf_counter() - start

    def set_ours(value):
        ours.DSMIsoValues = [value]

    traced = time_isovalues(view, set_ours, isovalues[1:])
    moving = []
    for _ in range(options.repeat):
        view.GetActiveCamera().Azimuth(5.0)
        moving.append(take_picture(view))
    ours.Visibility = 0
    start = time.perf_counter()
    contour = simple.Contour(Input=source, ContourBy=["POINTS", "distance"], Isosurfaces=[isovalues[0]])
    contour.ComputeScalars = 0
    theirs = simple.Show(contour, view)
    theirs.ColorArrayName = [None, ""]
    take_picture(view)
    first_contour = time.perf_counter() - start

    def set_theirs(value):
        contour.Isosurfaces = [value]

    contoured = time_isovalues(view, set_theirs, isovalues[1:])
    triangles = contour.GetDataInformation().GetNumberOfCells()
    simple.Delete(contour)
    print(f"  surface: first picture {first:.2f} s, Contour's {first_contour:.2f} s, "
          f"ratio {first / first_contour:.2f}; "
          f"new isovalue {traced:.3f} s, Contour's {contoured:.2f} s ({triangles} triangles), "
          f"ratio 1/{contoured / traced:.1f}; camera moved {statistics.median(moving):.3f} s", flush=True)
    return ours


def measure_volume(ours, source, view, options):
    ours.Visibility = 0
    display = simple.Show(source, view)
    simple.ColorBy(display, ("POINTS", "distance"))
    opacity = simple.GetOpacityTransferFunction("distance")
    low, high = source.GetPointDataInformation().GetArray("distance").GetRange(0)
    for name, nodes in (("fog", ((0.0, 0.02), (1.0, 0.02))), ("ramp", ((0.0, 0.0), (1.0, 0.1))),
                        ("shell", ((0.0, 0.0), (0.45, 0.0), (0.5, 0.8), (0.55, 0.0), (1.0, 0.0)))):
        opacity.Points = [n for place, value in nodes for n in (low + place * (high - low), value, 0.5, 0.0)]
        display.Representation = "DSM Volume"
        display.DSMThreads = options.threads
        take_picture(view)
        view.GetActiveCamera().Azimuth(5.0)
        mine = take_picture(view)
        text = f"  {name}: {mine:.3f} s"
        display.Representation = "Volume"
        for mapper in options.mappers.split(","):
            display.SelectMapper = mapper
            take_picture(view)
            view.GetActiveCamera().Azimuth(-5.0)
            peer = take_picture(view)
            text += f"; {mapper} {peer:.2f} s, {peer / mine:.1f} times"
        print(text, flush=True)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--plugin", required=True, type=os.path.abspath)
    parser.add_argument("--kinds", default="tetrahedra,hexahedra")
    parser.add_argument("--cells", default="100000,1000000")
    parser.add_argument("--volumes", type=int, default=100000)
    parser.add_argument("--mappers", default="Z sweep,Bunyk ray cast,Projected tetra")
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--threads", type=int, default=0)
    options = parser.parse_args()
    simple.LoadPlugin(options.plugin, remote=False, ns=vars(simple))
    for kind in options.kinds.split(","):
        for cells in map(int, options.cells.split(",")):
            view = simple.CreateRenderView()
            view.ViewSize = [512, 512]
            view.OrientationAxesVisibility = 0
            grid = make_grid(kind, cells)
            source = simple.PVTrivialProducer()
            source.GetClientSideObject().SetOutput(grid)
            source.UpdatePipeline()
            source.GetDataInformation()  # ranges of arrays, for which else the first of both waits
            print(f"{kind}, {grid.GetNumberOfCells()} cells, load {os.getloadavg()[0]:.1f}:", flush=True)
            ours = measure_surface(source, view, options)
            if cells <= options.volumes:
                measure_volume(ours, source, view, options)
            simple.Delete(source)
            simple.Delete(view)


main()
