# SPDX-License-Identifier: BSD-3-Clause
"""Ray traces a mesh and draws it as ParaView's own Surface, from the same cameras.

The two must cover the same pixels (all but 0.5 % of those that either covers), at the same depth,
in the same shades. Run by pvbatch:
    compare_with_surface.py --plugin DSMRayTracer.so --case FILE [--data DIR] [--output DIR]
Exits with 77 (skipped) when the file is not there.
"""
import argparse
import os
import sys

import numpy
from paraview import simple
from paraview.vtk.util import numpy_support

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from view_tools import SIZE, SKIPPED, create_view, get_distances

# From outside at three angles, and close by.
CAMERAS = [((0.3, 0.5, 1.0), 1.0), ((-1.0, 0.2, 0.1), 1.0), ((0.1, -0.9, -0.4), 0.5)]


def place_camera(view, bounds, direction, distance):
    low, high = numpy.array(bounds[0::2]), numpy.array(bounds[1::2])
    size = numpy.linalg.norm(high - low)
    direction = numpy.array(direction) / numpy.linalg.norm(direction)
    camera = view.GetActiveCamera()
    camera.SetFocalPoint(*(low + high) / 2)
    camera.SetPosition(*((low + high) / 2 + 2.0 * distance * size * direction))
    camera.SetViewUp(0.0, 1.0, 0.1)
    view.GetRenderer().ResetCameraClippingRange(bounds)


def grab(view, picture):
    """Colours, and eye-space distances (inf where there is nothing)."""
    simple.Render(view)
    image = view.SMProxy.CaptureWindow(1)
    colors = numpy_support.vtk_to_numpy(image.GetPointData().GetScalars())
    colors = colors.reshape(SIZE, SIZE, -1)[:, :, :3].astype(int)
    distance = get_distances(view)
    if picture:
        simple.SaveScreenshot(picture, view)
    return colors, distance


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--plugin", required=True, type=os.path.abspath)
    parser.add_argument("--case", required=True)
    parser.add_argument("--data", default=os.environ.get("DSM_TEST_DATA", ""))
    parser.add_argument("--output", default="")
    arguments = parser.parse_args()
    path = os.path.join(arguments.data, arguments.case)
    if not os.path.exists(path):
        print(f"skipped: {path} is not there")
        sys.exit(SKIPPED)
    simple.LoadPlugin(arguments.plugin, remote=False, ns=vars(simple))
    view = create_view([0.0, 0.0, 0.2])
    source = simple.OpenDataFile(path)
    source.UpdatePipeline()
    bounds = source.GetDataInformation().GetBounds()
    size = numpy.linalg.norm([bounds[1] - bounds[0], bounds[3] - bounds[2], bounds[5] - bounds[4]])
    display = simple.Show(source, view)
    display.ColorArrayName = [None, ""]
    # The first picture of a view places the camera; from then on it stays where it is put.
    simple.Render(view)
    name = os.path.splitext(arguments.case)[0]
    failures = 0
    for interpolation in ("Gouraud", "Flat"):
        display.Interpolation = interpolation
        for number, (direction, distance) in enumerate(CAMERAS):
            pictures = []
            for way in ("DSM Ray Traced", "Surface"):
                display.Representation = way
                place_camera(view, bounds, direction, distance)
                file = f"{name}_{interpolation}_{number}_{way.split()[0]}.png"
                pictures.append(
                    grab(view, os.path.join(arguments.output, file) if arguments.output else ""))
            (colors, traced), (expected, triangles) = pictures
            either = numpy.isfinite(traced) | numpy.isfinite(triangles)
            both = numpy.isfinite(traced) & numpy.isfinite(triangles)
            assert both.sum() > 1000, "the surface hardly shows"
            only_one = (either & ~both).sum() / either.sum()
            apart = (abs(traced[both] - triangles[both]) > 2e-3 * size).sum() / both.sum()
            shades = abs(colors - expected).mean(axis=2)[both].mean()
            good = only_one < 0.005 and apart < 0.005 and shades < 3.0
            failures += not good
            print(f"{'ok' if good else 'FAILED'}: {name} {interpolation} {number}: covered by one "
                  f"only {100 * only_one:.3f} %, apart {100 * apart:.3f} %, shades differ by "
                  f"{shades:.2f} of 255", flush=True)
    simple.Delete(view)
    sys.exit(1 if failures else 0)


main()
