# SPDX-License-Identifier: BSD-3-Clause
"""Volumes of every kind: the same surface as vtkFlyingEdges3D's, the same picture on any number of
ranks."""

from dsm_testing import *

load_plugin()
view = create_view()


def compare(*arguments, **keywords):
    compare_with_triangles(view, *arguments, **keywords)


compare("Wavelet", simple.Wavelet(), [130.0, 200.0], share=0.02)

compare(
    "AnisotropicWithNegativeExtent",
    image_source(
        """
image.SetExtent(piece); image.SetSpacing(0.5, 1.0, 2.5); image.SetOrigin(-7.0, 3.0, 100.0)
add(image, distance(piece))
""",
        (-30, 10, -5, 25, 7, 21),
    ),
)

DIRECTION = """
from math import cos, sin
a, b = 0.5, 0.8
image.SetExtent(piece); image.SetSpacing(1.0, 1.5, 2.0); image.SetOrigin(3.0, 2.0, 1.0)
image.SetDirectionMatrix(cos(a), -sin(a) * cos(b), sin(a) * sin(b),
    sin(a), cos(a) * cos(b), -cos(a) * sin(b), 0.0, sin(b), cos(b))
add(image, distance(piece) + 0.1 * points(piece)[0] / 24.0)
"""
compare("ObliqueDirections", image_source(DIRECTION), [0.6, 0.9])

LEFT_HANDED = """
image.SetExtent(piece); image.SetDirectionMatrix(0, 1, 0, 1, 0, 0, 0, 0, 1)
add(image, distance(piece) + 0.2 * points(piece)[0] / 24.0)
"""
compare("LeftHandedDirections", image_source(LEFT_HANDED), [0.8])

VECTOR = """
image.SetExtent(piece)
i, j, k = points(piece)
add(image, np.stack([i - 12, j - 12, k - 12], axis=1) / 12.0, 'vector')
add(image, {scalars}, 'scalar')
"""
component = image_source(VECTOR.format(scalars="(j - 12) / 12.0"))
compare("Component", component, [0.3], "vector", DSMIsoComponent=1)
magnitude = image_source(VECTOR.format(scalars="distance(piece)"))
compare("Magnitude", magnitude, [0.7], "vector", DSMIsoComponent=3)

WITHOUT_GHOSTS = "image.SetExtent(piece)\nadd(image, distance(piece))\n"
WITH_GHOSTS = """
wider = list(piece)
for axis in range(3):
    wider[2 * axis] = max(whole[2 * axis], piece[2 * axis] - 2)
    wider[2 * axis + 1] = min(whole[2 * axis + 1], piece[2 * axis + 1] + 2)
image.SetExtent(wider)
# What lies in ghost cells only is wrong, and must not be seen.
i, j, k = points(wider)
own = np.ones(len(i), bool)
for axis, p in enumerate((i, j, k)):
    own &= (p >= piece[2 * axis]) & (p <= piece[2 * axis + 1])
add(image, np.where(own, distance(wider), 0.0))
cells = [wider[0], wider[1] - 1, wider[2], wider[3] - 1, wider[4], wider[5] - 1]
ghost = np.zeros(len(points(cells)[0]), np.uint8)
for axis, p in enumerate(points(cells)):
    ghost[(p < piece[2 * axis]) | (p >= piece[2 * axis + 1])] = 1
array = numpy_to_vtk(ghost, deep=True); array.SetName('vtkGhostType')
image.GetCellData().AddArray(array)
"""
compare("GhostCells", image_source(WITH_GHOSTS), reference=image_source(WITHOUT_GHOSTS))

BLANKED = """
image.SetExtent(piece)
add(image, distance(piece){cut})
if {blank}:
    hidden = np.where(points(piece)[0] > 16, 2, 0).astype(np.uint8)
    array = numpy_to_vtk(hidden, deep=True); array.SetName('vtkGhostType')
    image.GetPointData().AddArray(array)
"""
NANS = """
image.SetExtent(piece)
add(image, np.where(points(piece)[0] > 16, np.nan, distance(piece)))
"""
CUT = """
end = min(piece[1], 16)
if end > piece[0]:
    piece[1] = end
    image.SetExtent(piece)
    add(image, distance(piece))
else:
    image.SetExtent(0, -1, 0, -1, 0, -1)
"""
compare("BlankedPoints", image_source(BLANKED.format(cut="", blank=1)), reference=image_source(CUT))
compare("NotANumber", image_source(NANS), reference=image_source(CUT))

compare(
    "OneRankHasEverything",
    image_source(
        """
if rank == ranks - 1:
    image.SetExtent(whole)
    add(image, distance(whole))
else:
    image.SetExtent(0, -1, 0, -1, 0, -1)
"""
    ),
)

# Values of cells: as Cell Data to Point Data makes them values of points, whatever the pieces are.
CELLS = """
{place}
def add_cells(values, name):
    array = numpy_to_vtk(values, deep=True); array.SetName(name)
    image.GetCellData().AddArray(array)
extent = list(image.GetExtent())
if image.GetNumberOfCells() > 0:
    cells = [extent[0], extent[1] - 1, extent[2], extent[3] - 1, extent[4], extent[5] - 1]
    i, j, k = points(cells)
    values = distance(cells) + 0.1 * np.sin(i * 1.7) * np.cos(j * 2.3)
    ghost = np.zeros(len(i), np.uint8)
    {ghosts}
    add_cells(values, 'c')
    add_cells(np.stack([i - 12.0, j - 12.0, k - 12.0], axis=1) / 12.0, 'vector')
    add_cells(np.int16(100.0 * values), 'integers')
    if ghost.any():
        add_cells(ghost, 'vtkGhostType')
"""
WHOLE = CELLS.format(place="image.SetExtent(piece)", ghosts="")


def compare_cells(name, source, isovalue=0.7, array="c", reference=WHOLE, **properties):
    """Several ranks show what one rank does, and that shows the surface of points that have the cells' means."""
    display = show_traced(source, view, DSMIsoArray=["CELLS", array], DSMIsoValues=[isovalue], **properties)
    place_camera(view)
    picture = render(view, name)
    check(get_covered(picture).mean() > 0.05, name + ": something is shown")
    if get_ranks() == 1:
        simple.Hide(source, view)
        input = image_source(reference)
        means = simple.CellDatatoPointData(input)
        show(means, view, [isovalue], array, **properties)
        check_equal(render(view), picture, name + " is what the means at points show", tolerance=0)
        simple.Delete(means)
        simple.Delete(input)
    simple.Delete(source)


compare_cells("Cells", image_source(WHOLE, in_parts=True))
compare_cells("CellsMagnitude", image_source(WHOLE, in_parts=True), array="vector", DSMIsoComponent=3)
compare_cells("CellsOfIntegers", image_source(WHOLE, in_parts=True), 70.5, "integers")
WIDER = WITH_GHOSTS[:WITH_GHOSTS.index("# What lies")]
# Each piece has copies of cells of others; what they hold is wrong, and must not be seen.
COPIES = """
    for axis, p in enumerate((i, j, k)):
        ghost[(p < piece[2 * axis]) | (p >= piece[2 * axis + 1])] = 1
    values[ghost > 0] = 5.0
"""
compare_cells("CellsWithGhosts", image_source(CELLS.format(place=WIDER, ghosts=COPIES), in_parts=True))
ONE = """
if rank == ranks - 1:
    image.SetExtent(whole)
else:
    image.SetExtent(0, -1, 0, -1, 0, -1)
"""
compare_cells("CellsOnOneRank", image_source(CELLS.format(place=ONE, ghosts="")))

# Hidden cells show nothing, and have no part in the means.
HIDDEN = "ghost[(i > 16) & (k > 10)] = 32; values[ghost > 0] = 5.0"
pictures = []
for name, ghosts in (("CellsWhole", ""), ("CellsHidden", HIDDEN)):
    source = image_source(CELLS.format(place="image.SetExtent(piece)", ghosts=ghosts), in_parts=True)
    show_traced(source, view, DSMIsoArray=["CELLS", "c"], DSMIsoValues=[0.7])
    place_camera(view)
    pictures.append(render(view, name))
    simple.Delete(source)
share = (abs(pictures[0] - pictures[1]).max(axis=2) > 8).sum() / get_covered(pictures[0]).sum()
check(0.1 < share < 0.5, f"where cells are hidden, the inside is seen: {share:.2f} of the pixels")

# Values change beside what another rank has.
source = image_source(WHOLE, in_parts=True)
show_traced(source, view, DSMIsoArray=["CELLS", "c"], DSMIsoValues=[0.7])
place_camera(view)
before = render(view)
for layer in (16, 15, 8):
    source.Script = IMAGE_SOURCE.format(extent=", ".join(["0, 24"] * 3), script=WHOLE).replace(
        "add_cells(values, 'c')", f"add_cells(np.where({layer} == np.stack((i, j, k)).min(axis=0), 0.5, values), 'c')")
    check((render(view, f"CellsChanged{layer}") != before).any(), "other values are shown")
simple.Delete(source)

# Blocks of cells that continue one another are one volume.
CELL_BLOCKS = """
from vtkmodules.vtkCommonDataModel import vtkImageData
output = self.GetOutputDataObject(0)
bounds = [0, 7, 16, 24]
for block in range(3):
    if {all} or block % ranks == rank:
        part = [bounds[block], bounds[block + 1], 0, 24, 0, 24] if not {all} else whole
        child = vtkImageData()
        child.SetExtent(part)
        array = numpy_to_vtk(distance([part[0], part[1] - 1, 0, 23, 0, 23]), deep=True); array.SetName('c')
        child.GetCellData().AddArray(array)
        output.SetBlock(block, child)
        if {all}:
            break
"""
pictures = []
for is_one in (0, 1):
    source = simple.ProgrammableSource(OutputDataSetType="vtkMultiblockDataSet")
    source.Script = IMAGE_SOURCE.format(extent=", ".join(["0, 24"] * 3), script=CELL_BLOCKS.format(all=is_one)).replace(
        "request.Get(vtkStreamingDemandDrivenPipeline.UPDATE_EXTENT(), piece)", "")
    show_traced(source, view, DSMIsoArray=["CELLS", "c"], DSMIsoValues=[0.7])
    place_camera(view)
    pictures.append(render(view, f"CellsInBlocks{is_one}"))
    simple.Delete(source)
check_equal(pictures[0], pictures[1], "blocks of cells look like one", tolerance=0)

source = image_source(WHOLE)
display = show_traced(source, view)
place_camera(view)
simple.Render(view)
check(list(display.DSMIsoArray) == ["CELLS", "c"], "of cell arrays only, one is chosen")
check(0.1 < display.DSMIsoValue < 2.0, f"and an isovalue: {display.DSMIsoValue}")
simple.Delete(source)

compare(
    "PiecesOneCellThick",
    image_source(
        """
# Slabs of one cell; the last rank has the rest.
first = whole[4] + rank
last = first + 1 if rank < ranks - 1 else whole[5]
slab = whole[:4] + [first, last]
image.SetExtent(slab)
add(image, distance(slab))
"""
    ),
)

ONE_CELL = """
image.SetExtent(piece)
add(image, points(piece)[0] + 0.5 * points(piece)[1])
"""
compare("OneCell", image_source(ONE_CELL, (0, 1) * 3), [0.6], share=0.01)

BLOCKS = """
from vtkmodules.vtkCommonDataModel import vtkImageData
output = self.GetOutputDataObject(0)
bounds = [0, 7, 16, 24]
for block in range(3):
    part = [bounds[block], bounds[block + 1], 0, 24, 0, 24]
    if block % ranks == rank:
        child = vtkImageData()
        child.SetOrigin(2.0 * part[0], 0.0, 0.0); child.SetSpacing(2.0, 1.0, 1.0)
        child.SetDimensions(part[1] - part[0] + 1, 25, 25)
        add(child, 0.0 * distance(part) + block, 'block')
        add(child, distance(part))
        {set}
"""
for kind, set_ in (
    ("vtkMultiblockDataSet", "output.SetBlock(block, child)"),
    ("vtkPartitionedDataSet", "output.SetPartition(block, child)"),
    ("vtkPartitionedDataSetCollection", "output.SetPartition(block, 0, child)"),
):
    text = ", ".join(["0, 24"] * 3)
    source = simple.ProgrammableSource(OutputDataSetType=kind)
    script = IMAGE_SOURCE.format(extent=text, script=BLOCKS.format(set=set_))
    # Composite datasets have no extent to be asked for.
    asks = "request.Get(vtkStreamingDemandDrivenPipeline.UPDATE_EXTENT(), piece)"
    source.Script = script.replace(asks, "")
    compare(kind, source)

# Blocks that are hidden.
source = simple.ProgrammableSource(OutputDataSetType="vtkMultiblockDataSet")
source.Script = IMAGE_SOURCE.format(
    extent=text, script=BLOCKS.format(set="output.SetBlock(block, child)")).replace(asks, "")
display = show(source, view, [0.7])
place_camera(view)
whole = render(view, "Blocks")
display.BlockSelectors = ["/Root/Block0", "/Root/Block1"]
part = get_covered(render(view, "BlocksShown"))
expected = get_covered(whole)
check(part.sum() > 0.2 * expected.sum() and not part[~expected].any() and expected[~part].any(),
      f"with a block hidden, {part.sum()} pixels of {expected.sum()} are covered")
display.BlockSelectors = ["/"]
check_equal(render(view), whole, "all are shown again", tolerance=0)

# They agree on what is shown where they touch, but not on an array that colors them.
simple.ColorBy(display, ("POINTS", "block"))
check((render(view, "BlocksByNumber") != whole).any(), "they can be coloured by what they disagree about")
simple.ColorBy(display, None)
check_equal(render(view), whole, "and are one volume again", tolerance=0)
simple.Delete(source)

# Blocks that disagree where they touch, since a Wavelet depends on its extent, and looks of their own: as Contour has
# them, of each block by itself.
extents = {"one": [-10, 10, -10, 10, -10, 10], "two": [10, 30, -10, 10, -10, 10], "three": [-10, 30, 10, 25, -10, 10]}
wavelets = [simple.Wavelet(WholeExtent=extent) for extent in extents.values()]
blocks = simple.GroupDatasets(Input=wavelets, BlockNames=list(extents))
contour = simple.Contour(Input=blocks, ContourBy=["POINTS", "RTData"], Isosurfaces=[130.0])
traced = show(blocks, view, [130.0], "RTData")
triangles = show_surface(contour, view)
triangles.Visibility = 0
place_camera(view)


def compare_looks(name, change):
    for display in (traced, triangles):
        change(display)
    with Messages() as messages:
        picture = render(view, name)
    check("ERROR" not in messages.text, f"{name}: no error: {messages.text}")
    if get_ranks() == 1:
        traced.Visibility, triangles.Visibility = 0, 1
        check_same_surface(picture, render(view), name, share=0.02)
        traced.Visibility, triangles.Visibility = 1, 0
    return picture


def color_by_blocks(display):
    display.BlockColorsDistinctValues = 5
    display.LookupTable = simple.GetColorTransferFunction("vtkBlockColors")
    display.ColorArrayName = ["FIELD", "vtkBlockColors"]


torn = compare_looks("TornBlocks", lambda display: None)
arrays = traced.SMProxy.GetProperty("ColorArrayName").GetDomain("array_list")
offered = [arrays.GetString(index) for index in range(arrays.GetNumberOfStrings())]
check("vtkBlockColors" in offered, f"the panel offers to colour by {offered}")
render(view)
built = get_rows(traced)[0]["Publications"]
by_number = compare_looks("BlockColors", color_by_blocks)
check(abs(by_number - torn).max() > 100, "blocks have the colours of their numbers")
compare_looks("BlockColor", lambda display: setattr(display, "BlockColors", ["/Root/two", "0", "0.4", "1"]))
compare_looks("BlockOpacity", lambda display: setattr(display, "BlockOpacities", ["/Root/one", "0.3"]))
traced.ColorArrayName = [None, ""]
traced.BlockColors = traced.BlockOpacities = []
check_equal(render(view), torn, "all look as before", tolerance=0)
check(get_rows(traced)[0]["Publications"] == built, "and no bricks were made for their looks")
for source in [contour, blocks, *wavelets]:
    simple.Delete(source)

# A mask hides cells by the values of another array, also where each rank has a part of it. The image's own array as a
# mask hides what ignored values do.
masked = image_source(
    """
image.SetExtent(piece)
i, j, k = points(piece)
add(image, np.floor(i / 5.0) % 3.0, 'labels')
add(image, distance(piece))
cells = points([piece[0], piece[1] - 1, piece[2], piece[3] - 1, piece[4], piece[5] - 1])
array = numpy_to_vtk(np.floor(cells[1] / 4.0).astype(np.int16), deep=True)
array.SetName('slabs')
image.GetCellData().AddArray(array)
""",
    in_parts=True,
)
simple.HideAll(view)
display = show(masked, view, [0.8], "f")
place_camera(view)
simple.ColorBy(display, ("POINTS", "f"))
for kind in (REPRESENTATION, "DSM Volume", "DSM Slices"):
    display.Representation = kind
    pictures = [render(view)]
    for mask, range_, values in ((["POINTS", "labels"], [1.0, 2.0], []), (["POINTS", "labels"], [1.0, 2.0], [0.0, 2.0]),
                                 (["CELLS", "slabs"], [0.0, 0.0], [1.0, 3.0, 4.0]), (["POINTS", "f"], [0.3, 1.1], [])):
        display.DSMMaskArray, display.DSMMaskRange, display.DSMMaskValues = mask, range_, values
        pictures.append(render(view, f"Mask{kind.split()[-1]}{len(pictures)}"))
        different = (abs(pictures[-1] - pictures[-2]).max(axis=2) > 8).mean()
        check(different > 0.01, f"{kind} with the mask {mask}: {100 * different:.2f} % of the pixels are others")
    display.DSMMaskArray = ["POINTS", "None"]
    check_equal(render(view), pictures[0], f"{kind} without a mask", tolerance=0)
    display.DSMIgnoreValues, display.DSMValidRange = 1, [0.3, 1.1]
    check_equal(render(view), pictures[-1], f"{kind}: ignored values are a mask", tolerance=0)
    display.DSMIgnoreValues = 0
with Messages() as messages:
    display.DSMMaskArray = ["CELLS", "labels"]
    render(view)
check(get_ranks() > 1 or "mask array 'labels'" in messages.text, f"a mask array that is not there: {messages.text}")
