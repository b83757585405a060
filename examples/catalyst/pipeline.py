# script-version: 2.0
# SPDX-License-Identifier: BSD-3-Clause
"""A Catalyst script: an isosurface of what the simulation calls `input`, ray traced by its ranks.

DSM_PLUGIN is the path of DSMRayTracer.so; DSM_EVERY, from how many steps one has a picture (5);
DSM_OUTPUT, the folder for the pictures (pictures). ParaView writes scripts like this one with
File > Save Catalyst State; only LoadPlugin and the display's properties are the plugin's.
"""
import json
import os

from paraview import catalyst
from paraview.simple import *

LoadPlugin(os.path.abspath(os.environ["DSM_PLUGIN"]), ns=globals())

data = TrivialProducer(registrationName="input")
view = CreateRenderView(ViewSize=[400, 400])
view.OrientationAxesVisibility = 0
view.UseColorPaletteForBackground = 0
view.Background = [0.1, 0.1, 0.15]
view.CameraPosition = [1.6, 1.2, 1.9]
view.CameraFocalPoint = [0.5, 0.5, 0.5]

display = Show(data, view)
display.Representation = "DSM Ray Traced"
display.DSMIsoArray = "v"
display.DSMIsoValues = [0.15]
display.DSMAmbientOcclusionSamples = 2
display.DSMSamplesPerPixel = 4
ColorBy(display, ("POINTS", "u"))
colors = GetColorTransferFunction("u")
colors.RescaleTransferFunction(0.2, 0.8)
colors.AutomaticRescaleRangeMode = "Never"

pictures = CreateExtractor("PNG", view, registrationName="pictures")
pictures.Trigger.Frequency = int(os.environ.get("DSM_EVERY", "5"))
pictures.Writer.FileName = "step{timestep:06d}.png"
pictures.Writer.ImageResolution = [400, 400]


def catalyst_finalize():
    """Prints how often bricks were made. If a step does not change an array, its bricks are kept."""
    display.SMProxy.UpdatePropertyInformation()
    ranks = json.loads(display.SMProxy.GetProperty("DSMStatistics").GetElement(0))
    if servermanager.vtkProcessModule.GetProcessModule().GetPartitionId() == 0:
        print("arrays were cut into bricks", ranks[0]["Publications"], "times", flush=True)


options = catalyst.Options()
options.ExtractsOutputDirectory = os.environ.get("DSM_OUTPUT", "pictures")
