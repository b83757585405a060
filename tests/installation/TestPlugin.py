# SPDX-License-Identifier: BSD-3-Clause
"""ParaView loads the installed plugin by itself when PV_PLUGIN_CONFIG_FILE names it, and pvpython has the
VTK classes. To be run by pvpython, with the prefix's Python folder in PYTHONPATH."""
from paraview import simple

from dsmraytracer import vtkDSMVolumeMapper

assert vtkDSMVolumeMapper().IsA("vtkVolumeMapper")
source = simple.Wavelet()
view = simple.CreateRenderView(ViewSize=[100, 100])
display = simple.Show(source, view)
available = list(display.GetProperty("Representation").Available)
assert "DSM Ray Traced" in available, available
display.Representation = "DSM Ray Traced"
display.DSMIsoArray = "RTData"
display.DSMIsoValues = [160.0]
simple.Render(view)
display.SMProxy.UpdatePropertyInformation()
assert display.SMProxy.GetProperty("DSMFrameTime").GetElement(0) > 0.0, "no frame was traced"
print("the plugin was loaded and traced a frame")
