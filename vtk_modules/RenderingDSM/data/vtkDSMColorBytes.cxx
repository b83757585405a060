// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMColorBytes.h"

#include "vtkDataArray.h"
#include "vtkType.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <vector>

vtkSmartPointer<vtkUnsignedCharArray> vtkDSMColorBytes::Convert(vtkDataArray* colors)
{
  if (auto* const bytes = vtkUnsignedCharArray::SafeDownCast(colors))
  {
    return bytes;
  }
  const int type = colors->GetDataType();
  const double scale = type == VTK_FLOAT || type == VTK_DOUBLE ? 255.0
    : type == VTK_UNSIGNED_SHORT                               ? 1.0 / 257.0
                                                               : 1.0;
  const int components = colors->GetNumberOfComponents();
  auto result = vtkSmartPointer<vtkUnsignedCharArray>::New();
  result->SetNumberOfComponents(components);
  result->SetNumberOfTuples(colors->GetNumberOfTuples());
  std::vector<double> color(static_cast<std::size_t>(components));
  unsigned char* byte = result->GetPointer(0);
  for (vtkIdType tuple = 0; tuple < colors->GetNumberOfTuples(); ++tuple)
  {
    colors->GetTuple(tuple, color.data());
    for (const double value : color)
    {
      // The comparison leaves 0 where the value is not a number.
      const double scaled = value > 0.0 ? std::min(value * scale, 255.0) : 0.0;
      *byte++ = static_cast<unsigned char>(scaled + 0.5);
    }
  }
  return result;
}
