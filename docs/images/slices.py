# SPDX-License-Identifier: BSD-3-Clause
"""Makes slices.png: slices of a volume, and the faces that a clipping plane cuts out of an isosurface and a volume:
    xvfb-run -a -s "-noreset -screen 0 1280x1024x24" pvbatch slices.py PLUGIN FOLDER"""

import os
import sys

import numpy
from paraview import simple

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from pictures import draw, write

PLUGIN, FOLDER = sys.argv[1:]

simple.LoadPlugin(os.path.abspath(PLUGIN), remote=False, ns=vars(simple))
view = simple.CreateRenderView(ViewSize=[360, 330])
view.OrientationAxesVisibility = 0
volume = simple.DSMSampleVolume(Dimensions=[128] * 3)
display = simple.Show(volume, view)
display.SetRepresentationType("DSM Slices")
simple.Render(view)
colors = simple.GetColorTransferFunction("f")
colors.ApplyPreset("Cool to Warm (Extended)")
colors.RescaleTransferFunction(0.0, 1.3)
display.DSMSliceXIndex, display.DSMSliceYIndex, display.DSMSliceZIndex = 64, 40, 30
simple.ResetCamera(view)
camera = view.GetActiveCamera()
camera.Azimuth(-35.0)
camera.Elevation(25.0)
camera.Dolly(1.2)
pictures = [draw(view)]
display.DSMClip = display.DSMCap = 1
display.DSMClipNormal = [1.0, -0.5, -0.5]
display.DSMCapSide = "Values Below"
display.SetRepresentationType("DSM Ray Traced")
display.DSMIsoValues = [0.75]
display.DSMShadows = 1
pictures.append(draw(view))
display.SetRepresentationType("DSM Volume")
opacity = simple.GetOpacityTransferFunction("f")
opacity.Points = [0.0, 1.0, 0.5, 0.0, 0.5, 0.9, 0.5, 0.0, 0.9, 0.0, 0.5, 0.0, 1.4, 0.0, 0.5, 0.0]
display.ScalarOpacityUnitDistance *= 8.0
pictures.append(draw(view))
write(os.path.join(FOLDER, "slices.png"), numpy.hstack(pictures))
