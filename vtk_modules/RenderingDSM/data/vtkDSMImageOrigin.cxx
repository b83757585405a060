// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMImageOrigin.h"

#include "DSMBricks/build/LatticePlan.h"
#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/CopyBox.h"
#include "vtkDSMFileArray.h"
#include "vtkDSMGather.h"
#include "vtkDSMScalarType.h"

#include "vtkCellData.h"
#include "vtkImageData.h"
#include "vtkMatrix3x3.h"
#include "vtkPointData.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace
{

bool IsInside(const bricks::Box& box, const bricks::Box& whole)
{
  return bricks::Intersect(box, whole).GetCount() == box.GetCount();
}

std::vector<std::int64_t> GetKey(const bricks::Box& box)
{
  return { box.Min.x, box.Min.y, box.Min.z };
}

/// An array of a piece, as ranks tell one another.
struct ArrayNote
{
  struct Plain
  {
    std::int32_t Type;
    std::int32_t Components;
    std::int32_t OnCells;
    std::int32_t IsActive; ///< the scalars
    std::uint64_t NameBytes;
  };
  Plain Numbers;
  std::string Name;

  bool IsSame(const ArrayNote& other) const
  {
    return this->Numbers.Type == other.Numbers.Type &&
      this->Numbers.Components == other.Numbers.Components &&
      this->Numbers.OnCells == other.Numbers.OnCells && this->Name == other.Name;
  }
};

std::vector<std::byte> Encode(const std::vector<ArrayNote>& notes)
{
  std::vector<std::byte> bytes;
  const auto add = [&](const void* from, std::size_t count)
  {
    const auto* const first = static_cast<const std::byte*>(from);
    bytes.insert(bytes.end(), first, first + count);
  };
  for (const ArrayNote& note : notes)
  {
    add(&note.Numbers, sizeof(note.Numbers));
    add(note.Name.data(), note.Name.size());
  }
  return bytes;
}

/// Throws dsm::Error where the bytes end early.
std::vector<ArrayNote> Decode(const std::vector<std::byte>& bytes)
{
  std::vector<ArrayNote> notes;
  std::size_t at = 0;
  const auto take = [&](void* to, std::uint64_t count)
  {
    if (count > bytes.size() - at)
    {
      throw dsm::Error(
        "A message about the arrays of an image is truncated. Do all ranks run the same build?");
    }
    std::copy_n(bytes.data() + at, count, static_cast<std::byte*>(to));
    at += count;
  };
  while (at < bytes.size())
  {
    ArrayNote& note = notes.emplace_back();
    take(&note.Numbers, sizeof(note.Numbers));
    note.Name.resize(std::min<std::uint64_t>(note.Numbers.NameBytes, bytes.size()));
    take(note.Name.data(), note.Numbers.NameBytes);
  }
  return notes;
}

} // namespace

vtkDSMImageOrigin::vtkDSMImageOrigin(dsm::Messenger& messenger, vtkImageData* image)
  : Messenger(messenger)
{
  const std::vector<vol::FileGeometry> pieces = this->GatherPieces(image);
  this->GatherArrays(image, pieces);
  messenger.RunTogether("Writing a volume", [&] { this->CheckCover(); });
}

std::vector<vol::FileGeometry> vtkDSMImageOrigin::GatherPieces(vtkImageData* image)
{
  vol::FileGeometry mine;
  if (image && image->GetNumberOfPoints() > 0)
  {
    int extent[6];
    image->GetExtent(extent);
    image->GetOrigin(mine.Origin);
    image->GetSpacing(mine.Spacing);
    std::copy_n(image->GetDirectionMatrix()->GetData(), 9, mine.Direction);
    for (int axis = 0; axis < 3; ++axis)
    {
      mine.First[axis] = extent[2 * axis];
      mine.Points[axis] = extent[2 * axis + 1] - extent[2 * axis] + 1;
    }
  }
  const auto pieces = this->Messenger.GatherValueTogether("Writing a volume", [&] { return mine; });
  const auto isThere = [](const vol::FileGeometry& piece) { return piece.Points.x > 0; };
  const auto first = std::find_if(pieces.begin(), pieces.end(), isThere);
  if (first == pieces.end())
  {
    throw dsm::Error("There is nothing to write: the image has no points.");
  }
  this->Geometry = *first;
  bricks::Index3 end = this->Geometry.First + this->Geometry.Points;
  for (const vol::FileGeometry& piece : pieces)
  {
    if (isThere(piece))
    {
      this->Geometry.First = glm::min(this->Geometry.First, piece.First);
      end = glm::max(end, piece.First + piece.Points);
    }
  }
  this->Geometry.Points = end - this->Geometry.First;
  for (const vol::FileGeometry& piece : pieces)
  {
    const bricks::Index3 begin = piece.First - this->Geometry.First;
    const bricks::Index3& points = piece.Points;
    this->PointsOfRanks.push_back(isThere(piece)
        ? bricks::Box{ begin, begin + points }
        : bricks::Box{ bricks::Index3(0), bricks::Index3(0) });
    // Flat images have one cell across, as VTK counts them.
    const bricks::Index3 cells =
      glm::max(points - bricks::Index3(1), glm::min(points, bricks::Index3(1)));
    this->CellsOfRanks.push_back(isThere(piece)
        ? bricks::Box{ begin, begin + cells }
        : bricks::Box{ bricks::Index3(0), bricks::Index3(0) });
  }
  return pieces;
}

void vtkDSMImageOrigin::GatherArrays(
  vtkImageData* image, const std::vector<vol::FileGeometry>& pieces)
{
  std::vector<ArrayNote> mine;
  const auto note = [&](vtkDataSetAttributes* attributes, int onCells, vtkIdType tuples)
  {
    for (int index = 0; index < attributes->GetNumberOfArrays(); ++index)
    {
      const char* const name = attributes->GetArrayName(index);
      vtkDataArray* const array = attributes->GetArray(index);
      if (!name || std::strcmp(name, vtkDataSetAttributes::GhostArrayName()) == 0)
      {
        continue;
      }
      const bool isUsable =
        array && array->GetDataType() != VTK_BIT && array->GetNumberOfTuples() == tuples;
      ArrayNote entry{ {}, name };
      entry.Numbers.Type =
        isUsable ? static_cast<std::int32_t>(vtkDSMScalarType::FromArray(array)) : -1;
      entry.Numbers.Components = isUsable ? array->GetNumberOfComponents() : 0;
      entry.Numbers.OnCells = onCells;
      entry.Numbers.IsActive = array && array == attributes->GetScalars() ? 1 : 0;
      entry.Numbers.NameBytes = entry.Name.size();
      mine.push_back(std::move(entry));
    }
  };
  const bool isThere = image && image->GetNumberOfPoints() > 0;
  if (isThere)
  {
    note(image->GetPointData(), 0, image->GetNumberOfPoints());
    note(image->GetCellData(), 1, image->GetNumberOfCells());
  }
  std::vector<std::vector<ArrayNote>> ofRanks;
  for (const auto& bytes :
    this->Messenger.GatherTogether("Writing a volume", [&] { return Encode(mine); }))
  {
    ofRanks.push_back(Decode(bytes));
  }
  std::size_t first = 0;
  while (pieces[first].Points.x == 0)
  {
    ++first;
  }
  bricks::Index3 cells(1);
  cells = glm::max(this->Geometry.Points - cells, cells);
  for (const ArrayNote& wanted : ofRanks[first])
  {
    bool isEverywhere = wanted.Numbers.Type >= 0;
    for (std::size_t rank = 0; rank < pieces.size(); ++rank)
    {
      const std::vector<ArrayNote>& notes = ofRanks[rank];
      isEverywhere = isEverywhere &&
        (pieces[rank].Points.x == 0 ||
          std::any_of(
            notes.begin(), notes.end(), [&](const ArrayNote& one) { return one.IsSame(wanted); }));
    }
    if (!isEverywhere)
    {
      this->LeftOut.emplace_back(wanted.Name);
      continue;
    }
    vol::FileArray array;
    array.Name = wanted.Name;
    array.Type = static_cast<bricks::ScalarType>(wanted.Numbers.Type);
    array.Components = wanted.Numbers.Components;
    array.OnCells = wanted.Numbers.OnCells != 0;
    array.IsActive = wanted.Numbers.OnCells == 0 && wanted.Numbers.IsActive != 0;
    array.Grid.Samples = array.OnCells ? cells : this->Geometry.Points;
    this->Arrays.push_back(array);
    vtkDataSetAttributes* attributes = nullptr;
    if (isThere)
    {
      attributes = image->GetPointData();
      attributes = array.OnCells ? image->GetCellData() : attributes;
    }
    this->Values.emplace_back(attributes ? attributes->GetArray(wanted.Name.c_str()) : nullptr);
  }
  if (this->Arrays.empty())
  {
    throw dsm::Error(
      "There is nothing to write: the pieces of the image have no numeric array in common.");
  }
}

void vtkDSMImageOrigin::CheckCover() const
{
  for (std::size_t array = 0; array < this->Arrays.size(); ++array)
  {
    const bricks::Box whole{ bricks::Index3(0), this->Arrays[array].Grid.Samples };
    if (!bricks::LatticePlan::IsCovered(whole, this->GetPieces(array)))
    {
      throw dsm::Error("The array '" + this->Arrays[array].Name +
        "' cannot be written: the pieces of the image do not fill their bounding box. Apply "
        "Resample To Image first.");
    }
  }
}

std::string vtkDSMImageOrigin::Describe() const
{
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return "values of process " + std::to_string(getpid()) + " at " + std::to_string(now.count());
}

std::vector<int> vtkDSMImageOrigin::Deal(std::size_t array, const std::vector<bricks::Box>& boxes)
{
  const char* const what = "Writing a volume";
  const std::vector<bricks::Box>& pieces = this->GetPieces(array);
  const std::size_t sampleBytes = this->Arrays[array].GetSampleBytes();
  const int rank = this->Messenger.GetRank();
  std::vector<int> dealt;
  std::vector<std::size_t> shared;
  // For a box that lies in no single piece, every rank contributes its part.
  const auto parts = this->Messenger.GatherTogether(what,
    [&]
    {
      this->Gathered.clear();
      std::vector<std::byte> mine;
      for (std::size_t box = 0; box < boxes.size(); ++box)
      {
        std::vector<int> owners;
        for (std::size_t one = 0; one < pieces.size(); ++one)
        {
          if (IsInside(boxes[box], pieces[one]))
          {
            owners.push_back(static_cast<int>(one));
          }
        }
        if (!owners.empty())
        {
          dealt.push_back(owners[box % owners.size()]);
          continue;
        }
        dealt.push_back(static_cast<int>(box % pieces.size()));
        shared.push_back(box);
        const bricks::Box own =
          bricks::Intersect(boxes[box], pieces[static_cast<std::size_t>(rank)]);
        if (!own.IsEmpty())
        {
          const std::size_t first = mine.size();
          mine.resize(first + static_cast<std::size_t>(own.GetCount()) * sampleBytes);
          this->Copy(array, own, &mine[first]);
        }
      }
      return mine;
    });
  this->Messenger.RunTogether(what,
    [&]
    {
      std::vector<std::size_t> at(parts.size(), 0);
      for (const std::size_t box : shared)
      {
        std::vector<std::byte>* const whole =
          dealt[box] == rank ? &this->Gathered[GetKey(boxes[box])] : nullptr;
        if (whole)
        {
          whole->resize(static_cast<std::size_t>(boxes[box].GetCount()) * sampleBytes);
        }
        for (std::size_t one = 0; one < parts.size(); ++one)
        {
          const bricks::Box part = bricks::Intersect(boxes[box], pieces[one]);
          if (part.IsEmpty())
          {
            continue;
          }
          if (whole)
          {
            vol::CopyBox(
              part, parts[one].data() + at[one], part, whole->data(), boxes[box], sampleBytes);
          }
          at[one] += static_cast<std::size_t>(part.GetCount()) * sampleBytes;
        }
      }
    });
  return dealt;
}

void vtkDSMImageOrigin::Read(std::size_t array, const bricks::Box& box, std::byte* out) const
{
  const auto gathered = this->Gathered.find(GetKey(box));
  if (gathered == this->Gathered.end())
  {
    this->Copy(array, box, out);
    return;
  }
  std::copy(gathered->second.begin(), gathered->second.end(), out);
}

void vtkDSMImageOrigin::Copy(std::size_t array, const bricks::Box& box, std::byte* out) const
{
  vtkDataArray* const values = this->Values[array];
  const bricks::Box& piece =
    this->GetPieces(array)[static_cast<std::size_t>(this->Messenger.GetRank())];
  const std::size_t sampleBytes = this->Arrays[array].GetSampleBytes();
  if (const vtkDSMFileValues* const file = vtkDSMGetFileValues(values, piece.GetSize()))
  {
    file->ReadBox({ box.Min - piece.Min, box.Max - piece.Min }, out);
    return;
  }
  if (values->HasStandardMemoryLayout())
  {
    vol::CopyBox(
      box, static_cast<const std::byte*>(values->GetVoidPointer(0)), piece, out, box, sampleBytes);
    return;
  }
  const std::lock_guard<std::mutex> lock(this->Lock);
  vtkSmartPointer<vtkDataArray> row;
  row.TakeReference(vtkDataArray::CreateDataArray(values->GetDataType()));
  row->SetNumberOfComponents(values->GetNumberOfComponents());
  const bricks::Index3 size = piece.GetSize();
  const bricks::Index3 count = box.GetSize();
  row->SetNumberOfTuples(count.x);
  const std::size_t rowBytes = static_cast<std::size_t>(count.x) * sampleBytes;
  for (std::int64_t z = box.Min.z; z < box.Max.z; ++z)
  {
    for (std::int64_t y = box.Min.y; y < box.Max.y; ++y)
    {
      const std::int64_t first =
        ((z - piece.Min.z) * size.y + (y - piece.Min.y)) * size.x + (box.Min.x - piece.Min.x);
      values->GetTuples(first, first + count.x - 1, row);
      std::memcpy(out, row->GetVoidPointer(0), rowBytes);
      out += rowBytes;
    }
  }
}
