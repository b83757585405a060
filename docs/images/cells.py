# SPDX-License-Identifier: BSD-3-Clause
"""Makes cells.png: an isosurface, a volume and slices of a curvilinear grid, of tetrahedra, and of cells of many kinds:
    xvfb-run -a -s "-noreset -screen 0 1280x1024x24" pvbatch cells.py PLUGIN FOLDER"""

import os
import sys

import numpy
from paraview import simple

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from pictures import draw, write

PLUGIN, FOLDER = sys.argv[1:]

# The points of a box move to a shell: longitude, latitude and height.
SHELL = """
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
image, grid = self.GetInputDataObject(0, 0), self.GetOutputDataObject(0)
grid.SetExtent(image.GetExtent())
x, y, z = np.array([image.GetPoint(point) for point in range(image.GetNumberOfPoints())]).T / 24.0
longitude, latitude, height = np.pi * 0.8 * x, np.pi * 0.45 * y, 1.5 + 0.5 * z
flat = np.cos(latitude)
places = height * np.array([flat * np.cos(longitude), flat * np.sin(longitude), np.sin(latitude)])
points = vtkPoints()
points.SetData(numpy_to_vtk(np.ascontiguousarray(places.T), deep=True))
grid.SetPoints(points)
grid.GetPointData().ShallowCopy(image.GetPointData())
"""

simple.LoadPlugin(os.path.abspath(PLUGIN), remote=False, ns=vars(simple))
view = simple.CreateRenderView(ViewSize=[360, 330])
view.OrientationAxesVisibility = 0
wavelet = simple.Wavelet(WholeExtent=[-24, 24, -24, 24, -24, 24])
shell = simple.ProgrammableFilter(Input=wavelet, OutputDataSetType="vtkStructuredGrid", Script=SHELL)
tetrahedra = simple.Tetrahedralize(Input=shell)
pictures = []
for shown, representation in ((shell, "DSM Ray Traced"), (shell, "DSM Volume"), (tetrahedra, "DSM Slices")):
    display = simple.Show(shown, view)
    simple.ColorBy(display, ("POINTS", "RTData"))
    display.SetRepresentationType(representation)
    display.SetScalarBarVisibility(view, False)
    if representation == "DSM Ray Traced":
        display.DSMShow, display.DSMIsoArray, display.DSMIsoValues = "Isosurfaces", ["POINTS", "RTData"], [140.0, 210.0]
        display.DSMShadows = 1
        simple.GetColorTransferFunction("RTData").RescaleTransferFunction(60.0, 260.0)
        opacity = simple.GetOpacityTransferFunction("RTData")
        opacity.Points = [60.0, 0.0, 0.5, 0.0, 180.0, 0.02, 0.5, 0.0, 260.0, 0.5, 0.5, 0.0]
        simple.ResetCamera(view)
        camera = view.GetActiveCamera()
        camera.Azimuth(60.0)
        camera.Elevation(20.0)
        simple.ResetCamera(view)
        camera.Dolly(1.3)
    pictures.append(draw(view))
    simple.Hide(shown, view)
write(os.path.join(FOLDER, "cells.png"), numpy.hstack(pictures))
