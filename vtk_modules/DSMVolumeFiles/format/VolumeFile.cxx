// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/format/VolumeFile.h"

#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/PositionedFile.h"
#include "DSMVolumeFiles/base/SmallFile.h"
#include "DSMVolumeFiles/format/BareFile.h"
#include "DSMVolumeFiles/format/HeaderFiles.h"
#include "DSMVolumeFiles/format/HeaderText.h"
#ifdef DSM_HAS_HDF5
#include "DSMVolumeFiles/format/HdfFile.h"
#endif
#include "DSMVolumeFiles/format/NamedVectors.h"
#include "DSMVolumeFiles/format/ZarrFile.h"
#include "DSMVolumeFiles/format/ZarrGroup.h"

#include <glm/ext/vector_uint3_sized.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <limits>
#include <new>
#include <set>
#include <stdexcept>

namespace vol
{

namespace
{

enum class Format
{
  Unknown,
  Raw,
  Nrrd,
  MetaImage,
  Hdf,
  Zarr
};

/// At the beginning, or behind a block of the user's own, of 512 bytes or twice as many, and so on.
bool HasHdfSignature(const PositionedFile& file)
{
  constexpr std::uint64_t most = 1 << 20;
  const std::string signature = "\x89HDF\r\n\x1a\n";
  std::string text(signature.size(), '\0');
  for (std::uint64_t place = 0; place <= most && place + text.size() <= file.GetBytes();
       place = place == 0 ? 512 : 2 * place)
  {
    file.Read(place, reinterpret_cast<std::byte*>(text.data()), text.size());
    if (text == signature)
    {
      return true;
    }
  }
  return false;
}

/// A file of metadata in a Zarr folder may stand for it: a dialog may have files only.
std::string FindZarrFolder(const std::string& path)
{
  const std::filesystem::path file(path);
  const std::string name = file.filename().string();
  const bool isPart =
    name == ".zattrs" || name == ".zgroup" || name == ".zarray" || name == "zarr.json";
  std::string folder = isPart ? file.parent_path().string() : path;
  while (folder.size() > 1 && folder.back() == '/')
  {
    folder.pop_back();
  }
  folder = folder.empty() || folder == "." ? std::filesystem::current_path().string() : folder;
  return MayBeZarr(folder) ? folder : std::string();
}

Format FindFormat(const std::string& path)
{
  if (!FindZarrFolder(path).empty())
  {
    return Format::Zarr;
  }
  if (FindPathKind(path) != PathKind::File)
  {
    return Format::Unknown;
  }
  if (ReadBeginning(path, 7) == "NRRD000")
  {
    return Format::Nrrd;
  }
  if (HasHdfSignature(PositionedFile(path)))
  {
    return Format::Hdf;
  }
  const std::string extension =
    HeaderText::ToLower(std::filesystem::path(path).extension().string());
  return extension == ".mhd" || extension == ".mha" ? Format::MetaImage
    : extension == ".raw"                           ? Format::Raw
                                                    : Format::Unknown;
}

Format TryFindFormat(const std::string& path)
{
  try
  {
    return FindFormat(path);
  }
  catch (const std::exception&)
  {
    return Format::Unknown;
  }
}

std::shared_ptr<VolumeFile> OpenRaw(const std::string& path, const OpenOptions& all)
{
  const OpenOptions::Raw& options = all.Bare;
  if (glm::any(glm::lessThanEqual(options.Samples, bricks::Index3(0))))
  {
    throw dsm::Error("Enter Raw Dimensions in the Properties panel and press Apply: '" + path +
      "' has no header that declares its number of samples along x, y and z. Also check Raw Scalar "
      "Type, Components, Big Endian, Header Bytes and Spacing. (Python: RawDimensions; "
      "dsm_convert: --raw-size.)");
  }
  BareValues values;
  values.Paths = { path };
  values.Name = all.GetArrayName(path);
  values.Samples = options.Samples;
  values.Type = options.Type;
  values.Components = std::max(1, options.Components);
  values.BigEndian = options.BigEndian;
  values.Offset = static_cast<std::int64_t>(
    std::min<std::uint64_t>(options.HeaderBytes, std::numeric_limits<std::int64_t>::max()));
  return OpenBareFile(path, values, {}, all);
}

/// As OpenVolumeFile, but that a format without levels, or datasets, does not look at the one that is wanted.
std::shared_ptr<VolumeFile> OpenAsItIs(const std::string& path, const OpenOptions& options)
{
  const PathKind kind = FindPathKind(path);
  if (kind == PathKind::Nothing)
  {
    throw FileError(path, "does not exist.");
  }
  if (kind != PathKind::Directory)
  {
    // An unreadable file would be reported as an unknown format.
    const PositionedFile readable(path);
  }
  switch (FindFormat(path))
  {
    case Format::Raw:
      return OpenRaw(path, options);
    case Format::Nrrd:
      return OpenNrrd(path, options);
    case Format::MetaImage:
      return OpenMetaImage(path, options);
    case Format::Zarr:
      return OpenZarr(FindZarrFolder(path), options);
    case Format::Hdf:
#ifdef DSM_HAS_HDF5
      return OpenHdf(path, options);
#else
      throw FileError(path,
        "is an HDF5 file, which this build cannot read. Install the package libhdf5-dev and "
        "build again.");
#endif
    case Format::Unknown:
      break;
  }
  if (kind == PathKind::File && ReadBeginning(path, 4) == "PK\x03\x04")
  {
    throw FileError(path,
      "is a ZIP archive, which cannot be read. Unpack it and open the Zarr folder that it "
      "contains.");
  }
  if (kind == PathKind::File && PositionedFile(path).GetBytes() == 0)
  {
    throw FileError(path, "is empty.");
  }
  if (kind == PathKind::File && ReadBeginning(path, 3) == "CDF")
  {
    throw FileError(path,
      "is a netCDF-3 file, which cannot be read. Convert it to netCDF-4: 'nccopy -k nc4 IN.nc "
      "OUT.nc' (Debian: netcdf-bin).");
  }
  throw FileError(path,
    "has an unknown format or a damaged header. Supported formats: HDF5, Zarr (a folder), NRRD, "
    "MetaImage (.mhd, .mha) and .raw. For other image formats, open the file in ParaView and use "
    "Save Data to write a volume in bricks.");
}

/// Gives what other libraries throw the file's name.
std::shared_ptr<VolumeFile> OpenGuarded(const std::string& path, const OpenOptions& options)
{
  std::string why;
  try
  {
    return OpenAsItIs(path, options);
  }
  catch (const std::bad_alloc&)
  {
    why = "out of memory";
  }
  catch (const std::length_error&)
  {
    why = "out of memory";
  }
  catch (const std::filesystem::filesystem_error& error)
  {
    why = "'" + error.path1().string() + "' cannot be read: " + error.code().message();
  }
  throw FileError(path, "cannot be opened: " + why + ".");
}

} // namespace

std::string OpenOptions::GetArrayName(const std::string& path) const
{
  return this->ArrayName.empty() ? GetStem(path) : this->ArrayName;
}

VolumeFile::VolumeFile(std::string path)
  : Path(std::move(path))
{
  static std::atomic<std::uint64_t> last{ 0 };
  this->Number = ++last;
}

bool VolumeFile::IsEvenlySpaced() const
{
  return std::all_of(this->Coordinates.begin(), this->Coordinates.end(),
    [](const std::vector<double>& positions) { return positions.empty(); });
}

void VolumeFile::SetPlace(const OpenOptions& options)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const auto place = static_cast<std::size_t>(axis);
    if (options.Spacing[place] != 0.0)
    {
      this->Geometry.Spacing[axis] = options.Spacing[place];
      this->Coordinates[place].clear();
    }
    if (options.Origin)
    {
      const double origin = (*options.Origin)[place];
      this->Geometry.Origin[axis] = origin;
      std::vector<double>& positions = this->Coordinates[place];
      const double first = positions.empty() ? origin : positions.front();
      for (double& position : positions)
      {
        position += origin - first;
      }
    }
  }
}

void VolumeFile::DropRepeatedWarnings()
{
  std::set<std::string> known;
  const auto isRepeated = [&](const std::string& warning) { return !known.insert(warning).second; };
  this->Warnings.erase(
    std::remove_if(this->Warnings.begin(), this->Warnings.end(), isRepeated), this->Warnings.end());
}

std::string DescribeShape(const bricks::Index3& samples)
{
  return std::to_string(samples.x) + " x " + std::to_string(samples.y) + " x " +
    std::to_string(samples.z);
}

void CheckSizes(const std::string& path, const FileArray& array, std::size_t slices)
{
  const auto refuse = [&](const std::string& what)
  { throw FileError(path, "has an invalid header: it declares " + what + "."); };
  const auto isRight = [&](const bricks::Index3& samples)
  {
    const bricks::Index3 most(static_cast<std::int64_t>(FileLimits::Samples));
    const glm::u64vec3 sides(samples);
    return glm::all(glm::greaterThan(samples, bricks::Index3(0))) &&
      glm::all(glm::lessThanEqual(samples, most)) &&
      MultiplyWithin(
        FileLimits::ArrayBytes, { sides.x, sides.y, sides.z, array.GetSampleBytes(), slices });
  };
  CheckLimit(path, "bytes of an array's name", array.Name.size(), FileLimits::NameBytes);
  if (array.Name.find('\0') != std::string::npos)
  {
    refuse("an array name with a zero byte");
  }
  if (array.Components < 1)
  {
    refuse(std::to_string(array.Components) + " components");
  }
  CheckLimit(
    path, "components", static_cast<std::uint64_t>(array.Components), FileLimits::Components);
  if (!isRight(array.Grid.Samples))
  {
    refuse(DescribeShape(array.Grid.Samples) + " samples");
  }
  if (!isRight(array.Grid.ChunkSamples))
  {
    refuse("chunks of " + DescribeShape(array.Grid.ChunkSamples) + " samples");
  }
}

bool IsSamePlace(const FileGeometry& a, const FileGeometry& b)
{
  constexpr double tolerance = 1e-3;
  bool isSame = a.First == b.First && a.Points == b.Points;
  for (int row = 0; row < 3; ++row)
  {
    double sample = 0.0; // how large it is along this axis of the world
    double apart = std::abs(a.Origin[row] - b.Origin[row]);
    for (int axis = 0; axis < 3; ++axis)
    {
      const double step = a.Direction[3 * row + axis] * a.Spacing[axis];
      const double other = b.Direction[3 * row + axis] * b.Spacing[axis];
      const std::int64_t last = a.First[axis] + a.Points[axis] - 1;
      const auto far = static_cast<double>(std::max(std::abs(a.First[axis]), std::abs(last)));
      sample = std::max(sample, std::abs(step));
      apart += std::abs(step - other) * far;
    }
    isSame = isSame && apart <= tolerance * sample;
  }
  return isSame;
}

void CheckGeometry(const std::string& path, const FileGeometry& geometry)
{
  const auto areFinite = [](const double* numbers, int count)
  {
    return std::all_of(
      numbers, numbers + count, [](double number) { return std::isfinite(number); });
  };
  const auto refuse = [&](const std::string& what, const std::string& why)
  {
    throw FileError(
      path, "has an invalid " + what + ": " + why + ". Fix the source or the file's header.");
  };
  if (!areFinite(geometry.Origin, 3))
  {
    refuse("origin", "a number is not finite");
  }
  if (!areFinite(geometry.Spacing, 3))
  {
    refuse("spacing", "a number is not finite");
  }
  if (std::count(geometry.Spacing, geometry.Spacing + 3, 0.0) > 0)
  {
    refuse("spacing", "a number is zero");
  }
  const double* const m = geometry.Direction;
  if (!areFinite(m, 9))
  {
    refuse("direction matrix", "a number is not finite");
  }
  // Find the volume spanned by axes of length 1. Rounding errors are below this limit.
  constexpr double least = 1e-9;
  double axes[3][3];
  for (int axis = 0; axis < 3; ++axis)
  {
    const double length = std::hypot(m[axis], m[3 + axis], m[6 + axis]);
    for (int row = 0; row < 3; ++row)
    {
      axes[axis][row] = length > 0.0 ? m[3 * row + axis] / length : 0.0;
    }
  }
  const double(&x)[3] = axes[0];
  const double(&y)[3] = axes[1];
  const double(&z)[3] = axes[2];
  const double determinant = x[0] * (y[1] * z[2] - y[2] * z[1]) -
    x[1] * (y[0] * z[2] - y[2] * z[0]) + x[2] * (y[0] * z[1] - y[1] * z[0]);
  if (!(std::abs(determinant) >= least))
  {
    refuse("direction matrix", "the matrix is singular");
  }
}

std::shared_ptr<const VolumeFile> OpenVolumeFile(
  const std::string& path, const OpenOptions& options)
{
  auto file = OfferVectors(OpenGuarded(path, options));
  file->SetPlace(options);
  file->DropRepeatedWarnings();
  CheckGeometry(path, file->GetGeometry());
  if (options.Level != 0 && options.Level >= file->GetLevels())
  {
    throw FileError(path,
      "has no level " + std::to_string(options.Level) +
        ": it has no coarser levels. The only valid level is 0.");
  }
  const std::vector<FileArray>& arrays = file->GetArrays();
  // A dataset may have several arrays: members of its values, and positions along further axes.
  const auto isOfDataset = [&](const FileArray& array)
  {
    const std::string& wanted = options.Dataset;
    const bool isPart = array.Name.size() > wanted.size() &&
      std::string("/ ").find(array.Name[wanted.size()]) != std::string::npos;
    return array.Name.compare(0, wanted.size(), wanted) == 0 &&
      (array.Name.size() == wanted.size() || isPart);
  };
  if (!options.Dataset.empty() && FindZarrFolder(path).empty() &&
    !std::all_of(arrays.begin(), arrays.end(), isOfDataset))
  {
    throw FileError(path,
      "does not support choosing a dataset ('" + options.Dataset +
        "'): only Zarr and HDF5 files other than VTKHDF do. Choose among the file's arrays.");
  }
  return file;
}

std::uint64_t FindStamp(const std::string& path, const OpenOptions& options)
{
  const std::string extension =
    HeaderText::ToLower(std::filesystem::path(path).extension().string());
  const bool isApart = extension == ".nhdr" || extension == ".mhd" || !FindZarrFolder(path).empty();
  OpenOptions header = options;
  header.OnlyHeader = true;
  return isApart ? OpenVolumeFile(path, header)->GetStamp() : PositionedFile(path).GetStamp();
}

bool IsBareFile(const std::string& path)
{
  return TryFindFormat(path) == Format::Raw;
}

bool MayBeVolumeFile(const std::string& path)
{
  return TryFindFormat(path) != Format::Unknown;
}

} // namespace vol
