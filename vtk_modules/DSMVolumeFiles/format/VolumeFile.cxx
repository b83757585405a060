// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/format/VolumeFile.h"

#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/PositionedFile.h"
#include "DSMVolumeFiles/format/BareFile.h"
#include "DSMVolumeFiles/format/HeaderFiles.h"
#include "DSMVolumeFiles/format/HeaderText.h"
#ifdef DSM_HAS_HDF5
#include "DSMVolumeFiles/format/HdfFile.h"
#endif
#include "DSMVolumeFiles/format/ZarrFile.h"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <limits>

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

std::string ReadFirst(const std::string& path, std::size_t bytes)
{
  std::ifstream file(path, std::ios::binary);
  std::string text(bytes, '\0');
  file.read(text.data(), static_cast<std::streamsize>(bytes));
  text.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, file.gcount())));
  return text;
}

/// At the beginning, or behind a block of the user's own, of 512 bytes or twice as many, and so on.
bool HasHdfSignature(const std::string& path)
{
  constexpr std::streamoff most = 1 << 20;
  const std::string signature = "\x89HDF\r\n\x1a\n";
  std::ifstream file(path, std::ios::binary);
  std::string text(signature.size(), '\0');
  for (std::streamoff place = 0; place <= most && file.seekg(place) &&
       file.read(text.data(), static_cast<std::streamsize>(text.size()));
       place = place == 0 ? 512 : 2 * place)
  {
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
  const std::string first = ReadFirst(path, 8);
  if (first.rfind("NRRD000", 0) == 0)
  {
    return Format::Nrrd;
  }
  if (HasHdfSignature(path))
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

std::shared_ptr<const VolumeFile> OpenRaw(const std::string& path, const OpenOptions::Raw& options)
{
  if (rt::Box{ rt::Index3(0), options.Samples }.GetCount() == 0)
  {
    throw dsm::Error("The file '" + path +
      "' has bare values and no header: enter how many samples there are along each axis (Raw "
      "Dimensions, or --raw-size of dsm_convert), and their type.");
  }
  BareValues values;
  values.Path = path;
  values.Name = "values";
  values.Samples = options.Samples;
  values.Type = options.Type;
  values.Components = std::max(1, options.Components);
  values.BigEndian = options.BigEndian;
  values.Offset = static_cast<std::int64_t>(options.HeaderBytes);
  FileGeometry geometry;
  std::copy_n(options.Spacing, 3, geometry.Spacing);
  return OpenBareFile(path, values, geometry);
}

/// As OpenVolumeFile, but that a format without levels, or datasets, does not look at the one that is wanted.
std::shared_ptr<const VolumeFile> OpenAsItIs(const std::string& path, const OpenOptions& options)
{
  if (!std::filesystem::exists(path))
  {
    throw dsm::Error("There is no file '" + path + "'.");
  }
  if (!std::filesystem::is_directory(path))
  {
    // What cannot be read would look like nothing that is known.
    const PositionedFile readable(path);
  }
  switch (FindFormat(path))
  {
    case Format::Raw:
      return OpenRaw(path, options.Bare);
    case Format::Nrrd:
      return OpenNrrd(path);
    case Format::MetaImage:
      return OpenMetaImage(path);
    case Format::Zarr:
      return OpenZarr(FindZarrFolder(path), options.Level);
    case Format::Hdf:
#ifdef DSM_HAS_HDF5
      return OpenHdf(path, options);
#else
      throw dsm::Error("'" + path +
        "' is an HDF5 file, which this build cannot read. Install the package libhdf5-dev and "
        "build again.");
#endif
    case Format::Unknown:
      break;
  }
  if (ReadFirst(path, 4) == "PK\x03\x04")
  {
    throw dsm::Error("'" + path +
      "' is a ZIP archive, and cannot be read. Unpack it, and open what it has: a Zarr's folder.");
  }
  if (!std::filesystem::is_directory(path) && std::filesystem::file_size(path) == 0)
  {
    throw dsm::Error("The file '" + path + "' is empty.");
  }
  throw dsm::Error("The format of '" + path +
    "' is not known, or the file is damaged at its beginning. HDF5, Zarr (a folder), NRRD, "
    "MetaImage (.mhd, .mha) and .raw are known. Whatever else ParaView opens as an image, its Save "
    "Data writes as a volume in bricks.");
}

} // namespace

VolumeFile::VolumeFile(std::string path)
  : Path(std::move(path))
{
  static std::atomic<std::uint64_t> last{ 0 };
  this->Number = ++last;
}

std::string DescribeShape(const rt::Index3& samples)
{
  return std::to_string(samples.x) + " x " + std::to_string(samples.y) + " x " +
    std::to_string(samples.z);
}

void CheckSizes(const std::string& path, const FileArray& array, std::size_t slices)
{
  const auto refuse = [&](const std::string& what)
  { throw dsm::Error("The file '" + path + "' cannot be used: it tells of " + what + "."); };
  // Indices of images are int, and bytes are counted in 64 bits.
  constexpr std::int64_t mostAlong = std::numeric_limits<int>::max();
  constexpr long double mostBytes = 0x1p62L;
  const auto isRight = [&](const rt::Index3& samples)
  {
    const long double bytes = static_cast<long double>(samples.x) * samples.y * samples.z *
      array.Components * rt::GetBytes(array.Type) * slices;
    return glm::all(glm::greaterThan(samples, rt::Index3(0))) &&
      glm::all(glm::lessThanEqual(samples, rt::Index3(mostAlong))) && bytes <= mostBytes;
  };
  if (array.Components < 1)
  {
    refuse(std::to_string(array.Components) + " components of each sample");
  }
  if (!isRight(array.Grid.Samples))
  {
    refuse(DescribeShape(array.Grid.Samples) + " samples");
  }
  if (!isRight(array.Grid.ChunkSamples))
  {
    refuse("chunks of " + DescribeShape(array.Grid.ChunkSamples) + " samples");
  }
}

std::shared_ptr<const VolumeFile> OpenVolumeFile(
  const std::string& path, const OpenOptions& options)
{
  auto file = OpenAsItIs(path, options);
  if (options.Level != 0 && options.Level >= file->GetLevels())
  {
    throw dsm::Error("'" + path + "' has no coarser levels of detail; level " +
      std::to_string(options.Level) + " is none of it.");
  }
  const std::vector<FileArray>& arrays = file->GetArrays();
  if (!options.Dataset.empty() && (arrays.size() > 1 || arrays.front().Name != options.Dataset))
  {
    throw dsm::Error("'" + path + "' has no datasets to choose '" + options.Dataset +
      "' from: only HDF5 files that are not VTK's have. Choose among its arrays.");
  }
  return file;
}

std::uint64_t FindStamp(const std::string& path, const OpenOptions& options)
{
  const std::string extension =
    HeaderText::ToLower(std::filesystem::path(path).extension().string());
  const bool isApart = extension == ".nhdr" || extension == ".mhd" || !FindZarrFolder(path).empty();
  return isApart ? OpenVolumeFile(path, options)->GetStamp() : PositionedFile(path).GetStamp();
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
