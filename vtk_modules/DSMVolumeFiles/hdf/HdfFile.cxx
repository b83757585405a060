// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/hdf/HdfFile.h"

#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/FileLimits.h"
#include "DSMVolumeFiles/base/ReadingManner.h"
#include "DSMVolumeFiles/base/SmallFile.h"
#include "DSMVolumeFiles/format/StoredFile.h"
#include "DSMVolumeFiles/hdf/HdfAxes.h"
#include "DSMVolumeFiles/hdf/HdfBrickIndex.h"
#include "DSMVolumeFiles/hdf/HdfImage.h"
#include "DSMVolumeFiles/hdf/HdfLayout.h"
#include "DSMVolumeFiles/hdf/HdfLibrary.h"
#include "DSMVolumeFiles/hdf/HdfOrigins.h"
#include "DSMVolumeFiles/hdf/HdfValues.h"
#include "DSMVolumeFiles/hdf/HdfVolumes.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <iterator>
#include <mutex>
#include <optional>
#include <set>
#include <utility>

namespace vol
{

namespace
{

class HdfFile final : public StoredFile
{
public:
  HdfFile(const std::string& path, const OpenOptions& options)
    : StoredFile(path)
    , IsPlaced(!options.HasSpacing())
    , GoesOn(options.GoesOn)
    , Bytes(std::make_shared<PositionedFile>(path))
    , Grows(IsLive(*this->Bytes))
    , File(Open(path, this->Grows))
  {
    const int level = options.Level;
    this->OpenLevel(level);
    if (H5Lexists(this->Root, "VTKHDF", H5P_DEFAULT) > 0)
    {
      this->FindImage();
    }
    else
    {
      this->FindDatasets(options.Dataset);
    }
    if (this->Arrays.empty())
    {
      throw FileError(path, this->Unread.empty() ? "has no " + this->Missing : this->Unread);
    }
    this->GoesOn = nullptr; // the caller may be gone later
    // Results kept for one level must not be used for another.
    std::uint64_t stamp = this->Bytes->GetStamp() + static_cast<std::uint64_t>(level);
    for (const ChunkStorage& storage : this->Storages)
    {
      stamp += storage.Packed.GetStamp();
    }
    this->Stamp = this->Origins.GetStamp(stamp);
  }
  ~HdfFile() override
  {
    const std::lock_guard<std::mutex> lock(GetHdfLock());
    GetOpened().erase(this);
    this->Close();
  }

  static std::shared_ptr<VolumeFile> Create(const std::string& path, const OpenOptions& options)
  {
    const std::lock_guard<std::mutex> lock(GetHdfLock());
    const HdfSilence silence;
    // The library takes a file that it has open for the same, whatever was written to it meanwhile.
    for (HdfFile* const opened : GetOpened())
    {
      if (!opened->Bytes->IsUnchanged() || !opened->Origins.AreUnchanged())
      {
        opened->Close();
      }
    }
    auto file = std::make_shared<HdfFile>(path, options);
    GetOpened().insert(file.get());
    return file;
  }

  void ReadChunk(
    std::size_t array, int step, const bricks::Index3& chunk, std::byte* out) const override
  {
    if (this->GetDataset(array, step).ReadByLibrary)
    {
      this->Unpack(array, this->Arrays[array].Grid.GetBox(chunk).GetCount(), out,
        [&](std::byte* to) { this->ReadByLibrary(array, step, chunk, to); });
    }
    else
    {
      this->StoredFile::ReadChunk(array, step, chunk, out);
    }
  }

  Index ReadIndex(std::size_t array, int) const override
  {
    if (this->Storages[array].Packed.ArePacked() ||
      this->Arrays[array].Valid.Exclude(this->Arrays[array].Type))
    {
      return {}; // it was made before the attributes were added
    }
    const std::lock_guard<std::mutex> lock(GetHdfLock());
    const HdfSilence silence;
    return ReadHdfBrickIndex(this->Root, this->Arrays[array], this->Bytes->GetBytes());
  }

  std::vector<std::string> GetFiles(int) const override
  {
    std::vector<std::string> paths = this->Origins.GetPaths();
    paths.push_back(this->Path);
    return paths;
  }

  std::uint64_t GetTableBytes() const override
  {
    std::uint64_t bytes = 0;
    for (const std::vector<HdfDataset>& steps : this->Kept)
    {
      for (const HdfDataset& dataset : steps)
      {
        bytes += dataset.Chunks ? dataset.Chunks->GetBytes() : 0;
      }
    }
    return bytes;
  }

protected:
  std::optional<Place> FindChunk(
    std::size_t array, int step, const bricks::Index3& chunk) const override
  {
    const HdfDataset& dataset = this->GetDataset(array, step);
    if (dataset.ReadByLibrary)
    {
      return std::nullopt; // only the library knows
    }
    const ChunkGrid grid = this->GetStoredGrid(array);
    const HdfAxes& axes = dataset.Shape;
    const std::size_t frame = dataset.GetFrame(step);
    if (!dataset.Chunks)
    {
      if (dataset.First == HADDR_UNDEF)
      {
        return std::nullopt;
      }
      const bricks::Box box = grid.GetBox(chunk);
      const auto before =
        static_cast<std::uint64_t>((box.Min.z * grid.Samples.y + box.Min.y) * grid.Samples.x);
      const std::uint64_t slice = axes.FindSlice(axes.Lengths, frame);
      const std::size_t bytes = this->GetStoredBytes(array);
      const auto sliceSamples =
        static_cast<std::uint64_t>(grid.Samples.x * grid.Samples.y * grid.Samples.z);
      return Place{ this->Bytes, dataset.First + (slice * sliceSamples + before) * bytes,
        static_cast<std::size_t>(box.GetCount()) * bytes, 0 };
    }
    const HdfChunk* const stored =
      dataset.Chunks->Find(axes.FindChunk(dataset.Edges, frame, chunk));
    if (!stored)
    {
      return std::nullopt;
    }
    return Place{ this->Bytes, stored->First, stored->Bytes, stored->SkippedFilters,
      static_cast<std::size_t>(axes.FindSlice(dataset.Edges, frame)) };
  }

  bool IsMissing(std::size_t array, int step, const bricks::Index3& chunk) const override
  {
    return !this->GetDataset(array, step).ReadByLibrary && !this->FindChunk(array, step, chunk);
  }

private:
  const HdfDataset& GetDataset(std::size_t array, int step) const
  {
    const std::vector<HdfDataset>& steps = this->Kept[array];
    return steps.size() == 1 ? steps.front() : steps[static_cast<std::size_t>(step)];
  }

  /// Those there are. Under the lock.
  static std::set<HdfFile*>& GetOpened()
  {
    static auto* const opened = new std::set<HdfFile*>; // static files may end after it otherwise
    return *opened;
  }

  /// Closes all identifiers of the library, the file last. Then the library can read nothing any
  /// more.
  void Close()
  {
    for (std::vector<HdfDataset>& steps : this->Kept)
    {
      for (HdfDataset& dataset : steps)
      {
        dataset.Id.Reset();
      }
    }
    this->Coarser.reset();
    this->Root = H5I_INVALID_HID;
    this->File.Reset();
  }

  /// Returns whether another program appends to the file, or did until it was killed: the superblock says so.
  static bool IsLive(const PositionedFile& bytes)
  {
    constexpr std::size_t version = 8;
    constexpr std::size_t flags = 11;
    constexpr std::byte appended{ 4 };
    std::byte superblock[flags + 1]{};
    if (bytes.GetBytes() >= sizeof(superblock))
    {
      bytes.Read(0, superblock, sizeof(superblock));
    }
    return superblock[version] == std::byte(3) && (superblock[flags] & appended) != std::byte(0);
  }

  static HdfHandle Open(const std::string& path, bool isLive)
  {
    const HdfHandle access(H5Pcreate(H5P_FILE_ACCESS), &H5Pclose);
    // While another program writes; of a damaged file, they are in vain.
    constexpr unsigned attempts = 10;
    H5Pset_metadata_read_attempts(access.Get(), attempts);
    HdfHandle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY | (isLive ? H5F_ACC_SWMR_READ : 0),
                     isLive ? access.Get() : H5P_DEFAULT),
      &H5Fclose);
    if (!file.IsOpen())
    {
      throw FileError(path,
        "cannot be opened as HDF5. It is another kind of file, is damaged, or is open for writing. "
        "A writer that may be read meanwhile has to use SWMR. If the writer has ended without "
        "closing the file, run 'h5clear -s FILE' (package hdf5-tools).");
    }
    return file;
  }

  /// See BrickFileWriter.
  void OpenLevel(int level)
  {
    this->Root = this->File.Get();
    if (H5Lexists(this->Root, "DSM", H5P_DEFAULT) > 0 &&
      H5Lexists(this->Root, HdfLevels, H5P_DEFAULT) > 0)
    {
      const HdfHandle levels(H5Gopen2(this->Root, HdfLevels, H5P_DEFAULT), &H5Gclose);
      H5G_info_t info{};
      H5Gget_info(levels.Get(), &info);
      CheckLimit(this->Path, "levels of detail", info.nlinks, FileLimits::Levels);
      this->Levels = 1 + static_cast<int>(info.nlinks);
    }
    if (level < 0 || level >= this->Levels)
    {
      throw FileError(this->Path,
        "has no level " + std::to_string(level) + "; valid levels are 0 to " +
          std::to_string(this->Levels - 1) + ".");
    }
    if (level > 0)
    {
      const std::string name = std::string(HdfLevels) + "/" + std::to_string(level);
      this->Coarser.emplace(H5Gopen2(this->Root, name.c_str(), H5P_DEFAULT), &H5Gclose);
      this->Root = this->Coarser->Get();
    }
  }

  /// VTK's own: see "VTKHDF File Format", ImageData.
  void FindImage()
  {
    const HdfHandle group(H5Gopen2(this->Root, "VTKHDF", H5P_DEFAULT), &H5Gclose);
    HdfImage image = HdfImage::Read(group.Get(), this->Path);
    this->Geometry = image.Geometry;
    this->Times = std::move(image.Times);
    this->Steps = std::max(1, static_cast<int>(this->Times.size()));
    const bricks::Index3 cells =
      glm::max(this->Geometry.Points - bricks::Index3(1), bricks::Index3(1));
    this->FindArrays(group.Get(), "PointData", false, this->Geometry.Points);
    this->FindArrays(group.Get(), "CellData", true, cells);
    this->FindActive();
    this->Missing = "numeric array in PointData or CellData with the number of samples along z, y "
                    "and x that WholeExtent declares.";
  }

  void FindArrays(hid_t parent, const char* name, bool onCells, const bricks::Index3& samples)
  {
    if (H5Lexists(parent, name, H5P_DEFAULT) <= 0)
    {
      return;
    }
    const HdfHandle group(H5Gopen2(parent, name, H5P_DEFAULT), &H5Gclose);
    H5G_info_t info{};
    if (!group.IsOpen() || H5Gget_info(group.Get(), &info) < 0)
    {
      throw FileError(
        this->Path, std::string("is not a valid VTKHDF file: '") + name + "' is not a group.");
    }
    CheckLimit(this->Path, "arrays", info.nlinks, FileLimits::Arrays);
    for (hsize_t index = 0; index < info.nlinks; ++index)
    {
      const std::string link = GetHdfText(
        [&](char* to, std::size_t size)
        {
          return H5Lget_name_by_idx(
            group.Get(), ".", H5_INDEX_NAME, H5_ITER_INC, index, to, size, H5P_DEFAULT);
        });
      if (link.empty())
      {
        throw FileError(this->Path,
          std::string("has an array in ") + name + " whose name cannot be read or has more than " +
            std::to_string(FileLimits::NameBytes) + " bytes.");
      }
      HdfHandle dataset = OpenHdfDataset(group.Get(), link);
      HdfAxes found;
      std::string tooLong;
      const HdfAxes::Kind kind = this->Times.empty() ? HdfAxes::Kind::Still : HdfAxes::Kind::InTime;
      const bool isVolume =
        dataset.IsOpen() && found.Find(GetHdfShape(dataset.Get()), kind, {}, &tooLong);
      if (!tooLong.empty())
      {
        HdfAxes::RefuseLength(this->Path, link, tooLong);
      }
      if (isVolume && found.Samples == samples)
      {
        const std::string offsets = std::string("Steps/") + name + "Offsets/" + link;
        std::optional<HdfLayout> layout =
          this->FindLayout(std::move(dataset), link, {}, onCells, found);
        if (layout)
        {
          layout->Origin.Frames = this->FindFrames(parent, offsets, found);
          this->Add(std::move(*layout));
        }
      }
    }
  }

  /// Finds the active scalars: those that a brick file names, or VTK's own attribute.
  void FindActive()
  {
    for (const char* const group : { "DSM/PointData", "VTKHDF/PointData" })
    {
      const HdfHandle points(H5Gopen2(this->Root, group, H5P_DEFAULT), &H5Gclose);
      const std::string name = points.IsOpen() ? ReadHdfText(points.Get(), HdfScalars) : "";
      const auto active = std::find_if(this->Arrays.begin(), this->Arrays.end(),
        [&](const FileArray& array) { return !array.OnCells && array.Name == name; });
      if (active != this->Arrays.end())
      {
        active->IsActive = true;
        return;
      }
    }
  }

  /// Returns the position of each step along an array's time axis; empty: the steps follow one
  /// another.
  std::vector<int> FindFrames(hid_t image, const std::string& offsets, const HdfAxes& axes) const
  {
    std::vector<int> frames;
    if (axes.Frames == 0)
    {
      return frames;
    }
    ReadHdfWhole(image, offsets.c_str(), H5T_NATIVE_INT, FileLimits::Steps, frames);
    const int last = static_cast<int>(axes.Frames) - 1;
    const auto isOutside = [=](int frame) { return frame < 0 || frame > last; };
    const bool fits = frames.empty() ? this->Steps - 1 <= last
                                     : frames.size() == static_cast<std::size_t>(this->Steps) &&
        std::none_of(frames.begin(), frames.end(), isOutside);
    if (!fits)
    {
      throw FileError(this->Path,
        "has " + std::to_string(this->Steps) + " time steps, but its array of '" + offsets +
          "' does not cover all of them.");
    }
    return frames;
  }

  void FindDatasets(const std::string& wanted)
  {
    const HdfVolumes volumes = HdfVolumes::Find(this->File.Get(), this->Path, wanted);
    this->Missing = volumes.Missing;
    this->Geometry.Points = volumes.Shape.Samples;
    this->Warnings = volumes.Warnings;
    this->Steps = volumes.Steps;
    this->Times = volumes.Times;
    std::vector<std::string> displaced;
    for (const HdfVolume& volume : volumes.Found)
    {
      if (!this->LocateBy(volume))
      {
        displaced.push_back(volume.Name);
      }
      this->AddSteps(volume);
    }
    if (!displaced.empty())
    {
      this->Warnings.push_back("has arrays at different positions. All are shown at those of " +
        Quote(this->Arrays.front().Name) + ". Arrays at other positions: " + ListNames(displaced));
    }
  }

  /// Takes place and times from the first volume. Returns whether this one lies at the same place.
  bool LocateBy(const HdfVolume& volume)
  {
    this->Warnings.insert(this->Warnings.end(), volume.Warnings.begin(), volume.Warnings.end());
    if (volume.Notes->size() != volume.Axes.Lengths.size())
    {
      return true;
    }
    FileGeometry place;
    place.Points = this->Geometry.Points;
    GridCoordinates coordinates;
    std::array<const AxisNote*, 3> inSpace{};
    for (std::size_t axis = 0; axis < inSpace.size(); ++axis)
    {
      inSpace[static_cast<std::size_t>(volume.Axes.Order[axis])] =
        volume.Axes.Space[axis] ? &(*volume.Notes)[*volume.Axes.Space[axis]] : nullptr;
    }
    std::vector<std::string> warnings;
    if (this->IsPlaced)
    {
      PlaceAxes(this->Path, inSpace, place, coordinates, warnings);
    }
    if (volume.Axes.Time && this->Times.empty())
    {
      this->Times = FindTimes((*volume.Notes)[*volume.Axes.Time], this->Steps, this->Warnings);
    }
    if (!this->Arrays.empty())
    {
      return IsSamePlace(place, this->Geometry) && coordinates == this->Coordinates;
    }
    this->Geometry = place;
    this->Coordinates = std::move(coordinates);
    this->Warnings.insert(this->Warnings.end(), warnings.begin(), warnings.end());
    return true;
  }

  std::optional<HdfLayout> FindLayout(HdfHandle dataset, const std::string& name,
    const std::string& member, bool onCells, const HdfAxes& axes)
  {
    const std::size_t warnings = this->Warnings.size();
    auto layout = HdfLayout::Find({ this->Path, this->File.Get(), this->Root, *this->Bytes,
                                    this->Grows, this->GoesOn, this->Origins, this->Warnings },
      std::move(dataset), name, member, onCells, axes);
    const bool isUnread = !layout && this->Warnings.size() > warnings;
    this->Unread = isUnread ? this->Warnings.back() : this->Unread;
    return layout;
  }

  void Add(HdfLayout layout)
  {
    this->Arrays.push_back(std::move(layout.Array));
    this->Storages.push_back(std::move(layout.Values));
    this->Kept.emplace_back().push_back(std::move(layout.Origin));
  }

  /// Adds an array whose steps are datasets of one shape.
  void AddSteps(const HdfVolume& volume)
  {
    const auto find = [&](const std::string& dataset)
    {
      return this->FindLayout(
        OpenHdfDataset(this->File.Get(), dataset), volume.Name, volume.Member, false, volume.Axes);
    };
    std::optional<HdfLayout> first = find(volume.Datasets.front());
    std::vector<HdfDataset> others;
    for (std::size_t step = 1; first && step < volume.Datasets.size(); ++step)
    {
      std::optional<HdfLayout> next = find(volume.Datasets[step]);
      if (!next || !next->HasSameValues(*first))
      {
        this->Warnings.push_back("has datasets " + Quote(volume.Datasets.front()) + " and " +
          Quote(volume.Datasets[step]) +
          " that differ in their type, 'scale_factor', 'add_offset' or missing values. Array " +
          Quote(volume.Name) + " is not shown. To show it, give one of its datasets.");
        return;
      }
      if (!next->IsStoredLike(*first))
      {
        next->LeaveToLibrary();
      }
      others.push_back(std::move(next->Origin));
    }
    if (first)
    {
      this->Add(std::move(*first));
      std::move(others.begin(), others.end(), std::back_inserter(this->Kept.back()));
    }
  }

  void ReadByLibrary(
    std::size_t number, int step, const bricks::Index3& chunk, std::byte* out) const
  {
    if (WithoutWaiting::IsInForce())
    {
      throw WouldWait{ true };
    }
    const std::lock_guard<std::mutex> lock(GetHdfLock());
    const HdfSilence silence;
    const FileArray& array = this->Arrays[number];
    const HdfDataset& kept = this->GetDataset(number, step);
    const hid_t dataset = kept.Id.Get();
    const bool isRead = ReadHdfBox(dataset, kept.Type, kept.Member, kept.Shape, kept.GetFrame(step),
      array.Grid.GetBox(chunk), out);
    if (!this->Grows)
    {
      this->Bytes->CheckUnchanged();
    }
    this->Origins.CheckUnchanged();
    if (!isRead)
    {
      const std::string lack = FindLackingHdfFilter(dataset);
      throw FileError({ this->Path, array.Name, chunk },
        "cannot be read by the HDF5 library: " +
          (lack.empty() ? "it is damaged, or a file that it refers to does not exist." : lack));
    }
  }

  bool IsPlaced;                ///< by what the file says
  std::function<bool()> GoesOn; ///< while the file is being opened
  std::shared_ptr<const PositionedFile> Bytes;
  HdfOrigins Origins;
  bool Grows; ///< another program appends to it
  HdfHandle File;
  std::optional<HdfHandle> Coarser;          ///< the group of a coarser level
  hid_t Root = H5I_INVALID_HID;              ///< of the level: that group, or the file
  std::vector<std::vector<HdfDataset>> Kept; ///< of each array: one for all steps, or one for each
  std::string Missing;                       ///< what a file without arrays lacks
  std::string Unread; ///< a warning of an array that cannot be read; empty: there is none
};

} // namespace

std::shared_ptr<VolumeFile> OpenHdf(const std::string& path, const OpenOptions& options)
{
  return HdfFile::Create(path, options);
}

} // namespace vol
