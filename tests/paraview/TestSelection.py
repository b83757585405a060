# SPDX-License-Identifier: BSD-3-Clause
"""What is selected on traced surfaces is what is selected on the same surfaces as geometry."""

from dsm_testing import *

load_plugin()
view = create_view()
view.UseFXAA = 0


def get_selected(*arguments):
    return select(view, *arguments)


# A mesh: cells and points of the dataset itself.
ball = simple.Sphere(Radius=9.0, ThetaResolution=24, PhiResolution=18)
mesh = simple.Show(ball, view)
mesh.ColorArrayName = [None, ""]
place_camera(view)
region = [130, 90, 180, 150]
everything = [0, 0, 299, 239]
for kind in ("cells", "points"):
    for rectangle in (region, everything):
        results = []
        for representation in (REPRESENTATION, "Surface"):
            mesh.Representation = representation
            simple.Render(view)
            results.append(get_selected(ball, kind, rectangle))
        check(results[1][0] > 3, f"Surface has {results[1][0]} selected {kind} of the mesh")
        check(results[0] == results[1], f"and the same ones are selected when traced: {results[0]}")
mesh.Representation = REPRESENTATION
check(get_selected(ball, "cells", [0, 0, 5, 5])[0] == 0, "beside it there is nothing")
mesh.Pickable = 0
simple.Render(view)
check(get_selected(ball, "cells", everything)[0] == 0, "what cannot be picked is not selected")
mesh.Pickable = 1

# The outer surface of image data.
simple.Hide(ball, view)
image = simple.Wavelet(WholeExtent=[-8, 8] * 3)
display = show_traced(image, view, DSMShow="Surface")
for kind in ("cells", "points"):
    results = []
    for representation in (REPRESENTATION, "Surface"):
        display.Representation = representation
        simple.Render(view)
        results.append(get_selected(image, kind, region))
    check(results[0] == results[1] and results[0][0] > 3, f"as many {kind} of an image as of its Surface: {results}")
simple.Delete(image)
simple.Show(ball, view)

# Translucent, with something else in the view, so that several ranks divide the space between them.
cone = simple.Cone(Height=30.0, Radius=4.0, Resolution=40)
show_surface(cone, view)
for rectangle in (region, everything):
    results = []
    for representation, opacity in (("Surface", 1.0), (REPRESENTATION, 0.5)):
        mesh.Representation = representation
        mesh.Opacity = opacity
        simple.Render(view)
        results.append(get_selected(ball, "cells", rectangle))
    check(results[0][0] > 3 and results[0] == results[1],
          f"beside something else, the same cells of a translucent mesh are selected: {results}")
simple.Delete(cone)
mesh.Opacity = 1.0
simple.Render(view)

mesh.DSMClip = 1
mesh.DSMClipNormal = [-0.6, -0.5, -1.0]
mesh.DSMClipOrigin = [0.0, 0.0, 0.0]
simple.Render(view)
whole = results[1][2]
clipped = get_selected(ball, "cells", everything)
check(clipped[0] > 0 and clipped[2] != whole, "what is clipped away is not selected")
simple.Delete(ball)

# A volume: the voxels in which the surface is seen.
source = image_source("image.SetExtent(piece)\nadd(image, distance(piece))\n")
traced = show(source, view, [0.8], "f")
place_camera(view)
simple.Render(view)
cells = get_selected(source, "cells", everything)
check(100 < cells[0] < 24**3 / 4, f"{cells[0]} voxels are selected")
low, high = cells[2][0::2], cells[2][1::2]
check(min(high) > 20 and max(low) < 10, f"on the side that is seen: {cells[2]}")
center = get_selected(source, "cells", [148, 118, 150, 120])
check(1 <= center[0] <= 4, f"few are under a few pixels: {center}")
corner = numpy.array(center[2][1::2])
distance = numpy.linalg.norm((corner - 12.0) / 12.0)
check(abs(distance - 0.8) < 0.2, "and they are at the surface")
points = get_selected(source, "points", [140, 110, 160, 130])
check(points[1] > 0, f"points are, too: {points}")
check(get_selected(source, "cells", [0, 0, 5, 5])[0] == 0, "beside it there is nothing")
traced.Pickable = 0
simple.Render(view)
check(get_selected(source, "cells", everything)[0] == 0, "what cannot be picked is not selected")
traced.Pickable = 1

# The isosurface of an array of cells is selected as that of their means.
simple.Hide(source, view)
in_cells = simple.PointDatatoCellData(source)
means = simple.CellDatatoPointData(in_cells)
results = []
for data, association in ((in_cells, "CELLS"), (means, "POINTS")):
    show_traced(data, view, DSMIsoArray=[association, "f"], DSMIsoValues=[0.8])
    simple.Render(view)
    results.append([get_selected(data, kind, region) for kind in ("cells", "points")])
    simple.Hide(data, view)
check(results[0][0][0] > 10 and results[0] == results[1], f"voxels of an isosurface of cells are selected: {results}")

# Another filter may have the source made again, with more ghost cells, in which cells have other numbers.
simple.Hide(source, view)
parts = simple.Wavelet()
show(parts, view, [157.0], "RTData")
simple.ResetCamera(view)
simple.Render(view)
before = get_selected(parts, "cells", region), get_selected(parts, "points", region)
check(before[0][0] > 10 and before[1][1] > 10, f"cells and points of a volume in parts are selected: {before}")
contour = simple.Contour(Input=parts, ContourBy=["POINTS", "RTData"], Isosurfaces=[157.0])
simple.Show(contour, view)
simple.Render(view)
simple.Hide(contour, view)
simple.Render(view)
after = get_selected(parts, "cells", region), get_selected(parts, "points", region)
check(after[0][2] == before[0][2] and after[1][2] == before[1][2],
      f"and the same after a Contour asked for ghost cells: {after}")
simple.Delete(contour)
simple.Delete(parts)

# AMR: ParaView 5.11 extracts none of the selected cells, so what the selection names is looked up.
simple.Hide(in_cells, view)
pulse = simple.AMRGaussianPulseSource(XPulseWidth=1.0, YPulseWidth=1.0, ZPulseWidth=1.0)
show_traced(pulse, view, DSMIsoArray=["CELLS", "Gaussian-Pulse"], DSMIsoValues=[0.2])
simple.Render(view)
simple.ResetCamera(view)
simple.Render(view)
simple.SelectSurfaceCells(Rectangle=everything, View=view)
selected = numpy.array(pulse.GetSelectionInput(pulse.Port).Input[0].IDs).reshape(-1, 3)
radius = pulse.XPulseWidth * numpy.sqrt(numpy.log(pulse.PulseAmplitude / 0.2))
blocks = pulse.SMProxy.GetClientSideObject().GetOutputDataObject(0)  # all of them on every rank
leaf = blocks.NewIterator()
distances = []
while not leaf.IsDoneWithTraversal():
    block = leaf.GetCurrentDataObject()
    for cell in selected[selected[:, 0] == leaf.GetCurrentFlatIndex(), 2]:
        middle = numpy.array(block.GetCell(int(cell)).GetBounds()).reshape(3, 2).mean(axis=1)
        distances.append(abs(numpy.linalg.norm(middle) - radius) / block.GetSpacing()[0])
    leaf.GoToNextItem()
check(len(distances) == len(selected) > 30, f"{len(distances)} cells are selected, of {len(selected)}")
check(len(set(selected[:, 0])) > 1 and max(distances) < 1.0,
      f"in several blocks, up to {max(distances)} of a cell away")
simple.Delete(pulse)

# All ranks select what one does.
reference = os.path.join(OUTPUT, "selected.npy")
numbers = numpy.array([cells[0], *cells[2], center[0], *center[2]])
if get_ranks() == 1:
    numpy.save(reference, numbers)
else:
    expected = numpy.load(reference)
    check(numpy.allclose(numbers[1:7], expected[1:7]) and numpy.allclose(numbers[7:], expected[7:]),
          "the same place is selected as on one rank")
    check(abs(numbers[0] - expected[0]) <= 0.02 * expected[0],
          f"{numbers[0]} voxels, and {expected[0]} on one rank")
