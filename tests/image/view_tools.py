# SPDX-License-Identifier: BSD-3-Clause
"""What the scripts that compare pictures share."""

import numpy
from paraview import simple
from paraview.vtk.util import numpy_support
from vtkmodules.vtkCommonCore import vtkFloatArray

SIZE = 512
SKIPPED = 77


def create_view(background):
    view = simple.CreateRenderView()
    view.ViewSize = [SIZE, SIZE]
    view.Background = background
    view.UseColorPaletteForBackground = 0
    view.OrientationAxesVisibility = 0
    view.UseFXAA = 0
    view.GetRenderWindow().SetMultiSamples(0)
    return view


def get_distances(view):
    """From the eye along the view, of what was rendered last; inf where there is nothing."""
    depths = vtkFloatArray()
    view.GetRenderWindow().GetZbufferData(0, 0, SIZE - 1, SIZE - 1, depths)
    depth = numpy_support.vtk_to_numpy(depths).astype(float).reshape(SIZE, SIZE)
    near, far = view.GetActiveCamera().GetClippingRange()
    with numpy.errstate(divide="ignore"):
        distance = near * far / (far - depth * (far - near))
    distance[depth >= 1.0] = numpy.inf
    return distance
