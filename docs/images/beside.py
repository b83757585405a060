# SPDX-License-Identifier: BSD-3-Clause
"""Makes beside.png, the same data as ParaView shows them and ray traced:
    xvfb-run -a -s "-noreset -screen 0 1280x1024x24" pvbatch beside.py PLUGIN FOLDER"""

import os
import sys

import numpy
from paraview import simple

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from pictures import draw, write

PLUGIN, FOLDER = sys.argv[1:]

simple.LoadPlugin(os.path.abspath(PLUGIN), remote=False, ns=vars(simple))
view = simple.CreateRenderView(ViewSize=[560, 480])
view.OrientationAxesVisibility = 0
view.UseLight = 0
view.AdditionalLights = [simple.CreateLight()]
light = view.AdditionalLights[0]
light.Coords = "Scene"
light.Position = [1.5, 3.5, 4.0]
light.Intensity = 0.9
volume = simple.DSMSampleVolume(Dimensions=[128] * 3)
contour = simple.Contour(Input=volume, ContourBy=["POINTS", "f"], Isosurfaces=[0.5])
cone = simple.Cone(Center=[0.35, 0.75, 1.0], Direction=[0.3, 1.0, 0.2], Height=0.7, Radius=0.25, Resolution=60)


def show(source, color):
    display = simple.Show(source, view)
    display.ColorArrayName = [None, ""]
    display.Ambient = 0.2
    display.AmbientColor = display.DiffuseColor = color
    return display


solid = show(cone, [0.85, 0.35, 0.2])
surface = show(contour, [0.9, 0.87, 0.8])
surface.Representation = solid.Representation = "Surface"
simple.ResetCamera(view)
camera = view.GetActiveCamera()
camera.Azimuth(-25.0)
camera.Elevation(20.0)
camera.Dolly(1.45)
beside = [draw(view)]

simple.Hide(contour, view)
traced = show(volume, [0.9, 0.87, 0.8])
traced.Representation = solid.Representation = "DSM Ray Traced"
traced.DSMIsoArray = ["POINTS", "f"]
traced.DSMIsoValues = [0.5]
traced.DSMShadows = 1
traced.DSMLightRadius = 0.05
traced.DSMAmbientOcclusionSamples = 1
traced.DSMSamplesPerPixel = 64
beside.append(draw(view))

write(os.path.join(FOLDER, "beside.png"), numpy.hstack(beside))
