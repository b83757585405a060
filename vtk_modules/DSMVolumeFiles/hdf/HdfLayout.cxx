// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/hdf/HdfLayout.h"

#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/SmallFile.h"
#include "DSMVolumeFiles/codec/HaloRecord.h"
#include "DSMVolumeFiles/hdf/HdfBrickIndex.h"
#include "DSMVolumeFiles/hdf/HdfChunks.h"
#include "DSMVolumeFiles/hdf/HdfValues.h"

#include <algorithm>
#include <utility>

namespace vol
{

namespace
{

PackedValues FindPacking(hid_t dataset, bricks::ScalarType stored, const std::string& name,
  std::vector<std::string>& warnings)
{
  PackedValues packed(stored);
  packed.TakeAttributes([&](const char* attribute) { return ReadHdfNumbers(dataset, attribute); },
    ReadHdfText(dataset, "_Unsigned") == "true", name, warnings);
  return packed;
}

/// Returns whether the library can read the first sample.
bool CanRead(const HdfDataset& dataset, const FileArray& array)
{
  std::vector<std::byte> sample(array.GetSampleBytes());
  return ReadHdfBox(dataset.Id.Get(), dataset.Type, dataset.Member, dataset.Shape, 0,
    { bricks::Index3(0), bricks::Index3(1) }, sample.data());
}

ChunkCodec CreateCodec(
  const std::string& path, const std::string& name, std::vector<CodecStep> steps)
{
  try
  {
    return ChunkCodec(std::move(steps));
  }
  catch (const dsm::Error& error)
  {
    throw FileError({ path, name, {} }, error);
  }
}

/// As one chunk is, but for small ones.
void CutContiguous(FileArray& array, ChunkStorage& storage)
{
  const bricks::Index3 rows = std::exchange(array.Grid.ChunkSamples, array.Grid.Samples);
  CutPlainChunks(array, storage);
  if (storage.StoredSamples == bricks::Index3(0))
  {
    array.Grid.ChunkSamples = rows;
  }
}

/// Finds the halos of a brick file's chunks.
void FindHalo(hid_t root, const FileArray& array, ChunkStorage& storage)
{
  int halo = 0;
  const HdfHandle index = OpenHdfBrickIndex(root, array);
  if (!index.IsOpen() || !ReadHdfAttribute(index.Get(), HdfHalo, H5T_NATIVE_INT, &halo, 1) ||
    halo != 1)
  {
    return;
  }
  storage.HasHalo = storage.Codec.KeepsHalo();
  if (!storage.HasHalo && H5Lexists(index.Get(), HdfHaloRecords, H5P_DEFAULT) > 0)
  {
    storage.HasHalo = true;
    storage.HaloRecordBytes =
      HaloRecord::GetBytes(array.Grid.CountMostOfHalo() * array.GetSampleBytes());
  }
}

/// False when the chunks do not have all components, or are not where the library says, or as the filters say, or
/// if the order of their samples differs from that of bricks.
bool FindChunks(const HdfLayout::Place& place, const std::vector<hsize_t>& edges, hid_t properties,
  const FileArray& array, ChunkStorage& storage, HdfDataset& dataset, bool swapped)
{
  const HdfHandle creation(H5Fget_create_plist(place.File), &H5Pclose);
  hsize_t before = 0;
  unsigned partial = 0;
  if (H5Pget_userblock(creation.Get(), &before) < 0 || before != 0 ||
    H5Pget_chunk_opts(properties, &partial) < 0 || partial != 0)
  {
    return false;
  }
  const HdfAxes& axes = dataset.Shape;
  // A chunk may have several times, and positions along further axes.
  const hsize_t slices = axes.CountSlices(edges);
  CheckSizes(place.Path, array, slices);
  storage.Slices = static_cast<std::size_t>(slices);
  dataset.Edges = edges;
  dataset.Chunks =
    FindHdfChunks(dataset.Id.Get(), place.Bytes, array.Name, edges, axes, place.GoesOn);
  const bool areWhole = !axes.Component || edges[*axes.Component] == axes.Components;
  if (!areWhole || !axes.IsTogether())
  {
    dataset.Chunks.reset();
  }
  if (dataset.Chunks && swapped)
  {
    dataset.Chunks->AddFilterInFront();
  }
  return dataset.Chunks.has_value();
}

} // namespace

std::optional<HdfLayout> HdfLayout::Find(const Place& place, HdfHandle id, const std::string& name,
  const std::string& member, bool onCells, const HdfAxes& axes)
{
  FileArray array;
  array.Name = name;
  array.OnCells = onCells;
  array.Components = static_cast<int>(std::max<hsize_t>(1, axes.Components));
  const std::optional<HdfValues> values = FindHdfValues(id.Get(), member);
  if (!values)
  {
    return std::nullopt;
  }
  array.Type = values->Type;
  array.Grid.Samples = axes.Samples;
  ChunkStorage storage;
  storage.Packed = FindPacking(id.Get(), values->Type, name, place.Warnings);
  CheckSizes(place.Path, array);
  // The library alone knows the chunks of a file that grows.
  const bool isElsewhere = place.Origins.Add(place.Path, place.File, id.Get()) || place.Grows;
  const bool isOrdered = axes.Order == FastestX && axes.IsTogether();
  const auto cut = isOrdered ? &CutIntoRows : &CutIntoBoxes;
  array.Grid = cut(axes.Samples, array.GetSampleBytes());
  storage.Order = axes.Order;
  HdfDataset dataset{ std::move(id), values->Type, !values->IsPlain || isElsewhere, HADDR_UNDEF,
    std::nullopt, {}, axes, member, {} };
  storage.Fill = GetHdfFill(dataset.Id.Get(), array.Type, array.Components);
  const HdfHandle properties(H5Dget_create_plist(dataset.Id.Get()), &H5Pclose);
  std::vector<CodecStep> steps;
  if (values->Swapped)
  {
    steps.push_back({ "swap", bricks::GetBytes(array.Type) });
  }
  switch (H5Pget_layout(properties.Get()))
  {
    case H5D_CONTIGUOUS:
      if (!isElsewhere)
      {
        CheckHdfStored(dataset.Id.Get(), place.Path, name);
      }
      dataset.First = dataset.ReadByLibrary
        ? HADDR_UNDEF
        : FindHdfValuesPlace(dataset.Id.Get(), place.Bytes, array, axes.CountSlices(axes.Lengths));
      dataset.ReadByLibrary = dataset.ReadByLibrary || !isOrdered;
      storage.HasWholeChunks = false;
      break;
    case H5D_CHUNKED:
    {
      const std::vector<hsize_t> edges = GetHdfChunkEdges(dataset.Id.Get(), place.Path, name);
      array.Grid.ChunkSamples =
        axes.GetSpace(edges); // so that the library, too, unpacks each chunk once
      CheckSizes(place.Path, array);
      // Also of chunks that the library reads: it does not check how many bytes they have.
      const bool areFound = !isElsewhere &&
        FindChunks(place, edges, properties.Get(), array, storage, dataset, values->Swapped);
      dataset.ReadByLibrary =
        dataset.ReadByLibrary || !areFound || !FindHdfSteps(properties.Get(), steps);
      if (dataset.ReadByLibrary)
      {
        dataset.Chunks.reset();
      }
      break;
    }
    case H5D_COMPACT:
      CheckHdfStored(dataset.Id.Get(), place.Path, name);
      dataset.ReadByLibrary = true;
      break;
    default:
      dataset.ReadByLibrary = true;
  }
  const std::string lack = dataset.ReadByLibrary ? FindLackingHdfFilter(dataset.Id.Get()) : "";
  if (!lack.empty() && !CanRead(dataset, array))
  {
    place.Warnings.push_back("has array " + Quote(name) + ", which is not shown: " + lack);
    return std::nullopt;
  }
  if (!dataset.ReadByLibrary)
  {
    storage.Codec = CreateCodec(place.Path, name, steps);
  }
  if (!dataset.ReadByLibrary && storage.Slices == 1)
  {
    FindHalo(place.Root, array, storage);
  }
  if (!dataset.ReadByLibrary && !dataset.Chunks)
  {
    CutContiguous(array, storage);
  }
  else if (!dataset.ReadByLibrary)
  {
    CutPlainChunks(array, storage);
  }
  array.Type = storage.Packed.GetType();
  array.Valid = storage.Packed.GetValid();
  return HdfLayout{ std::move(array), std::move(storage), std::move(dataset), std::move(steps) };
}

bool HdfLayout::HasSameValues(const HdfLayout& other) const
{
  return this->Origin.Type == other.Origin.Type && this->Array.Valid == other.Array.Valid &&
    this->Values.Packed.GetStamp() == other.Values.Packed.GetStamp();
}

bool HdfLayout::IsStoredLike(const HdfLayout& other) const
{
  const auto isSameStep = [](const CodecStep& a, const CodecStep& b)
  { return a.What == b.What && a.With.Width == b.With.Width && a.With.Numbers == b.With.Numbers; };
  return this->Origin.ReadByLibrary == other.Origin.ReadByLibrary &&
    this->Array.Grid.ChunkSamples == other.Array.Grid.ChunkSamples &&
    this->Values.StoredSamples == other.Values.StoredSamples &&
    this->Values.HasWholeChunks == other.Values.HasWholeChunks &&
    this->Values.Slices == other.Values.Slices && this->Values.Fill == other.Values.Fill &&
    std::equal(
      this->Steps.begin(), this->Steps.end(), other.Steps.begin(), other.Steps.end(), isSameStep);
}

void HdfLayout::LeaveToLibrary()
{
  this->Origin.ReadByLibrary = true;
  this->Origin.Chunks.reset();
}

} // namespace vol
