// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMPart.h"

#include "vtkDSMContent.h"

#include "vtkBoundingBox.h"

#include <cstdint>
#include <limits>
#include <utility>

vtkDSMPart::vtkDSMPart(std::shared_ptr<vtkDSMRankGroup> group)
  : Group(std::move(group))
  , Lower(std::numeric_limits<double>::infinity())
  , Upper(-std::numeric_limits<double>::infinity())
{
}

vtkDSMPart::~vtkDSMPart() = default;

void vtkDSMPart::AddBounds(vtkBoundingBox& bounds) const
{
  for (int corner = 0; corner < 8 && this->Lower.x <= this->Upper.x; ++corner)
  {
    const glm::dvec4 point = this->IndexToData *
      glm::dvec4(corner & 1 ? this->Upper.x : this->Lower.x,
        corner & 2 ? this->Upper.y : this->Lower.y, corner & 4 ? this->Upper.z : this->Lower.z,
        1.0);
    bounds.AddPoint(point.x, point.y, point.z);
  }
}

void vtkDSMPart::AddArray(vtkAbstractArray* array, bricks::ByteHash& hash) const
{
  const std::uint64_t value =
    vtkDSMContent::Hash(array, this->Group->GetStore().GetSettings().Workers);
  hash.Add(&value, sizeof(value));
}

bool vtkDSMPart::MayTakeOver(const vtkDSMPartValues&) const
{
  return false;
}

vtkDSMPart::OwnCells vtkDSMPart::FindOwnCells(const vtkDSMPartValues&, const Choice&) const
{
  return {};
}

vtkDSMPart::OwnGrids vtkDSMPart::FindOwnGrids(const Choice&) const
{
  return {};
}

std::shared_ptr<vtkDSMPartValues> vtkDSMPart::PublishCoarser(
  const vtkDSMPartValues&, int, const Request&) const
{
  return nullptr;
}

vtkDSMPart::Boxed vtkDSMPart::PublishBoxes(
  const vtkDSMPartValues&, const vtkDSMNestedLevels::Boxes&, const Request&, const Boxed&) const
{
  return {};
}
