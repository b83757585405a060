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
