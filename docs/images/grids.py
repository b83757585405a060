# SPDX-License-Identifier: BSD-3-Clause
"""Makes grids.png, of six datasets of simulations: curvilinear grids, hexahedra, polyhedra, quadratic and mixed cells:
    xvfb-run -a -s "-noreset -screen 0 1280x1024x24" pvbatch grids.py PLUGIN FOLDER GRIDS
GRIDS is a folder with kitchen_blanked.vts, combustor.vtm, mug.e, mixing_elbow_polyhedra.vtu, notch_quadratic_hexes.vtu
and beam_hex_wedge_pyramid.vtu: public data that other programs wrote. Without any of them, nothing is made."""

import os
import sys

import numpy
from paraview import simple

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from pictures import draw, write

PLUGIN, FOLDER, GRIDS = sys.argv[1:]

# File, array, its range, representation, isovalues, view direction, up, time.
SHOWN = [
    ("kitchen_blanked.vts", ("POINTS", "ke"), (0.0, 0.004), "DSM Ray Traced", [0.001, 0.003],
     (0.6, -0.8, 0.5), (0, 0, 1), 0.0),
    ("combustor.vtm", ("POINTS", "Density"), (0.2, 0.7), "DSM Volume", [], (-0.5, 0.9, 0.5), (0, 0, 1), 0.0),
    ("mixing_elbow_polyhedra.vtu", ("CELLS", "Temperature"), (293.0, 313.0), "DSM Slices", [],
     (0.0, 0.0, 1.0), (0, 1, 0), 0.0),
    ("mug.e", ("POINTS", "convected"), (0.0, 1.0), "DSM Ray Traced", [0.3, 0.6], (0.5, 0.6, 0.7), (0, 1, 0), 1.0),
    ("notch_quadratic_hexes.vtu", ("POINTS", "Displacement_Y"), (-1e-7, 1e-7), "DSM Ray Traced", [-4e-8, 4e-8],
     (0.4, 0.5, 0.8), (0, 1, 0), 0.0),
    ("beam_hex_wedge_pyramid.vtu", ("POINTS", "Von_Mises_Stress"), (0.0, 6e7), "DSM Volume", [],
     (0.8, 0.5, 0.4), (0, 1, 0), 0.0),
]


def draw_grid(name, array, limits, representation, isovalues, direction, up, time):
    view = simple.CreateRenderView(ViewSize=[300, 240], OrientationAxesVisibility=0, UseColorPaletteForBackground=0,
                                   Background=[1.0, 1.0, 1.0])
    source = simple.OpenDataFile(os.path.join(GRIDS, name))
    simple.GetTimeKeeper().Time = time
    source.UpdatePipeline(time)
    outline = simple.Show(simple.Outline(Input=source), view)
    outline.AmbientColor = outline.DiffuseColor = [0.4, 0.4, 0.4]
    display = simple.Show(source, view)
    simple.ColorBy(display, array)
    display.SetScalarBarVisibility(view, False)
    low, high = limits
    simple.GetColorTransferFunction(array[1]).ApplyPreset("Cool to Warm (Extended)")
    simple.GetColorTransferFunction(array[1]).RescaleTransferFunction(low, high)
    simple.GetOpacityTransferFunction(array[1]).Points = [low, 0.0, 0.5, 0.0, high, 1.0, 0.5, 0.0]
    display.SetRepresentationType(representation)
    if representation == "DSM Slices":
        display.DSMSliceOrigin = [0.0, 0.0, 0.001]
    if isovalues:
        display.DSMShow, display.DSMIsoArray, display.DSMIsoValues = "Isosurfaces", list(array), isovalues
        display.DSMAmbientOcclusionSamples, display.DSMSamplesPerPixel = 1, 16
    view.CameraFocalPoint, view.CameraPosition, view.CameraViewUp = [0, 0, 0], list(direction), list(up)
    simple.ResetCamera(view)
    view.GetActiveCamera().Dolly(1.15)
    pixels = draw(view)
    simple.Hide(source, view)
    simple.Delete(view)
    return pixels


missing = [shown[0] for shown in SHOWN if not os.path.exists(os.path.join(GRIDS, shown[0]))]
if missing:
    print(f"grids.png is not made: {GRIDS} has no {', '.join(missing)}")
    sys.exit()
simple.LoadPlugin(os.path.abspath(PLUGIN), remote=False, ns=vars(simple))
pictures = [draw_grid(*shown) for shown in SHOWN]
write(os.path.join(FOLDER, "grids.png"), numpy.vstack([numpy.hstack(pictures[3:]), numpy.hstack(pictures[:3])]))
