# SPDX-License-Identifier: BSD-3-Clause
"""Makes volume.png, a volume as ParaView shows it and ray traced, with a surface inside, and volume_light.png, in
light:
    xvfb-run -a -s "-noreset -screen 0 1280x1024x24" pvbatch volume.py PLUGIN FOLDER"""

import os
import sys

import numpy
from paraview import simple

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from pictures import draw, write

PLUGIN, FOLDER = sys.argv[1:]

simple.LoadPlugin(os.path.abspath(PLUGIN), remote=False, ns=vars(simple))
view = simple.CreateRenderView(ViewSize=[480, 420])
view.OrientationAxesVisibility = 0
volume = simple.DSMSampleVolume(Dimensions=[128] * 3)
display = simple.Show(volume, view)
display.SetRepresentationType("DSM Volume")
simple.Render(view)
opacity = simple.GetOpacityTransferFunction("f")
opacity.Points = [0.0, 0.0, 0.5, 0.0, 0.35, 0.0, 0.5, 0.0, 0.5, 0.25, 0.5, 0.0, 0.6, 0.0, 0.5, 0.0, 1.4, 0.0, 0.5, 0.0]
cone = simple.Show(simple.Cone(Center=[0.0, 0.0, 0.0], Direction=[0.3, 1.0, 0.2], Height=1.2, Radius=0.4,
                               Resolution=60), view)
cone.DiffuseColor = cone.AmbientColor = [0.9, 0.6, 0.2]
simple.ResetCamera(view)
camera = view.GetActiveCamera()
camera.Azimuth(-25.0)
camera.Elevation(20.0)
camera.Dolly(1.5)
pictures = []
for kind in ("Volume", "DSM Volume"):
    display.Representation = kind
    pictures.append(draw(view))
write(os.path.join(FOLDER, "volume.png"), numpy.hstack(pictures))

cone.Visibility = 0
lamp = simple.CreateLight()
lamp.Coords, lamp.Position, lamp.FocalPoint = "Scene", [6.0, 8.0, 5.0], [0.0, 0.0, 0.0]
view.AdditionalLights = [lamp]
opacity.Points = [0.0, 0.6, 0.5, 0.0, 0.3, 0.4, 0.5, 0.0, 0.5, 0.02, 0.5, 0.0, 0.6, 0.0, 0.5, 0.0, 1.4, 0.0, 0.5, 0.0]
view.UseLight = 0
camera.Dolly(1.1)
display.DSMSamplesPerPixel = 4
pictures = [draw(view)]
display.Shade, display.Specular, display.SpecularPower = 1, 0.3, 30.0
pictures.append(draw(view))
display.DSMShadows, display.DSMScattering = 1, 0.0
pictures.append(draw(view))
display.DSMScattering = 1.0
pictures.append(draw(view))
write(os.path.join(FOLDER, "volume_light.png"), numpy.hstack(pictures))
