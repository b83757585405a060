# SPDX-License-Identifier: BSD-3-Clause
"""AMR and hyper tree grids: ParaView's sources of them."""

from dsm_testing import *

load_plugin()
view = create_view()


def show_levels(source, name, array=None, isovalues=None, is_recorded=True):
    """Without a message; the first array and isovalue are chosen where none are given."""
    for other in simple.GetSources().values():
        simple.Hide(other, view)
    with Messages() as messages:
        display = show_traced(source, view, **({"DSMIsoArray": ["CELLS", array]} if array else {}))
        if isovalues:
            display.DSMIsoValues = isovalues
        place_camera(view)
        render(view)
    pixels = render(view, name if is_recorded else None)
    check(not messages.text.strip(), f"{name}: no message: {messages.text.strip()}")
    check(get_covered(pixels).sum() > 20, f"{name}: something is shown")
    return display, pixels


pulse = simple.AMRGaussianPulseSource()
display, first = show_levels(pulse, "Pulse")
low, high = pulse.CellData.GetArray("Gaussian-Pulse").GetRange()
check(low < display.DSMIsoValue < high, f"Pulse: isovalue {display.DSMIsoValue} is chosen")
_, several = show_levels(pulse, "PulseSeveral", "Gaussian-Pulse", [0.05, 0.15, 0.3])
check((several != first).any(), "Pulse: several isovalues")
# Blocks are chosen by their levels. Where finer ones are hidden, coarser ones are there.
chosen = {}
for name, path in (("Coarse", "/Root/Level0"), ("Fine", "/Root/Level1")):
    display.BlockSelectors = [path]
    chosen[name] = render(view, f"Pulse{name}")
for name, pixels in chosen.items():
    part = get_covered(pixels).sum() / get_covered(several).sum()
    check(0.85 < part < 1.0 and (pixels != several).any(), f"Pulse: {name} levels alone: {part} of all")
check((chosen["Coarse"] != chosen["Fine"]).any(), "Pulse: levels differ")
display.BlockSelectors = ["/"]
display.BlockColors = ["/Root", "1", "0", "0"]
check((render(view)[get_covered(several)][:, 1:] < 60).all(), "Pulse: all is red")
display.BlockColors = []
check_equal(render(view), several, "Pulse: all levels again")
with Messages() as messages:
    simple.ColorBy(display, ("CELLS", "Centroid"))
    render(view)
colored = render(view, "PulseColors")
check(not messages.text.strip(), f"Pulse: colors without a message: {messages.text.strip()}")
check((colored != several).any(), "Pulse: colors by another array")

# Slices are in the middle of all levels, whatever the ghost cells, until they are placed.
INDICES = [f"DSMSlice{axis}Index" for axis in "XYZ"]


def check_slices(name, expected):
    with Messages() as messages:
        render(view)
    pixels = render(view, name)
    indices = [display.GetPropertyValue(index) for index in INDICES]
    check(indices == expected and not messages.text.strip(), f"{name}: slices {indices}: {messages.text.strip()}")
    return pixels


display.Representation = "DSM Slices"
check_slices("PulseSlices", [2, 2, 2])
simple.Hide(pulse, view)
if get_ranks() == 1:  # with several, ParaView's source crashes
    fractal = simple.HierarchicalFractal(TwoDimensional=0, MaximumLevel=2, GhostLevels=0)
    display = simple.Show(fractal, view)
    display.Representation = "DSM Slices"
    simple.ColorBy(display, ("CELLS", "TestX"))
    check_slices("Slices", [5, 5, 5])
    place_camera(view)
    without = check_slices("Slices", [5, 5, 5])
    fractal.GhostLevels = 1
    ghosts = check_slices("SlicesOfGhosts", [5, 5, 5])  # the source's values are other ones
    moved = (get_covered(ghosts) != get_covered(without)).mean()
    # ParaView 6.1's source has bounds that are rounded otherwise with ghost cells.
    check(moved < 0.0005, f"slices are where they are without ghost cells, but for {moved:.5f} of the pixels")
    ranges = [display.GetProperty(index).GetDomain("range").GetMaximum(0) for index in INDICES]
    check(ranges == [10] * 3, f"slices to {ranges}")
    fractal.Dimensions = 14
    check_slices("SlicesOfOther", [7, 7, 7])
    display.DSMSliceXIndex = 3
    fractal.Dimensions = 10
    check_slices("SlicesPlaced", [3, 5, 5])
    simple.Delete(fractal)

trees = simple.HyperTreeGridRandom()
show_levels(trees, "Trees", is_recorded=False)  # its values depend on the number of ranks
simple.Hide(trees, view)

# Blocks of several kinds: isosurfaces of some, the surface of the others.
RECTILINEAR = """
from vtkmodules.util.numpy_support import numpy_to_vtk
import numpy as np
image, grid = self.GetInputDataObject(0, 0), self.GetOutputDataObject(0)
extent = image.GetExtent()
grid.SetExtent(extent)
for axis, set in enumerate((grid.SetXCoordinates, grid.SetYCoordinates, grid.SetZCoordinates)):
    place = np.arange(extent[2 * axis], extent[2 * axis + 1] + 1.0)
    set(numpy_to_vtk(place + 0.02 * place * abs(place) + (20.0 if axis == 0 else 0.0), deep=True))
grid.GetPointData().ShallowCopy(image.GetPointData())
"""
# A tree's values depend on its place, and not on the number of ranks.
NAMED = """
from vtkmodules.vtkCommonCore import vtkDoubleArray
from vtkmodules.vtkCommonDataModel import vtkHyperTreeGridNonOrientedGeometryCursor
out = self.GetOutputDataObject(0)
out.DeepCopy(self.GetInputDataObject(0, 0))
values = vtkDoubleArray()
values.SetName('RTData')
values.SetNumberOfTuples(out.GetNumberOfElements(1))
cursor = vtkHyperTreeGridNonOrientedGeometryCursor()
def walk(walk, cursor, values):
    place = [0.0] * 3
    cursor.GetPoint(place)
    x, y, z = place
    values.SetTuple1(cursor.GetGlobalNodeIndex(), 30.0 * (x * x + (y - 20.0) ** 2 + z * z) ** 0.5)
    for child in range(0 if cursor.IsLeaf() else cursor.GetNumberOfChildren()):
        cursor.ToChild(child)
        walk(walk, cursor, values)
        cursor.ToParent()
for tree in range(out.GetMaxNumberOfTrees()):
    if out.GetTree(tree):
        out.InitializeNonOrientedGeometryCursor(cursor, tree)
        walk(walk, cursor, values)
out.GetCellData().AddArray(values)
"""
wavelet = simple.Wavelet(WholeExtent=[-8, 8] * 3)
rectilinear = simple.ProgrammableFilter(Input=wavelet, OutputDataSetType="vtkRectilinearGrid", Script=RECTILINEAR)
few = simple.HyperTreeGridRandom(Dimensions=[6] * 3, OutputBounds=[-8, 8, 12, 28, -8, 8], MaxDepth=3)
named = simple.ProgrammableFilter(Input=few, OutputDataSetType="vtkHyperTreeGrid", CopyArrays=0, Script=NAMED)
sphere = simple.Sphere(Center=[20, 20, 0], Radius=6)


def show_blocks(name, sources, default):
    group = simple.GroupDatasets(Input=sources)
    with Messages() as messages:
        display = show_traced(group, view)
        check(display.DSMShow == default, f"{name}: shows its {display.DSMShow}")
        display.DSMShow, display.DSMIsoArray, display.DSMIsoValues = "Isosurfaces", ["POINTS", "RTData"], [150.0]
        render(view)  # the bounds of trees are known then
        place_camera(view)
        # Several ranks have other random trees since ParaView 6.
        is_alike = named not in sources or simple.GetParaViewVersion().major < 6
        together = render(view, name if is_alike else None)
        hierarchy = group.GetDataInformation().DataInformation.GetHierarchy()
        paths = [f"/Root/{hierarchy.GetNodeName(node)}" for node in hierarchy.GetChildNodes(0)]
        for hidden in range(len(sources)):
            display.BlockSelectors = paths[:hidden] + paths[hidden + 1:]
            left = render(view)
            changed = (abs(left - together).max(axis=2) > 3).mean()
            check(0.01 < changed < 0.2, f"{name}: block {hidden} is hidden in {changed} of the picture")
        display.BlockSelectors = ["/"]
        colors = (["1", "0", "0"], ["0", "1", "0"], ["0", "0", "1"], ["1", "1", "0"])
        display.BlockColors = [word for path, color in zip(paths, colors) for word in [path] + color]
        display.BlockOpacities = [paths[0], "0.4", paths[-1], "0.3"]
        render(view, name + "Colors" if is_alike else None)
        display.BlockColors, display.BlockOpacities = [], []
        simple.ColorBy(display, ("POINTS", "Normals"))  # of the sphere only
        render(view)
        display.ColorArrayName = [None, ""]
        check_equal(render(view), together, f"{name}: all blocks, in one color")
        simple.Hide(group, view)
    reports = [word for word in ("Warning:", "ERROR:") if word in messages.text]
    check(not reports, f"{name}: no message: {messages.text if reports else ''}")
    for source in sources:
        if source is sphere:
            show_traced(source, view)
        else:
            show(source, view, [150.0], "RTData")
    check_equal(render(view), together, f"{name}: as apart")
    for source in sources:
        simple.Hide(source, view)


show_blocks("Blocks", [wavelet, rectilinear, sphere], "Surface")
show_blocks("BlocksWithTrees", [wavelet, rectilinear, named, sphere], "Isosurfaces")
