// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_VolumeFile_h
#define vol_VolumeFile_h

#include "DSMBricks/base/ScalarType.h"
#include "DSMBricks/base/ValidValues.h"
#include "DSMVolumeFiles/base/ChunkGrid.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace vol
{

/// One array of a volume file.
struct FileArray
{
  std::string Name;
  bricks::ScalarType Type = bricks::ScalarType::UInt8;
  int Components = 1;
  bool OnCells = false;   ///< else on the points
  bool IsActive = false;  ///< the points' scalars, where the file says so
  bool IsOffered = false; ///< repeats values of others, so it is used only where it is asked for
  ChunkGrid Grid;
  /// By the array's own attributes. Floating point values that are missing are read as NaN.
  bricks::ValidValues Valid;

  std::size_t GetSampleBytes() const
  {
    return bricks::GetBytes(this->Type) * static_cast<std::size_t>(this->Components);
  }
};

/// For messages: along x, y and z.
std::string DescribeShape(const bricks::Index3& samples);

/// Throws dsm::Error, which names the file, where an array or its chunks have no samples, or more than FileLimits
/// has, or a name that is too long: a header may declare anything. To be called before anything is computed with
/// its sizes. `slices`: boxes of samples in what is stored as one chunk.
void CheckSizes(const std::string& path, const FileArray& array, std::size_t slices = 1);

/// Placement of the samples in world space, as in vtkImageData. Plain.
struct FileGeometry
{
  double Origin[3] = { 0.0, 0.0, 0.0 };
  double Spacing[3] = { 1.0, 1.0, 1.0 };
  double Direction[9] = { 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0 };
  bricks::Index3 First{ 0 };  ///< index of the first point
  bricks::Index3 Points{ 0 }; ///< points along each axis
};

/// Positions of the samples along x, y and z, which rise or fall everywhere, as in vtkRectilinearGrid. An axis without
/// positions has those of origin and spacing.
using GridCoordinates = std::array<std::vector<double>, 3>;

/// Returns whether two places are one, but for what numbers in texts are rounded: by less than a thousandth of a
/// sample, at any sample.
bool IsSamePlace(const FileGeometry& a, const FileGeometry& b);

/// Throws dsm::Error, which names the file, where a number is not finite, or a distance zero, or where the
/// directions of the axes lie in one plane: no world position would have an index.
void CheckGeometry(const std::string& path, const FileGeometry& geometry);

struct OpenOptions;

/// A volume in a file, or in a folder of files, of which no values are read when it is opened. Its members may
/// be called by any thread, at the same time.
class VolumeFile
{
public:
  virtual ~VolumeFile() = default;
  VolumeFile(const VolumeFile&) = delete;
  VolumeFile& operator=(const VolumeFile&) = delete;

  const std::string& GetPath() const { return this->Path; }
  const FileGeometry& GetGeometry() const { return this->Geometry; }
  /// Where all axes have none, the samples are evenly spaced; else the directions of the axes are the world's.
  const GridCoordinates& GetCoordinates() const { return this->Coordinates; }
  bool IsEvenlySpaced() const;
  /// At least one; the points' arrays have as many samples as there are points, the cells' one less along an
  /// axis of more than one point.
  const std::vector<FileArray>& GetArrays() const { return this->Arrays; }
  /// At least 1. All steps have the same arrays.
  int GetSteps() const { return this->Steps; }
  /// The steps' times, ascending: the file's own, or their numbers.
  double GetTime(int step) const
  {
    return this->Times.empty() ? step : this->Times[static_cast<std::size_t>(step)];
  }
  /// All that were opened for it, in the order of steps: GetPath, unless it is a series of files.
  virtual std::vector<std::string> GetPaths() const { return { this->Path }; }
  /// The files that a step's values come from, or folders of files. Throws dsm::Error.
  virtual std::vector<std::string> GetFiles(int) const { return { this->Path }; }
  /// The file that has a step's values, with its stamp, and which of its own steps it is. Throws dsm::Error.
  struct StepOrigin
  {
    std::string Path;
    std::uint64_t Stamp;
    int Step;
  };
  virtual StepOrigin GetOrigin(int step) const { return { this->Path, this->Stamp, step }; }
  std::filesystem::file_time_type GetTimeOpened() const { return this->OpenedAt; }
  /// Number of levels of detail, of which one was opened.
  int GetLevels() const { return this->Levels; }
  /// Attributes of the file that are not honored: for each a sentence after the file's name, such as "has 'scanner'
  /// as its space, which is taken for left-posterior-superior.".
  const std::vector<std::string>& GetWarnings() const { return this->Warnings; }
  /// Differs, for all practical purposes, when the file's contents do.
  std::uint64_t GetStamp() const { return this->Stamp; }
  /// No other one of this process has it, or had it before.
  std::uint64_t GetNumber() const { return this->Number; }

  /// The samples of a chunk that belong to the volume (ChunkGrid::GetBox), dense, x fastest, the components of a
  /// sample together, in the machine's byte order. Throws dsm::Error, which names file and chunk, when they
  /// cannot be read, or are not what the file's checksums and lengths tell.
  virtual void ReadChunk(
    std::size_t array, int step, const bricks::Index3& chunk, std::byte* out) const = 0;

  /// Returns whether no sample of a box is stored, so that all have the fill value, and this is known without reading.
  /// False where it is not known. Fast; throws nothing but std::bad_alloc.
  virtual bool IsFill(std::size_t, int /*step*/, const bricks::Box&) const { return false; }

  /// Returns the bytes in memory, while the file is open, of the tables of its chunks.
  virtual std::uint64_t GetTableBytes() const { return 0; }

  /// The samples of a part of a chunk, likewise, where no more than these need be read for them; else false, and
  /// nothing is read.
  virtual bool ReadPart(
    std::size_t, int, const bricks::Index3&, const bricks::Box&, std::byte*) const
  {
    return false;
  }

  /// The samples of ChunkGrid::GetBoxWithHalo, likewise, where the file has them together, as that of a brick file
  /// with Zstandard; else false.
  virtual bool ReadWithHalo(std::size_t, int, const bricks::Index3&, std::byte*) const
  {
    return false;
  }

  struct ChunkPart
  {
    bricks::Index3 Chunk;
    bricks::Box Samples;
  };
  /// Parts of chunks will probably be read soon: the system may fetch them to its own cache meanwhile, or all of a
  /// chunk where a part cannot be read alone. Throws dsm::Error.
  virtual void Prefetch(std::size_t, int, const std::vector<ChunkPart>&) const {}

  /// Data about an array that dsm_convert writes beside its values (docs/files.md); empty if the file has none.
  /// Throws std::bad_alloc.
  struct Index
  {
    /// For each component, and, where there are several, for the magnitude: least and greatest value, and the
    /// same of finite ones.
    std::vector<double> Ranges;
    /// bricks::VoxelIndex as it is kept, of a lattice with this edge.
    std::vector<std::byte> Bricks;
    int BrickEdge = 0;
  };
  virtual Index ReadIndex(std::size_t /*array*/, int /*step*/) const { return {}; }

  /// Before anybody else has the file: takes spacing and origin where the options have them.
  void SetPlace(const OpenOptions& options);
  /// Likewise: several arrays may have the same ones.
  void DropRepeatedWarnings();

protected:
  explicit VolumeFile(std::string path);

  std::string Path;
  FileGeometry Geometry;
  GridCoordinates Coordinates;
  std::vector<FileArray> Arrays;
  int Steps = 1;
  std::vector<double> Times; ///< times of the steps, or empty
  int Levels = 1;
  std::vector<std::string> Warnings;
  std::uint64_t Stamp = 0;

private:
  std::uint64_t Number;
  std::filesystem::file_time_type OpenedAt = std::filesystem::file_time_type::clock::now();
};

/// Options for what the header of a file does not define, or leaves open.
struct OpenOptions
{
  /// Level of detail, for a Zarr group with several scales or a brick file with several levels: 0 is the finest.
  int Level = 0;
  /// Dataset to read, for an HDF5 file without VTKHDF, or a Zarr folder of several; empty: the
  /// datasets with the largest shape of three axes in space.
  std::string Dataset;

  /// Name for an array that has none in the file; empty: that of the file.
  std::string ArrayName;
  std::string GetArrayName(const std::string& path) const;

  /// Called now and then by the opening thread while a file is being opened, because an index of many chunks
  /// takes time. If it returns false, opening ends with dsm::Error. May be empty.
  std::function<bool()> GoesOn;
  /// When another level of the same volume was opened: what a server has said since then need not be asked again.
  std::optional<std::filesystem::file_time_type> OpenedAt;
  /// Only what headers and file systems say is wanted: compressed values of NRRD and MetaImage are not unpacked, and
  /// cannot be read.
  bool OnlyHeader = false;

  /// Description of a file of bare values (.raw).
  struct Raw
  {
    bricks::Index3 Samples{ 0 };
    bricks::ScalarType Type = bricks::ScalarType::UInt8;
    int Components = 1;
    bool BigEndian = false;
    std::uint64_t HeaderBytes = 0;
  };
  Raw Bare;

  /// Distance of samples along x, y and z, instead of what the file says; 0: as it says.
  std::array<double, 3> Spacing{ 0.0, 0.0, 0.0 };
  /// Position of the first sample, likewise; none: as it says.
  std::optional<std::array<double, 3>> Origin;

  /// Returns whether nothing is left that a file could say of distances.
  bool HasSpacing() const
  {
    return this->Spacing[0] != 0.0 && this->Spacing[1] != 0.0 && this->Spacing[2] != 0.0;
  }
};

} // namespace vol

#endif
