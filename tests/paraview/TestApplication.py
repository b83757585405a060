# SPDX-License-Identifier: BSD-3-Clause
"""Run by ParaView's application, which has loaded the plugin, alone or connected to a server."""

import os
import sys
import traceback

from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy


def get_picture(view):
    simple.Render(view)
    image = view.SMProxy.CaptureWindow(1)
    width, height, _ = image.GetDimensions()
    pixels = vtk_to_numpy(image.GetPointData().GetScalars())
    return pixels.reshape(height, width, -1)[:, :, :3].astype(int)


def count_covered(pixels):
    return (abs(pixels - pixels[0, 0]) > 2).any(axis=2).sum()


def test():
    view = simple.GetActiveViewOrCreate("RenderView")
    view.OrientationAxesVisibility = 0
    source = simple.Wavelet()
    display = simple.Show(source, view)
    types = list(display.GetProperty("Representation").Available)
    assert "DSM Ray Traced" in types, f"the combo box offers {types}"
    display.Representation = "DSM Ray Traced"
    display.DSMIsoValues = [157.0]
    display.ColorArrayName = [None, ""]
    simple.ResetCamera(view)
    assert display.DSMIsoArray[1] == "RTData", f"the array is {display.DSMIsoArray}"
    traced = get_picture(view)
    simple.SaveScreenshot(os.environ["DSM_TEST_PICTURE"], view)

    view.SMProxy.InteractiveRender()
    simple.Hide(source, view)
    contour = simple.Contour(source, ContourBy=["POINTS", "RTData"], Isosurfaces=[157.0])
    simple.Show(contour, view).ColorArrayName = [None, ""]
    triangles = get_picture(view)
    ours, theirs = count_covered(traced), count_covered(triangles)
    assert theirs > 1000, "the contour hardly shows"
    assert abs(ours - theirs) < 0.02 * theirs, f"{ours} pixels are covered instead of {theirs}"
    simple.Delete(contour)
    simple.Delete(source)
    assert count_covered(get_picture(view)) == 0, "something is left after deleting"


try:
    test()
except BaseException:
    traceback.print_exc()
    sys.stdout.flush()
    os._exit(1)
print("the application drew the surface", flush=True)
simple.Disconnect()
os._exit(0)
