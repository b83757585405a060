# SPDX-License-Identifier: BSD-3-Clause
"""Makes first_look.png, two datasets as Contour shows them and as the application shows them ray traced:
    xvfb-run -a -s "-noreset -screen 0 1280x1024x24" pvbatch first_look.py PLUGIN FOLDER"""

import os
import sys

import numpy
from paraview import simple

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from pictures import draw, write

PLUGIN, FOLDER = sys.argv[1:]

simple.LoadPlugin(os.path.abspath(PLUGIN), remote=False, ns=vars(simple))
rows = []
for source, array, isovalue in (
    (simple.Wavelet(), "RTData", 157.0),
    (simple.DSMSampleVolume(Dimensions=[128] * 3), "f", 0.5),
):
    contour = simple.Contour(Input=source, ContourBy=["POINTS", array], Isosurfaces=[isovalue])
    view = simple.CreateRenderView(ViewSize=[420, 380])
    view.OrientationAxesVisibility = 0
    surface = simple.Show(contour, view)
    surface.Representation = "Surface"
    surface.ColorArrayName = [None, ""]
    view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = [0.6, 0.5, 1.0], [0, 0, 0], [0, 1, 0]
    simple.ResetCamera(view)
    view.GetActiveCamera().Zoom(1.2)
    row = [draw(view)]
    simple.Hide(contour, view)
    traced = simple.Show(source, view)
    traced.Representation = "DSM Ray Traced"
    traced.ColorArrayName = [None, ""]
    traced.DSMIsoArray = ["POINTS", array]
    traced.DSMIsoValues = [isovalue]
    traced.DSMLook = "With depth"
    row.append(draw(view))
    rows.append(numpy.hstack(row))
write(os.path.join(FOLDER, "first_look.png"), numpy.hstack(rows))
