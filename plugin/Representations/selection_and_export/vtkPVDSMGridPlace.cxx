// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMGridPlace.h"

#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkMatrix3x3.h"
#include "vtkRectilinearGrid.h"

#include <algorithm>

namespace
{

/// The number of planes before a place, and the part of a cell behind the last of these.
double FindAmong(vtkDataArray* planes, double place)
{
  vtkIdType low = 0;
  vtkIdType high = planes->GetNumberOfTuples() - 1;
  if (high < 1)
  {
    return 0.0;
  }
  const bool rises = planes->GetComponent(high, 0) > planes->GetComponent(low, 0);
  while (high - low > 1)
  {
    const vtkIdType middle = (low + high) / 2;
    const double at = planes->GetComponent(middle, 0);
    ((rises ? at <= place : at >= place) ? low : high) = middle;
  }
  const double before = planes->GetComponent(low, 0);
  return static_cast<double>(low) + (place - before) / (planes->GetComponent(high, 0) - before);
}

} // namespace

vtkDataSet* vtkPVDSMGridPlace::FindImage(vtkDataObject* data)
{
  vtkDataSet* const image = vtkDataSet::SafeDownCast(data);
  const bool isImage = vtkImageData::SafeDownCast(data) || vtkRectilinearGrid::SafeDownCast(data);
  return isImage && image->GetNumberOfCells() > 0 ? image : nullptr;
}

const int* vtkPVDSMGridPlace::GetExtent(vtkDataSet* image)
{
  auto* const grid = vtkRectilinearGrid::SafeDownCast(image);
  return grid ? grid->GetExtent() : vtkImageData::SafeDownCast(image)->GetExtent();
}

bool vtkPVDSMGridPlace::HaveOneLattice(vtkDataSet* a, vtkDataSet* b)
{
  auto* const one = vtkImageData::SafeDownCast(a);
  auto* const other = vtkImageData::SafeDownCast(b);
  if (!one || !other)
  {
    // Rectilinear grids are searched by coordinates.
    return !one && !other;
  }
  const double* const directions[2] = { one->GetDirectionMatrix()->GetData(),
    other->GetDirectionMatrix()->GetData() };
  return std::equal(one->GetOrigin(), one->GetOrigin() + 3, other->GetOrigin()) &&
    std::equal(one->GetSpacing(), one->GetSpacing() + 3, other->GetSpacing()) &&
    std::equal(directions[0], directions[0] + 9, directions[1]);
}

void vtkPVDSMGridPlace::Find(vtkDataSet* image, const double point[3], double place[3])
{
  if (auto* const grid = vtkRectilinearGrid::SafeDownCast(image))
  {
    place[0] = FindAmong(grid->GetXCoordinates(), point[0]);
    place[1] = FindAmong(grid->GetYCoordinates(), point[1]);
    place[2] = FindAmong(grid->GetZCoordinates(), point[2]);
    return;
  }
  vtkImageData::SafeDownCast(image)->TransformPhysicalPointToContinuousIndex(point, place);
  for (int axis = 0; axis < 3; ++axis)
  {
    place[axis] -= GetExtent(image)[2 * axis];
  }
}
