# SPDX-License-Identifier: BSD-3-Clause
"""What the scripts that make the documents' pictures share."""

from paraview import simple
from pixels import write  # for those who import this
from vtkmodules.util.numpy_support import vtk_to_numpy


def draw(view):
    """Rows, the lowest first, of columns of red, green, blue."""
    simple.Render(view)
    image = view.SMProxy.CaptureWindow(1)
    width, height, _ = image.GetDimensions()
    return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, -1)[:, :, :3]
