# SPDX-License-Identifier: BSD-3-Clause
"""Every scalar type of VTK, and arrays that are not laid out as usual."""

from dsm_testing import *

load_plugin()
view = create_view()

TYPED = """
from vtkmodules.vtkCommonCore import vtkDataArray
image.SetExtent(piece)
array = vtkDataArray.CreateDataArray({type})
values = np.round(100.0 * distance(piece)).clip(0, 127)
array.SetNumberOfTuples(len(values)); array.SetName('f')
for index, value in enumerate(values):
    array.SetTuple1(index, value)
image.GetPointData().SetScalars(array)
"""
# VTK_CHAR, SIGNED_CHAR, UNSIGNED_CHAR, SHORT, ..., LONG_LONG, UNSIGNED_LONG_LONG, ID_TYPE
for type_ in (2, 15, 3, 4, 5, 6, 7, 8, 9, 10, 11, 16, 17, 12):
    typed = image_source(TYPED.format(type=type_), (0, 12) * 3)
    compare_with_triangles(view, f"Type{type_}", typed, [80.5], share=0.01)

compare_with_triangles(
    view,
    "StructureOfArrays",
    image_source(
        """
from vtkmodules.vtkCommonCore import vtkSOADataArrayTemplate
image.SetExtent(piece)
values = distance(piece)
array = vtkSOADataArrayTemplate['float64']()
array.SetNumberOfComponents(1); array.SetNumberOfTuples(len(values)); array.SetName('f')
for index, value in enumerate(values):
    array.SetTuple1(index, value)
image.GetPointData().SetScalars(array)
"""
    ),
)

# Values that the user declares missing are as NaN: in each array those of one half of the ball, or of its cells.
MISSING = """
image.SetExtent(piece)
i, j, k = points(piece)
values = np.round(100.0 * distance(piece)).clip(0, 127)
isMissing = i + 0.3 * j > 14.0
def put(name, type_, missing):
    changed = values.astype(type_)
    changed[isMissing] = missing
    add(image, changed, name)
put('nan', 'f4', np.nan); put('giant', 'f4', 1e20); put('double', 'f8', -9999.0)
put('short', 'i2', -9999); put('byte', 'u1', 255)
n = [piece[2 * axis + 1] - piece[2 * axis] for axis in range(3)]
corner = [p.reshape([size + 1 for size in reversed(n)])[:-1, :-1, :-1].ravel() for p in (i, j, k, values)]
isHidden = corner[0] + 0.3 * corner[1] > 14.0
from vtkmodules.vtkCommonDataModel import vtkDataSetAttributes
if HIDES:
    ghosts = numpy_to_vtk(np.where(isHidden, vtkDataSetAttributes.HIDDENCELL, 0).astype('u1'), deep=True)
    ghosts.SetName('vtkGhostType')
    image.GetCellData().AddArray(ghosts)
for name, type_, missing in (('cells', 'f4', 1e20), ('short cells', 'i2', 1000)):
    cells = numpy_to_vtk(np.where(isHidden, missing, corner[3]).astype(type_), deep=True)
    cells.SetName(name)
    image.GetCellData().AddArray(cells)
"""
missing = image_source(f"HIDES = False\n{MISSING}")
hidden = image_source(f"HIDES = True\n{MISSING}")
IGNORED = {"DSMIgnoreValues": 1, "DSMValidRange": [-1.0, 200.0]}


def picture_missing(source, array, kind, name=None, **properties):
    """The picture, and the isovalue that the data suggest."""
    display = simple.Show(source, view)
    display.Representation = kind
    simple.ColorBy(display, array)
    colors = simple.GetColorTransferFunction(array[1])
    colors.RescaleTransferFunction(0.0, 127.0)
    simple.GetOpacityTransferFunction(array[1]).RescaleTransferFunction(0.0, 127.0)
    display.SetScalarBarVisibility(view, False)
    display.ScalarOpacityUnitDistance = 1.7  # by default it depends on the number of ranks
    for name_, value in {"DSMIsoArray": array, "DSMIsoValues": [80.5], "DSMIgnoreValues": 0, **properties}.items():
        setattr(display, name_, value)
    place_camera(view, (1.0, 0.5, 0.6))
    pixels = render(view, name)
    display.DSMIsoValues = []
    simple.Render(view)
    display.UpdatePropertyInformation()
    suggested = display.GetPropertyValue("DSMSuggestedIsoValue") if kind == REPRESENTATION else None
    simple.Hide(source, view)
    return pixels, suggested


for kind in (REPRESENTATION, "DSM Volume", "DSM Slices"):
    # Slices show NaN in the color map's color for it; what is ignored is not there.
    is_sliced = kind == "DSM Slices"
    # Ranges of macrocells differ a little beside what is missing, and so does where a volume is integrated finely.
    tolerance = 2 if kind == "DSM Volume" else 1
    reference = ("giant", IGNORED) if is_sliced else ("nan", {})
    expected, suggested = picture_missing(missing, ("POINTS", reference[0]), kind, f"Missing {kind}", **reference[1])
    check(0.03 < get_covered(expected).mean() < 0.3, f"{kind}: a part is shown")
    for array in ("giant", "double", "short", "byte"):
        shell, _ = picture_missing(missing, ("POINTS", array), kind)
        check((shell != expected).any(), f"{kind}, {array}: values that are not ignored are there")
        traced, found = picture_missing(missing, ("POINTS", array), kind, **IGNORED)
        check_equal(traced, expected, f"{kind}, {array}: as NaN", tolerance)
        check(found == suggested, f"{kind}, {array}: the isovalue that NaN suggest: {found}, {suggested}")
    for array in ("cells", "short cells"):
        expected_of_cells, _ = picture_missing(hidden, ("CELLS", array), kind)
        shell, _ = picture_missing(missing, ("CELLS", array), kind)
        check((shell != expected_of_cells).any(), f"{kind}, {array}: values that are not ignored are there")
        traced, _ = picture_missing(missing, ("CELLS", array), kind, **IGNORED)
        check_equal(traced, expected_of_cells, f"{kind}, {array}: as blanked cells")

# The same of cells of several sizes.
NAN_LEAVES = """
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
import numpy as np
data, out = self.GetInputDataObject(0, 0), self.GetOutputDataObject(0)
isTree = data.IsA('vtkHyperTreeGrid')
(out.DeepCopy if isTree else out.RecursiveShallowCopy if IS_OLD else out.ShallowCopy)(data)
parts = [out] if isTree else []
leaf = None if isTree else out.NewIterator()
while leaf and not leaf.IsDoneWithTraversal():
    parts.append(leaf.GetCurrentDataObject())
    leaf.GoToNextItem()
for part in parts:
    values = vtk_to_numpy(part.GetCellData().GetArray(NAME)).astype('f8')
    values[values > HIGHEST] = np.nan
    array = numpy_to_vtk(values, deep=True)
    array.SetName(NAME)
    part.GetCellData().AddArray(array)
"""


def picture_leaves(source, name, isovalue, **properties):
    show_traced(source, view, DSMShow="Isosurfaces", DSMIsoArray=("CELLS", name), DSMIsoValues=[isovalue], **properties)
    simple.Render(view)  # the bounds of trees are known then
    place_camera(view)
    pixels = render(view)
    simple.Hide(source, view)
    return pixels


for create, name, isovalue, highest in (
    (simple.AMRGaussianPulseSource, "Gaussian-Pulse", 0.12, 0.29), (simple.HyperTreeGridRandom, "Depth", 2.5, 4.5)
):
    leaves = create()
    nan = simple.ProgrammableFilter(Input=leaves, CopyArrays=0)
    is_old = simple.GetParaViewVersion() < (5, 12)
    nan.Script = f"NAME, HIGHEST, IS_OLD = {name!r}, {highest}, {is_old}" + NAN_LEAVES
    everything = picture_leaves(leaves, name, isovalue, DSMIgnoreValues=0)
    expected = picture_leaves(nan, name, isovalue)
    traced = picture_leaves(leaves, name, isovalue, DSMIgnoreValues=1, DSMValidRange=[0.0, highest])
    check(get_covered(expected).any() and (everything != expected).any(), f"{name}: a part is shown")
    check_equal(traced, expected, f"{name}: as NaN")
