// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMImagePiece.h"

#include "DSMBricks/base/ByteHash.h"
#include "DSMRayTracing/look/PackedColor.h"
#include "vtkDSMColorBytes.h"
#include "vtkDSMFileArray.h"
#include "vtkDSMScalarType.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkDataSetAttributes.h"
#include "vtkImageData.h"
#include "vtkMatrix3x3.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkRectilinearGrid.h"
#include "vtkSOADataArrayTemplate.h"
#include "vtkScalarsToColors.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

namespace
{

using bricks::Box;
using bricks::Index3;

constexpr unsigned char HiddenCells =
  vtkDataSetAttributes::HIDDENCELL | vtkDataSetAttributes::REFINEDCELL;

vtkUnsignedCharArray* GetGhosts(vtkDataSetAttributes* attributes)
{
  return vtkUnsignedCharArray::SafeDownCast(
    attributes->GetAbstractArray(vtkDataSetAttributes::GhostArrayName()));
}

/// The image's cells in its own indices.
Box GetCellBox(vtkDataSet* image)
{
  int extent[6];
  vtkDSMImagePiece::GetExtent(image, extent);
  return { { extent[0], extent[2], extent[4] }, { extent[1], extent[3], extent[5] } };
}

/// Which cells of an image hold data, from its ghost arrays.
class CellFlags
{
public:
  explicit CellFlags(vtkDataSet* image)
    : Box(GetCellBox(image))
    , Cells(GetGhosts(image->GetCellData()))
    , Points(GetGhosts(image->GetPointData()))
  {
  }
  bool IsTrivial() const { return !this->Cells && !this->Points; }
  bool IsDuplicate(const Index3& cell) const
  {
    return this->Cells &&
      (this->Cells->GetValue(this->GetCellId(cell)) & vtkDataSetAttributes::DUPLICATECELL);
  }
  bool HoldsData(const Index3& cell) const
  {
    return !this->IsDuplicate(cell) && this->IsVisible(cell);
  }
  bool IsVisible(const Index3& cell, unsigned char hidden = HiddenCells) const
  {
    if (this->Cells && (this->Cells->GetValue(this->GetCellId(cell)) & hidden))
    {
      return false;
    }
    if (this->Points)
    {
      for (int corner = 0; corner < 8; ++corner)
      {
        const Index3 point = cell + Index3(corner & 1, (corner >> 1) & 1, corner >> 2);
        if (this->Points->GetValue(this->GetPointId(point)) & vtkDataSetAttributes::HIDDENPOINT)
        {
          return false;
        }
      }
    }
    return true;
  }

private:
  vtkIdType GetCellId(const Index3& cell) const
  {
    const Index3 size = this->Box.GetSize();
    const Index3 at = cell - this->Box.Min;
    return at.x + size.x * (at.y + size.y * at.z);
  }
  vtkIdType GetPointId(const Index3& point) const
  {
    const Index3 size = this->Box.GetSize() + Index3(1);
    const Index3 at = point - this->Box.Min;
    return at.x + size.x * (at.y + size.y * at.z);
  }

  bricks::Box Box;
  vtkUnsignedCharArray* Cells;
  vtkUnsignedCharArray* Points;
};

/// The box of the cells that are not copies of another piece's.
Box TrimDuplicates(const Box& cells, const CellFlags& flags)
{
  Box own{ cells.Max, cells.Min };
  ForEachIndex(cells,
    [&](const Index3& cell)
    {
      if (!flags.IsDuplicate(cell))
      {
        own.Min = glm::min(own.Min, cell);
        own.Max = glm::max(own.Max, cell + Index3(1));
      }
    });
  return own.IsEmpty() ? Box{ cells.Min, cells.Min } : own;
}

/// Calls `read(tuple)` for every sample of `points` and stores what it returns as T.
template <class T, class Read>
void Gather(const Box& points, const Box& image, std::byte* out, Read&& read)
{
  T* target = reinterpret_cast<T*>(out);
  const Index3 size = image.GetSize();
  for (std::int64_t k = points.Min.z; k < points.Max.z; ++k)
  {
    for (std::int64_t j = points.Min.y; j < points.Max.y; ++j)
    {
      const vtkIdType row = size.x * ((j - image.Min.y) + size.y * (k - image.Min.z));
      for (std::int64_t i = points.Min.x; i < points.Max.x; ++i)
      {
        *target++ = static_cast<T>(read(row + (i - image.Min.x)));
      }
    }
  }
}

/// The same where the values are in a file.
template <class Native>
void GatherFromFile(const vtkDSMFileValues& values, int component, const Box& points,
  const Box& image, std::byte* out)
{
  const Box part{ points.Min - image.Min, points.Max - image.Min };
  const int components = values.GetArray().Components;
  if (components == 1)
  {
    values.ReadBox(part, out);
    return;
  }
  std::vector<Native> samples(static_cast<std::size_t>(part.GetCount() * components));
  values.ReadBox(part, reinterpret_cast<std::byte*>(samples.data()));
  auto* target = reinterpret_cast<Native*>(out);
  for (std::int64_t sample = 0; sample < part.GetCount(); ++sample)
  {
    target[sample] = samples[static_cast<std::size_t>(sample * components + component)];
  }
}

/// One component as it is; Native is the array's C++ type, which the brick's type represents.
template <class Native>
void GatherComponent(
  vtkDataArray* array, int component, const Box& points, const Box& image, std::byte* out)
{
  const int components = array->GetNumberOfComponents();
  if (const vtkDSMFileValues* values = vtkDSMGetFileValues(array, image.GetSize()))
  {
    GatherFromFile<Native>(*values, component, points, image, out);
  }
  else if (auto* soa = dynamic_cast<vtkSOADataArrayTemplate<Native>*>(array))
  {
    Gather<Native>(points, image, out,
      [=](vtkIdType tuple) { return soa->GetTypedComponent(tuple, component); });
  }
  else if (array->HasStandardMemoryLayout())
  {
    const auto* values = static_cast<const Native*>(array->GetVoidPointer(0)) + component;
    Gather<Native>(points, image, out, [=](vtkIdType tuple) { return values[tuple * components]; });
  }
  else
  {
    Gather<Native>(
      points, image, out, [=](vtkIdType tuple) { return array->GetComponent(tuple, component); });
  }
}

void ReadColors(vtkDataArray* array, const Box& all, const Box& samples, std::byte* out)
{
  vtkSmartPointer<vtkDataArray> values;
  values.TakeReference(array->NewInstance());
  values->SetNumberOfComponents(array->GetNumberOfComponents());
  values->SetNumberOfTuples(samples.GetCount());
  const Index3 size = all.GetSize();
  const std::int64_t row = samples.GetSize().x;
  vtkIdType target = 0;
  for (std::int64_t k = samples.Min.z; k < samples.Max.z; ++k)
  {
    for (std::int64_t j = samples.Min.y; j < samples.Max.y; ++j, target += row)
    {
      const Index3 first = Index3(samples.Min.x, j, k) - all.Min;
      values->InsertTuples(target, row, first.x + size.x * (first.y + size.y * first.z), array);
    }
  }
  vtkNew<vtkScalarsToColors> conversion;
  vtkSmartPointer<vtkUnsignedCharArray> colors;
  colors.TakeReference(
    conversion->MapScalars(vtkDSMColorBytes::Convert(values), VTK_COLOR_MODE_DIRECT_SCALARS, 0));
  for (std::int64_t sample = 0; sample < samples.GetCount(); ++sample)
  {
    const std::uint32_t packed = rt::PackedColor::Make(colors->GetPointer(4 * sample));
    std::memcpy(out + sample * sizeof(packed), &packed, sizeof(packed));
  }
}

} // namespace

vtkDataSet* vtkDSMImagePiece::FindImage(vtkDataObject* data)
{
  return vtkImageData::SafeDownCast(data) || vtkRectilinearGrid::SafeDownCast(data)
    ? vtkDataSet::SafeDownCast(data)
    : nullptr;
}

void vtkDSMImagePiece::GetExtent(vtkDataSet* image, int extent[6])
{
  auto* const grid = vtkRectilinearGrid::SafeDownCast(image);
  const int* const own = grid ? grid->GetExtent() : vtkImageData::SafeDownCast(image)->GetExtent();
  std::copy_n(own, 6, extent);
}

bricks::GridPlanes::Coordinates vtkDSMImagePiece::GetCoordinates(
  vtkDataSet* image, const bricks::PieceInfo& info)
{
  bricks::GridPlanes::Coordinates coordinates;
  auto* const grid = vtkRectilinearGrid::SafeDownCast(image);
  if (!grid)
  {
    return coordinates;
  }
  vtkDataArray* const arrays[3] = { grid->GetXCoordinates(), grid->GetYCoordinates(),
    grid->GetZCoordinates() };
  const int* const extent = grid->GetExtent();
  for (int axis = 0; axis < 3; ++axis)
  {
    for (std::int64_t plane = info.Min[axis]; plane <= info.Max[axis]; ++plane)
    {
      coordinates[axis].push_back(arrays[axis]->GetComponent(plane - extent[2 * axis], 0));
    }
  }
  return coordinates;
}

bricks::PieceInfo vtkDSMImagePiece::Describe(vtkDataSet* image, int leaf)
{
  bricks::PieceInfo info{};
  if (auto* const uniform = vtkImageData::SafeDownCast(image))
  {
    uniform->GetOrigin(info.Origin);
    uniform->GetSpacing(info.Spacing);
    std::copy_n(uniform->GetDirectionMatrix()->GetData(), 9, info.Direction);
  }
  info.Leaf = leaf;
  Box cells = GetCellBox(image);
  const CellFlags flags(image);
  if (!cells.IsEmpty() && !flags.IsTrivial())
  {
    cells = TrimDuplicates(cells, flags);
    bool complete = true;
    ForEachIndex(cells, [&](const Index3& cell) { complete = complete && flags.HoldsData(cell); });
    info.HasMask = complete ? 0 : 1;
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    info.Min[axis] = cells.Min[axis];
    info.Max[axis] = cells.Max[axis];
  }
  bricks::ByteHash hash;
  for (const std::vector<double>& planes : GetCoordinates(image, info))
  {
    hash.Add(planes.data(), planes.size() * sizeof(double));
  }
  info.Coordinates = vtkRectilinearGrid::SafeDownCast(image) ? hash.Get() | 1 : 0;
  return info;
}

std::vector<std::uint8_t> vtkDSMImagePiece::FindShown(vtkDataSet* image, const Box& cells)
{
  std::vector<std::uint8_t> shown;
  shown.reserve(static_cast<std::size_t>(cells.GetCount()));
  const CellFlags flags(image);
  ForEachIndex(cells,
    [&](const Index3& cell)
    {
      const bool isShown =
        !flags.IsDuplicate(cell) && flags.IsVisible(cell, vtkDataSetAttributes::HIDDENCELL);
      shown.push_back(isShown ? 1 : 0);
    });
  return shown;
}

double vtkDSMImagePiece::GetMagnitude(vtkDataArray* array, vtkIdType tuple)
{
  double sum = 0.0;
  for (int component = 0; component < array->GetNumberOfComponents(); ++component)
  {
    const double value = array->GetComponent(tuple, component);
    sum += value * value;
  }
  return std::sqrt(sum);
}

bricks::ScalarType vtkDSMImagePiece::GetScalarType(vtkDataArray* array, int component)
{
  if (component == Color)
  {
    return bricks::ScalarType::UInt32;
  }
  const bricks::ScalarType type = array->GetDataType() == VTK_BIT
    ? bricks::ScalarType::UInt8
    : vtkDSMScalarType::FromArray(array);
  if (component == Magnitude && array->GetNumberOfComponents() > 1)
  {
    const bool fits = type == bricks::ScalarType::Float32 || bricks::GetBytes(type) <= 2;
    return fits ? bricks::ScalarType::Float32 : bricks::ScalarType::Float64;
  }
  return type;
}

vtkDSMImagePiece::vtkDSMImagePiece(vtkDataSet* image, vtkDataArray* array, int component,
  const bricks::LatticePlan::Member& place, bool hasMask, bool ofCells)
  : Image(image)
  , Array(array)
  , Component(array->GetNumberOfComponents() == 1 && component != Color ? 0 : component)
  , Place(place)
  , Masked(hasMask)
  , Samples(GetCellBox(image))
{
  this->Samples.Min += place.IndexToLattice;
  this->Samples.Max += place.IndexToLattice + Index3(ofCells ? 0 : 1);
}

vtkDSMImagePiece::~vtkDSMImagePiece() = default;

void vtkDSMImagePiece::ReadSamples(const Box& points, std::byte* out) const
{
  ReadSamples(this->Array, this->Component, this->Samples, points, out);
}

void vtkDSMImagePiece::ReadSamples(
  vtkDataArray* array, int component, const Box& all, const Box& part, std::byte* out)
{
  if (component == Color)
  {
    ReadColors(array, all, part, out);
    return;
  }
  if (component == Magnitude)
  {
    const auto read = [array](vtkIdType tuple) { return GetMagnitude(array, tuple); };
    if (GetScalarType(array, component) == bricks::ScalarType::Float32)
    {
      Gather<float>(part, all, out, read);
    }
    else
    {
      Gather<double>(part, all, out, read);
    }
    return;
  }
  if (array->GetDataType() == VTK_BIT)
  {
    Gather<std::uint8_t>(
      part, all, out, [&](vtkIdType tuple) { return array->GetComponent(tuple, component); });
    return;
  }
  switch (array->GetDataType())
  {
    vtkTemplateMacro((GatherComponent<VTK_TT>(array, component, part, all, out)));
  }
}

void vtkDSMImagePiece::ReadCellMask(const Box& cells, std::uint8_t* out) const
{
  const CellFlags flags(this->Image);
  ForEachIndex(cells,
    [&](const Index3& cell)
    { *out++ = flags.HoldsData(cell - this->Place.IndexToLattice) ? 1 : 0; });
}

void vtkDSMImagePiece::ReadCellStates(const Box& cells, std::uint8_t* out) const
{
  const CellFlags flags(this->Image);
  ForEachIndex(cells,
    [&](const Index3& cell)
    {
      const Index3 own = cell - this->Place.IndexToLattice;
      using State = bricks::CellReader::State;
      *out++ = !flags.IsVisible(own) ? State::NoData
        : flags.IsDuplicate(own)     ? State::Copy
                                     : State::Own;
    });
}
