# SPDX-License-Identifier: BSD-3-Clause
"""Ray traces isosurfaces and draws vtkFlyingEdges3D's triangles from the same cameras.

The two must cover the same pixels (all but 0.5 %), at the same depth (within one cell for 99.9 % of
the pixels that both cover). Run by pvbatch:
    compare_with_flying_edges.py --plugin DSMRayTracer.so --case NAME [--data DIR] [--output DIR]
Exits with 77 (skipped) when a case needs a data file that is not there.
"""
import argparse
import os
import sys

import numpy
from paraview import servermanager, simple
from vtkmodules.vtkFiltersCore import vtkFlyingEdges3D
from vtkmodules.vtkImagingCore import vtkImageCast, vtkImageResample
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import vtkWindowToImageFilter

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from view_tools import SKIPPED, create_view, get_distances

# Name -> (file or sample volume, array, isovalues[, refinement]). Where a cell covers many pixels,
# triangles are no good picture of the trilinear surface; there the volume is first interpolated
# linearly on a finer grid.
CASES = {
    "sphere": ({"Kind": 0, "Dimensions": [128, 128, 128]}, "f", [0.5]),
    "sphere_uchar": ({"Kind": 0, "Dimensions": [64, 80, 56], "ScalarType": 3}, "f", [32.0], 5),
    "mixing_layer": ({"Kind": 1, "Dimensions": [80, 80, 80]}, "entropy", [100.0], 5),
    "teapot": ("boston_teapot_ct_256x256x178_uint8.vti", "density", [40.0, 39.5]),
    "cranium": ("cranium_ct_256x256x108_int16.vti", "HU", [300.0], 2),
    "heptane": ("csafe_heptane_302x302x302_uint8.vti", "heptane", [60.0, 60.5], 2),
    "isabel": ("isabel_t30_125x125x25_float64.vti", "velocityMag", [25.0], 4),
    "carotid": ("carotid_76x49x45_float32.vtk", "scalars", [240.0], 4),
}
# From outside at three angles, and close by.
CAMERAS = [((0.3, 0.5, 1.0), 1.0), ((-1.0, 0.2, 0.1), 1.0), ((0.1, -0.9, -0.4), 0.5)]


def open_input(case, data):
    source, array, isovalues, refinement = (*CASES[case], 1)[:4]
    if isinstance(source, dict):
        return simple.DSMSampleVolume(**source), array, isovalues, refinement
    path = os.path.join(data, source)
    if not data or not os.path.exists(path):
        print(f"skipped: {source} is not in the data folder ({data or 'DSM_TEST_DATA'})")
        sys.exit(SKIPPED)
    reader = simple.OpenDataFile(path)
    reader.UpdatePipeline()
    if reader.GetDataInformation().GetNumberOfPoints() == 0:
        # Debian's libexpat 2.5.0-1+deb12u2 stops VTK's XML readers at data that are appended raw.
        print(f"skipped: this ParaView cannot read {source}")
        sys.exit(SKIPPED)
    return reader, array, isovalues, refinement


def extract_triangles(image, array, isovalue, refinement):
    image.GetPointData().SetActiveScalars(array)
    cast = vtkImageCast()
    cast.SetInputData(image)
    cast.SetOutputScalarTypeToFloat()
    finer = vtkImageResample()
    finer.SetInputConnection(cast.GetOutputPort())
    finer.SetMagnificationFactors(refinement, refinement, refinement)
    finer.SetInterpolationModeToLinear()
    edges = vtkFlyingEdges3D()
    if refinement > 1:
        edges.SetInputConnection(finer.GetOutputPort())
    else:
        edges.SetInputData(image)
    edges.SetValue(0, isovalue)
    edges.Update()
    return edges.GetOutput()


def place_camera(view, bounds, direction, distance):
    center = numpy.array([bounds[0] + bounds[1], bounds[2] + bounds[3], bounds[4] + bounds[5]]) / 2
    size = numpy.linalg.norm([bounds[1] - bounds[0], bounds[3] - bounds[2], bounds[5] - bounds[4]])
    direction = numpy.array(direction) / numpy.linalg.norm(direction)
    camera = view.GetActiveCamera()
    camera.SetFocalPoint(*center)
    camera.SetPosition(*(center + 2.0 * distance * size * direction))
    camera.SetViewUp(0.0, 0.1, 1.0)
    camera.SetClippingRange(0.05 * size, 4.0 * size)
    view.GetRenderer().ResetCameraClippingRange(bounds)


def grab(view, picture):
    """Renders; returns eye-space distances (inf where there is nothing) and writes the picture."""
    simple.Render(view)
    distance = get_distances(view)
    if picture:
        shot = vtkWindowToImageFilter()
        shot.SetInput(view.GetRenderWindow())
        shot.ReadFrontBufferOff()
        writer = vtkPNGWriter()
        writer.SetInputConnection(shot.GetOutputPort())
        writer.SetFileName(picture)
        writer.Write()
    return distance


def compare(traced, triangles, cell):
    """Part of the covered pixels that only one has, and of the common ones that are a cell apart."""
    covered = numpy.isfinite(traced) | numpy.isfinite(triangles)
    both = numpy.isfinite(traced) & numpy.isfinite(triangles)
    assert both.sum() > 1000, "the surfaces hardly show"
    only_one = (covered & ~both).sum() / covered.sum()
    apart = (numpy.abs(traced[both] - triangles[both]) > cell).sum() / both.sum()
    return only_one, apart


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--plugin", required=True, type=os.path.abspath)
    parser.add_argument("--case", required=True, choices=sorted(CASES))
    parser.add_argument("--data", default=os.environ.get("DSM_TEST_DATA", ""))
    parser.add_argument("--output", default="")
    arguments = parser.parse_args()
    simple.LoadPlugin(arguments.plugin, remote=False, ns=vars(simple))

    source, array, isovalues, refinement = open_input(arguments.case, arguments.data)
    source.UpdatePipeline()
    image = servermanager.Fetch(source)
    bounds = source.GetDataInformation().GetBounds()
    cell = max(image.GetSpacing())

    view = create_view([0.0, 0.0, 0.0])
    ours = simple.Show(source, view)
    ours.Representation = "DSM Ray Traced"
    ours.ColorArrayName = [None, ""]
    ours.DSMIsoArray = array
    # The first picture of a view places the camera; from then on it stays where it is put.
    simple.Render(view)

    failures = 0
    for isovalue in isovalues:
        producer = simple.TrivialProducer()
        producer.GetClientSideObject().SetOutput(
            extract_triangles(image, array, isovalue, refinement))
        theirs = simple.Show(producer, view, "GeometryRepresentation")
        theirs.Representation = "Surface"
        theirs.ColorArrayName = [None, ""]
        ours.DSMIsoValues = [isovalue]
        for number, (direction, distance) in enumerate(CAMERAS):
            stem = f"{arguments.case}_{isovalue:g}_{number}"
            pictures = [os.path.join(arguments.output, f"{stem}_{way}.png") if arguments.output
                        else "" for way in ("traced", "triangles")]
            place_camera(view, bounds, direction, distance)
            ours.Visibility, theirs.Visibility = 1, 0
            traced = grab(view, pictures[0])
            ours.Visibility, theirs.Visibility = 0, 1
            place_camera(view, bounds, direction, distance)
            triangles = grab(view, pictures[1])
            only_one, apart = compare(traced, triangles, cell)
            good = only_one < 0.005 and apart < 0.001
            failures += not good
            print(f"{'ok' if good else 'FAILED'}: {stem}: covered by one only {100 * only_one:.3f} %, "
                  f"more than a cell apart {100 * apart:.3f} %")
        simple.Delete(producer)
    simple.Delete(view)
    sys.exit(1 if failures else 0)


main()
