// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/write/BrickFileWriter.h"

#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/DurableFile.h"
#include "DSMVolumeFiles/codec/ChunkCodec.h"
#include "DSMVolumeFiles/codec/HaloRecord.h"
#include "DSMVolumeFiles/hdf/HdfLibrary.h"
#include "DSMVolumeFiles/write/PartFiles.h"
#include "DSMVolumeFiles/write/PartState.h"
#include "DSMVolumeFiles/write/PathClaim.h"
#include "DSMVolumeFiles/write/WrittenHdfFile.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <limits>
#include <optional>
#include <type_traits>
#include <utility>

namespace vol
{

namespace
{

/// Entries of a node of the index of chunks: large nodes are found and read with few steps.
constexpr unsigned IndexNodeEntries = 1024;

/// Bytes that a level may take beyond its own file, with the same number of groups: the library
/// aligns some of them.
constexpr std::uint64_t RoomForGroups = 1 << 16;

std::vector<hsize_t> GetShape(const bricks::Index3& samples, int components)
{
  std::vector<hsize_t> shape{ static_cast<hsize_t>(samples.z), static_cast<hsize_t>(samples.y),
    static_cast<hsize_t>(samples.x) };
  if (components > 1)
  {
    shape.push_back(static_cast<hsize_t>(components));
  }
  return shape;
}

bool HasShape(const HdfHandle& dataset, const std::vector<hsize_t>& shape)
{
  const HdfHandle space(
    dataset.IsOpen() ? H5Dget_space(dataset.Get()) : H5I_INVALID_HID, &H5Sclose);
  const int rank = space.IsOpen() ? H5Sget_simple_extent_ndims(space.Get()) : -1;
  std::vector<hsize_t> found(shape.size());
  return rank == static_cast<int>(shape.size()) &&
    H5Sget_simple_extent_dims(space.Get(), found.data(), nullptr) == rank && found == shape;
}

} // namespace

ChunkCodec BrickFileLayout::CreateCodec(std::size_t array) const
{
  std::vector<CodecStep> steps;
  if (this->Pressed != Compression::None)
  {
    steps.push_back({ "shuffle", bricks::GetBytes(this->Arrays[array].Type) });
    steps.push_back({ this->Pressed == Compression::Zstd ? "zstd" : "deflate" });
  }
  steps.push_back({ "fletcher32" });
  return ChunkCodec(std::move(steps));
}

bool BrickFileLayout::HasHalo(std::size_t array) const
{
  return !this->Arrays[array].OnCells &&
    (this->HasHaloRecords || this->CreateCodec(array).KeepsHalo());
}

std::size_t BrickFileLayout::GetHaloRecordBytes(std::size_t array) const
{
  const FileArray& what = this->Arrays[array];
  return this->HasHalo(array) && !this->CreateCodec(array).KeepsHalo()
    ? HaloRecord::GetBytes(what.Grid.CountMostOfHalo() * what.GetSampleBytes())
    : 0;
}

namespace
{

class HdfBrickWriter final : public BrickFileWriter
{
public:
  HdfBrickWriter(std::string path, const BrickFileLayout& layout, const std::string& source,
    Unfinished unfinished)
    : Path(std::move(path))
    , PartPath(PartFiles::GetPart(this->Path))
    , Layout(layout)
    , IsRemoved(unfinished == Unfinished::Remove)
    , State(this->Path, layout, source, !this->IsRemoved)
    , Claim(this->Path)
    , File(this->PartPath)
  {
    PartFiles::CheckOwn(this->Path);
    const HdfSilence silence;
    if (this->IsRemoved)
    {
      this->State.CheckNothingIsLost();
    }
    else if (this->GoOn())
    {
      return;
    }
    try
    {
      this->Begin();
    }
    catch (...)
    {
      this->File.Divert();
      this->CloseAll();
      PartFiles::Remove(this->Path);
      throw;
    }
  }

  ~HdfBrickWriter() override
  {
    const std::lock_guard<std::mutex> lock(GetHdfLock());
    const HdfSilence silence;
    this->CloseAll();
    if (this->IsRemoved)
    {
      PartFiles::Remove(this->Path);
    }
  }

  std::int64_t GetChunks(std::size_t array) const override { return this->Targets[array].Chunks; }

  void Add(
    std::size_t number, const std::vector<EncodedChunk>& chunks, const ValueRanges& ranges) override
  {
    this->Write([&] { this->AddChunks(number, chunks, ranges); });
  }

  void Close() override
  {
    this->Write(
      [this]
      {
        this->Targets.clear();
        this->File.CloseWritten();
      });
  }

  void Finish(const std::vector<std::vector<std::byte>>& indices, int levels) override
  {
    this->Write([&] { this->WriteRest(indices, levels); });
    PartFiles::Remove(this->Path);
  }

private:
  struct Target
  {
    HdfHandle Values;
    HdfHandle Limits; ///< ValueRanges
    HdfHandle Halos;  ///< HaloRecord of the chunks; not open: none
    std::int64_t Chunks;
    ValueRanges Ranges;
  };

  void CloseAll()
  {
    this->Targets.clear();
    this->File.Close();
  }

  /// Whatever goes wrong, the library can close the file.
  template <class Work>
  void Write(const Work& work)
  {
    const std::lock_guard<std::mutex> lock(GetHdfLock());
    const HdfSilence silence;
    try
    {
      work();
    }
    catch (...)
    {
      this->File.Divert();
      throw;
    }
  }

  void AddChunks(
    std::size_t number, const std::vector<EncodedChunk>& chunks, const ValueRanges& ranges)
  {
    Target& target = this->Targets[number];
    const ChunkGrid& grid = this->Layout.Arrays[number].Grid;
    errno = 0;
    for (const EncodedChunk& chunk : chunks)
    {
      const bricks::Index3 first = grid.GetChunk(target.Chunks) * grid.ChunkSamples;
      const hsize_t offset[4] = { static_cast<hsize_t>(first.z), static_cast<hsize_t>(first.y),
        static_cast<hsize_t>(first.x), 0 };
      this->File.Check(H5Dwrite_chunk(
        target.Values.Get(), H5P_DEFAULT, 0, offset, chunk.Bytes.size(), chunk.Bytes.data()));
      if (target.Halos.IsOpen())
      {
        // Behind the chunk, for the library takes space from the end of the file.
        const hsize_t record[2] = { static_cast<hsize_t>(target.Chunks), 0 };
        this->File.Check(H5Dwrite_chunk(target.Halos.Get(), H5P_DEFAULT, 0, record,
          chunk.HaloRecord.size(), chunk.HaloRecord.data()));
      }
      ++target.Chunks;
    }
    target.Ranges.Add(ranges);
    this->WriteRanges(target);
    this->Settle();
  }

  void WriteRest(const std::vector<std::vector<std::byte>>& indices, int levels)
  {
    // Copying a level takes long. It goes behind the end of the data that a later call resumes.
    this->File.Check(this->File.Open() ? 0 : -1);
    for (int level = 1; level <= levels; ++level)
    {
      this->AddLevel(level);
    }
    // A later process must not continue a file that has an index.
    this->WriteState(false);
    for (std::size_t number = 0; number < indices.size(); ++number)
    {
      const std::string name = "DSM/" + this->GetName(this->Layout.Arrays[number]) + "/BrickIndex";
      if (!indices[number].empty())
      {
        const HdfHandle dataset =
          this->File.CreateDataset(name, H5T_NATIVE_UCHAR, { indices[number].size() }, H5P_DEFAULT);
        this->File.Check(H5Dwrite(
          dataset.Get(), H5T_NATIVE_UCHAR, H5S_ALL, H5S_ALL, H5P_DEFAULT, indices[number].data()));
      }
    }
    this->File.CloseWritten();
    DurableFile::Synchronize(this->PartPath);
    DurableFile::Rename(this->PartPath, this->Path);
  }

  /// As it is: the library copies chunks without looking into them.
  void AddLevel(int level)
  {
    if (level == 1)
    {
      this->File.CreateGroup(HdfLevels);
    }
    const std::string group = std::string(HdfLevels) + "/" + std::to_string(level);
    this->File.CreateGroup(group.c_str());
    const std::string path = PartFiles::GetLevel(this->Path, level);
    std::error_code failure;
    const std::uintmax_t bytes = std::filesystem::file_size(path, failure);
    this->File.Reserve(failure ? 0 : bytes + RoomForGroups);
    const HdfHandle from =
      this->File.Own(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), &H5Fclose);
    for (const std::string part : { "VTKHDF", "DSM" })
    {
      this->File.Check(H5Ocopy(from.Get(), part.c_str(), this->File.Get(),
        (group + "/" + part).c_str(), H5P_DEFAULT, H5P_DEFAULT));
    }
  }

  /// Returns false where no earlier process can be resumed, or its file is damaged.
  bool GoOn()
  {
    const std::optional<std::vector<std::int64_t>> chunks = this->State.Load();
    if (!chunks || !this->File.Open())
    {
      return false;
    }
    for (std::size_t number = 0; number < this->Layout.Arrays.size(); ++number)
    {
      if (!this->GoOnWith(number, (*chunks)[number]))
      {
        this->CloseAll();
        return false;
      }
    }
    return true;
  }

  bool GoOnWith(std::size_t number, std::int64_t chunks)
  {
    const FileArray& array = this->Layout.Arrays[number];
    const auto find = [&](const std::string& name)
    { return HdfHandle(H5Dopen2(this->File.Get(), name.c_str(), H5P_DEFAULT), &H5Dclose); };
    const std::string index = "DSM/" + this->GetName(array);
    const std::size_t haloBytes = this->Layout.GetHaloRecordBytes(number);
    Target target{ find("VTKHDF/" + this->GetName(array)), find(index + "/ValueRanges"),
      haloBytes > 0 ? find(index + "/" + HdfHaloRecords) : HdfHandle(), chunks,
      ValueRanges(array.Components) };
    const auto count = static_cast<hsize_t>(array.Grid.GetCount());
    std::vector<double> limits(4 * target.Ranges.All.size());
    if (!HasShape(target.Values, GetShape(array.Grid.Samples, array.Components)) ||
      !HasShape(target.Limits, { target.Ranges.All.size(), 4 }) ||
      (haloBytes > 0 && !HasShape(target.Halos, { count, haloBytes })) ||
      H5Dread(
        target.Limits.Get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, limits.data()) < 0)
    {
      return false;
    }
    for (std::size_t range = 0; range < target.Ranges.All.size(); ++range)
    {
      target.Ranges.All[range] = { limits[4 * range], limits[4 * range + 1] };
      target.Ranges.Finite[range] = { limits[4 * range + 2], limits[4 * range + 3] };
    }
    const bool isValid = target.Ranges.IsValid(array.Type);
    this->Targets.push_back(std::move(target));
    return isValid;
  }

  static std::string GetName(const FileArray& array)
  {
    return (array.OnCells ? "CellData/" : "PointData/") + array.Name;
  }

  void Begin()
  {
    // The state comes first, as it marks the other files as this program's.
    this->State.Save(false, std::vector<std::int64_t>(this->Layout.Arrays.size(), 0));
    PartFiles::RemoveValues(this->Path);
    this->File.Create(IndexNodeEntries);
    this->WriteImage();
    for (const char* folder :
      { "VTKHDF/PointData", "VTKHDF/CellData", "DSM", "DSM/PointData", "DSM/CellData" })
    {
      this->File.CreateGroup(folder);
    }
    const HdfHandle index =
      this->File.Own(H5Gopen2(this->File.Get(), "DSM", H5P_DEFAULT), &H5Gclose);
    const long long edge = this->Layout.BrickEdge;
    this->File.WriteAttribute(index.Get(), "BrickEdge", H5T_NATIVE_LLONG, &edge, 1);
    for (std::size_t number = 0; number < this->Layout.Arrays.size(); ++number)
    {
      this->Targets.push_back(this->CreateTarget(number));
      this->WriteRanges(this->Targets.back());
    }
    this->Settle();
  }

  /// VTK's own: see "VTKHDF File Format", ImageData.
  void WriteImage()
  {
    const HdfHandle group = this->File.Own(
      H5Gcreate2(this->File.Get(), "VTKHDF", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), &H5Gclose);
    const FileGeometry& geometry = this->Layout.Geometry;
    const long long version[2] = { 1, 0 };
    long long extent[6];
    for (int axis = 0; axis < 3; ++axis)
    {
      extent[2 * axis] = geometry.First[axis];
      extent[2 * axis + 1] = geometry.First[axis] + geometry.Points[axis] - 1;
    }
    this->File.WriteAttribute(group.Get(), "Version", H5T_NATIVE_LLONG, version, 2);
    this->File.WriteAttribute(group.Get(), "WholeExtent", H5T_NATIVE_LLONG, extent, 6);
    this->File.WriteAttribute(group.Get(), "Origin", H5T_NATIVE_DOUBLE, geometry.Origin, 3);
    this->File.WriteAttribute(group.Get(), "Spacing", H5T_NATIVE_DOUBLE, geometry.Spacing, 3);
    this->File.WriteAttribute(group.Get(), "Direction", H5T_NATIVE_DOUBLE, geometry.Direction, 9);
    this->File.WriteAttribute(group.Get(), "Type", "ImageData");
  }

  Target CreateTarget(std::size_t number)
  {
    const FileArray& array = this->Layout.Arrays[number];
    const std::string index = "DSM/" + this->GetName(array);
    this->File.CreateGroup(index.c_str());
    if (array.IsActive && !array.OnCells)
    {
      const HdfHandle points =
        this->File.Own(H5Gopen2(this->File.Get(), "DSM/PointData", H5P_DEFAULT), &H5Gclose);
      this->File.WriteAttribute(points.Get(), HdfScalars, array.Name);
    }
    if (this->Layout.HasHalo(number))
    {
      const HdfHandle group =
        this->File.Own(H5Gopen2(this->File.Get(), index.c_str(), H5P_DEFAULT), &H5Gclose);
      const long long samples = 1;
      this->File.WriteAttribute(group.Get(), HdfHalo, H5T_NATIVE_LLONG, &samples, 1);
    }
    const HdfHandle creation = this->File.Own(H5Pcreate(H5P_DATASET_CREATE), &H5Pclose);
    const std::vector<hsize_t> edges = GetShape(array.Grid.ChunkSamples, array.Components);
    H5Pset_chunk(creation.Get(), static_cast<int>(edges.size()), edges.data());
    H5Pset_fill_time(creation.Get(), H5D_FILL_TIME_NEVER);
    switch (this->Layout.Pressed)
    {
      case Compression::None:
        break;
      case Compression::Deflate:
        H5Pset_shuffle(creation.Get());
        H5Pset_deflate(creation.Get(), 3);
        break;
      case Compression::Zstd:
        H5Pset_shuffle(creation.Get());
        // The library itself need not have it; chunks are written as they are.
        H5Pset_filter(
          creation.Get(), FindCodec("zstd")->HdfFilters.front(), H5Z_FLAG_OPTIONAL, 0, nullptr);
    }
    H5Pset_fletcher32(creation.Get());
    ValueRanges ranges(array.Components);
    const hsize_t limitShape[2] = { ranges.All.size(), 4 };
    HdfHandle values = this->File.CreateDataset("VTKHDF/" + this->GetName(array),
      GetHdfType(array.Type), GetShape(array.Grid.Samples, array.Components), creation.Get());
    this->WriteMissing(values.Get(), array);
    return { std::move(values),
      this->File.CreateDataset(index + "/ValueRanges", H5T_NATIVE_DOUBLE,
        { std::begin(limitShape), std::end(limitShape) }, H5P_DEFAULT),
      this->CreateHalos(number), 0, std::move(ranges) };
  }

  /// Writes which integers are missing, as netCDF has it. Missing floating point numbers are NaN.
  void WriteMissing(hid_t dataset, const FileArray& array)
  {
    bricks::Dispatch(array.Type,
      [&](auto zero)
      {
        using T = decltype(zero);
        const auto write = [&](const char* name, const std::vector<double>& limits)
        {
          std::vector<T> numbers;
          for (const double limit : limits)
          {
            // A double cannot tell the greatest integer of 64 bits from the one after it.
            const auto exact = static_cast<long double>(limit);
            if (exact >= std::numeric_limits<T>::lowest() &&
              exact <= static_cast<long double>(std::numeric_limits<T>::max()))
            {
              numbers.push_back(static_cast<T>(limit));
            }
          }
          if (std::is_integral_v<T> && !numbers.empty())
          {
            this->File.WriteAttribute(dataset, name, GetHdfType(array.Type), numbers.data(),
              static_cast<int>(numbers.size()));
          }
        };
        const auto& fills = array.Valid.Fills;
        write("_FillValue", { fills.front() });
        write("missing_value", { fills.begin() + 1, fills.end() });
        write("valid_min", { array.Valid.Lowest });
        write("valid_max", { array.Valid.Highest });
      });
  }

  /// Not open where the layout has none.
  HdfHandle CreateHalos(std::size_t number)
  {
    const FileArray& array = this->Layout.Arrays[number];
    const hsize_t record[2] = { 1, this->Layout.GetHaloRecordBytes(number) };
    if (record[1] == 0)
    {
      return {};
    }
    const HdfHandle creation = this->File.Own(H5Pcreate(H5P_DATASET_CREATE), &H5Pclose);
    H5Pset_chunk(creation.Get(), 2, record);
    H5Pset_fill_time(creation.Get(), H5D_FILL_TIME_NEVER);
    return this->File.CreateDataset("DSM/" + this->GetName(array) + "/" + HdfHaloRecords,
      H5T_NATIVE_UCHAR, { static_cast<hsize_t>(array.Grid.GetCount()), record[1] }, creation.Get());
  }

  void WriteRanges(const Target& target)
  {
    std::vector<double> limits;
    for (std::size_t range = 0; range < target.Ranges.All.size(); ++range)
    {
      for (const ValueRange* one : { &target.Ranges.All[range], &target.Ranges.Finite[range] })
      {
        limits.insert(limits.end(), { one->Least, one->Greatest });
      }
    }
    this->File.Check(H5Dwrite(
      target.Limits.Get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, limits.data()));
  }

  void WriteState(bool isWhole) const
  {
    std::vector<std::int64_t> chunks;
    for (const Target& target : this->Targets)
    {
      chunks.push_back(target.Chunks);
    }
    chunks.resize(this->Layout.Arrays.size()); // after Close
    this->State.Save(isWhole, chunks);
  }

  /// All that was added is in the file; while it is not quite, the state says so.
  void Settle()
  {
    this->File.Reserve();
    // From here on until it is settled, the file is neither what it was nor what it will be.
    this->WriteState(false);
    this->File.Flush();
    DurableFile::Synchronize(this->PartPath);
    this->WriteState(true);
  }

  std::string Path;
  std::string PartPath;
  BrickFileLayout Layout;
  bool IsRemoved; ///< unless it is finished
  PartState State;
  PathClaim Claim;
  WrittenHdfFile File;
  std::vector<Target> Targets;
};

} // namespace

std::unique_ptr<BrickFileWriter> BrickFileWriter::Make(
  std::string path, const BrickFileLayout& layout, const std::string& source, Unfinished unfinished)
{
  const std::lock_guard<std::mutex> lock(GetHdfLock());
  return std::make_unique<HdfBrickWriter>(std::move(path), layout, source, unfinished);
}

} // namespace vol
