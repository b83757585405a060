# SPDX-License-Identifier: BSD-3-Clause
"""Rectilinear grids, beside Contour and Slice of the same data; each rank has a part of its own."""

from dsm_testing import *

load_plugin()
view = create_view()
EXTENT = (0, 30, -4, 22, 5, 29)
PLACES = """
def places(extent):
    '''Coordinates along each axis, within [-1, 1].'''
    i, j, k = [np.arange(extent[2 * axis], extent[2 * axis + 1] + 1.0) for axis in range(3)]
    return {steps}
"""
STRETCHED = ("2.0 * (1.2**i - 1.0) / (1.2**30 - 1.0) - 1.0, (j - 9.0 + 0.3 * (-1.0) ** j) / 13.3, "
             "(k - 5.0) ** 1.5 / 58.8 - 1.0")
FALLING = STRETCHED.replace("(k - 5.0)", "(29.0 - k)")
EQUAL = "i / 15.0 - 1.0, (j - 9.0) / 13.0, (k - 17.0) / 12.0"
GRID = """
image.SetExtent(piece)
{set}
k, j, i = np.meshgrid(*reversed(places(piece)), indexing='ij')
x, y, z = i.ravel(), j.ravel(), k.ravel()
add(image, x + 2.0 * y - z, 'ramp')
add(image, np.sqrt(x * x + y * y + z * z) + 0.15 * np.sin(9.0 * x) * np.cos(7.0 * y), 'f')
"""
COORDINATES = """
for set, along in zip((image.SetXCoordinates, image.SetYCoordinates, image.SetZCoordinates), places(piece)):
    set(numpy_to_vtk(along, deep=True))
"""


def grid_source(steps=STRETCHED):
    script = PLACES.format(steps=steps) + GRID.format(set=COORDINATES)
    return image_source(script, EXTENT, in_parts=True, kind="vtkRectilinearGrid")


def compare_with_contour(name, source, isovalue, array, angle=30.0):
    """One rank with Contour, several with what one rank drew."""
    show(source, view, [isovalue], array)
    place_camera(view)
    view.CameraViewAngle = angle
    picture = render(view, name)
    if get_ranks() == 1:
        simple.Hide(source, view)
        contour = simple.Contour(Input=source, ContourBy=["POINTS", array], Isosurfaces=[isovalue])
        show_surface(contour, view)
        check_same_surface(picture, render(view, name + "Contour"), name, share=0.003)
        simple.Delete(contour)
    else:
        simple.Hide(source, view)


grid = grid_source()
compare_with_contour("Stretched", grid, 0.7, "f")

# The same grid with coordinates that fall, of which Contour's triangles look to the wrong side.
stretched = []
falling = grid_source(FALLING)
for source in (grid, falling):
    show(source, view, [0.7], "f")
    stretched.append(render(view))
    simple.Hide(source, view)
check_equal(stretched[0], stretched[1], "coordinates may fall", tolerance=3)
simple.Delete(falling)

# Colors of another array, and slices, by their planes' indices and anywhere.
display = show(grid, view, [0.7], "f")


def color(display, array, low, high):
    simple.ColorBy(display, ("POINTS", array))
    simple.GetColorTransferFunction(array).RescaleTransferFunction(low, high)
    simple.GetOpacityTransferFunction(array).RescaleTransferFunction(low, high)


color(display, "ramp", -4.0, 4.0)
pictures = [render(view, "Colors")]
if get_ranks() == 1:
    simple.Hide(grid, view)
    contour = simple.Contour(Input=grid, ContourBy=["POINTS", "f"], Isosurfaces=[0.7])
    colored = show_surface(contour, view)
    color(colored, "ramp", -4.0, 4.0)
    check_same_surface(pictures[0], render(view), "colors", share=0.003)
    simple.Delete(contour)
    simple.Show(grid, view)
display.Representation = "DSM Slices"
color(display, "ramp", -4.0, 4.0)
for letter, index in zip("XYZ", (27, 10, 7)):
    setattr(display, f"DSMSlice{letter}", 1)
    setattr(display, f"DSMSlice{letter}Index", index)
picture = render(view, "Slices")
if get_ranks() == 1:
    simple.Hide(grid, view)
    planes = []
    for axis, index in enumerate((27, 10, 7)):
        extent = list(EXTENT)
        extent[2 * axis] = extent[2 * axis + 1] = EXTENT[2 * axis] + index
        planes.append(simple.ExtractSubset(Input=grid, VOI=extent))
        plane = show_surface(planes[-1], view)
        color(plane, "ramp", -4.0, 4.0)
        plane.Ambient, plane.Diffuse = 1.0, 0.0
    check_same_surface(picture, render(view, "SlicesOfSubsets"), "slices", share=0.003)
    for plane in planes:
        simple.Delete(plane)
    simple.Show(grid, view)

# A medium. With equal steps, it is that of image data.
color(display, "f", 0.0, 1.8)
display.Representation = "DSM Volume"
stretched = render(view, "Medium")
check(get_covered(stretched).mean() > 0.1, "a rectilinear medium is seen")
simple.Delete(grid)
even = grid_source(EQUAL)
image = image_source(
    PLACES.format(steps=EQUAL)
    + GRID.format(set="image.SetSpacing(1 / 15.0, 1 / 13.0, 1 / 12.0)\nimage.SetOrigin(-1.0, -9 / 13.0, -17 / 12.0)"),
    EXTENT,
    in_parts=True,
)
for kind in ("DSM Ray Traced", "DSM Volume", "DSM Slices"):
    pictures = []
    for source in (even, image):
        display = simple.Show(source, view)
        display.Representation = kind
        display.DSMIsoArray = ["POINTS", "f"]
        display.DSMIsoValues = [0.7]
        color(display, "ramp" if kind == "DSM Slices" else "f", -0.5, 1.8)
        pictures.append(render(view))
        simple.Hide(source, view)
    difference = abs(pictures[0] - pictures[1])
    check(get_covered(pictures[0]).mean() > 0.05, f"{kind}: something is seen")
    check((difference > 2).any(axis=2).mean() < 0.001, f"{kind}: equal steps are those of image data")

# Blocks that share a plane are one grid.
for source in (even, image):
    simple.Delete(source)
grid = grid_source()
halves = [simple.ExtractSubset(Input=grid, VOI=[*EXTENT[:4], *part]) for part in ((5, 17), (17, 29))]
blocks = simple.GroupDatasets(Input=halves)
compare_with_contour("Blocks", blocks, 0.7, "f")
for source in (blocks, *halves):
    simple.Delete(source)

# Real data, in the folder that DSM_TEST_GRIDS names.
DATA = os.path.join(os.environ.get("DSM_TEST_GRIDS", ""), "rectilinear_flow.vtr")
if not os.path.exists(DATA):
    print("skipped: DSM_TEST_GRIDS names no folder with rectilinear_flow.vtr")
else:
    flow = simple.XMLRectilinearGridReader(FileName=[DATA])
    for isovalue in (1.0, 3.0, 5.2):
        compare_with_contour(f"Flow{isovalue}", flow, isovalue, "scalars", angle=15.0)
    simple.Delete(flow)

# Selections know cells and points of the grid.
show(grid, view, [0.7], "f")
view.CameraViewAngle = 30.0
place_camera(view)
render(view)
simple.SelectSurfaceCells(Rectangle=[130, 100, 170, 140], View=view)
extract = simple.ExtractSelection(Input=grid)
merged = simple.MergeBlocks(extract)
merged.UpdatePipeline()
information = merged.GetDataInformation()
bounds = numpy.array(information.GetBounds())
check(information.GetNumberOfCells() > 4, f"{information.GetNumberOfCells()} cells are selected")
check((abs(bounds) <= 1.001).all() and (bounds[1::2] - bounds[0::2] < 1.5).all(), f"at their places: {bounds}")
numbers = os.path.join(OUTPUT, "selected.npy")
if get_ranks() == 1:
    numpy.save(numbers, bounds)
else:
    check(numpy.allclose(bounds, numpy.load(numbers)), "the same on all ranks")
