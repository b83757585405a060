// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/open/OpenVolumeFile.h"

#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/PositionedFile.h"
#include "DSMVolumeFiles/base/SmallFile.h"
#include "DSMVolumeFiles/base/Url.h"
#ifdef DSM_HAS_HDF5
#include "DSMVolumeFiles/hdf/HdfFile.h"
#endif
#include "DSMVolumeFiles/open/NamedVectors.h"
#include "DSMVolumeFiles/plain/BareFile.h"
#include "DSMVolumeFiles/plain/HeaderFiles.h"
#include "DSMVolumeFiles/zarr/ZarrFile.h"
#include "DSMVolumeFiles/zarr/ZarrStore.h"

#include <glm/vector_relational.hpp>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <limits>
#include <new>
#include <stdexcept>

namespace vol
{

namespace
{

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
  const bool isUrl = IsUrl(path);
  const std::filesystem::path file(path);
  const std::string name = file.filename().string();
  const bool isPart =
    name == ".zattrs" || name == ".zgroup" || name == ".zarray" || name == "zarr.json";
  std::string folder = isPart ? file.parent_path().string() : path;
  const std::size_t least = isUrl ? path.find("://") + 4 : 1;
  while (folder.size() > least && folder.back() == '/')
  {
    folder.pop_back();
  }
  if (isUrl)
  {
    return folder;
  }
  folder = folder.empty() || folder == "." ? std::filesystem::current_path().string() : folder;
  return MayBeZarr(folder) ? folder : std::string();
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

#ifndef DSM_HAS_HDF5
std::shared_ptr<VolumeFile> OpenHdf(const std::string& path, const OpenOptions&)
{
  throw FileError(path,
    "is an HDF5 file, which this build cannot read. Install the package libhdf5-dev and "
    "build again.");
}
#endif

/// A server gives Zarr only, as other formats cannot be read in parts. Opening it shows what is there.
std::shared_ptr<VolumeFile> OpenUrl(const std::string& url, const OpenOptions& options)
{
  const std::string folder = FindZarrFolder(url);
  const std::string extension = ToLower(std::filesystem::path(folder).extension().string());
  const char* const others[] = { ".h5", ".hdf5", ".hdf", ".vtkhdf", ".nc", ".ims", ".emd", ".nrrd",
    ".nhdr", ".mha", ".mhd", ".raw", ".zip", ".tif", ".tiff" };
  if (std::count(std::begin(others), std::end(others), extension) > 0)
  {
    throw FileError(HideCredentials(url),
      "cannot be opened: only Zarr is read from servers. Copy the file to this computer, or write "
      "it "
      "as Zarr there (Python: zarr.save).");
  }
  return OpenZarr(folder, options);
}

bool IsZip(const std::string& path)
{
  return FindPathKind(path) == PathKind::File && ReadBeginning(path, 4) == "PK\x03\x04";
}

/// Opens a file of one format.
using Format = std::shared_ptr<VolumeFile> (*)(const std::string& path, const OpenOptions& options);

/// Returns the format of a file; null where it is unknown.
Format FindFormat(const std::string& path)
{
  if (IsUrl(path))
  {
    return &OpenUrl;
  }
  if (!FindZarrFolder(path).empty())
  {
    return [](const std::string& part, const OpenOptions& options)
    { return OpenZarr(FindZarrFolder(part), options); };
  }
  if (FindPathKind(path) != PathKind::File)
  {
    return nullptr;
  }
  if (IsZip(path))
  {
    return &OpenZarr;
  }
  if (ReadBeginning(path, 7) == "NRRD000")
  {
    return &OpenNrrd;
  }
  if (HasHdfSignature(PositionedFile(path)))
  {
    return &OpenHdf;
  }
  const std::string extension = ToLower(std::filesystem::path(path).extension().string());
  return extension == ".mhd" || extension == ".mha" ? &OpenMetaImage
    : extension == ".raw"                           ? &OpenRaw
                                                    : nullptr;
}

Format TryFindFormat(const std::string& path)
{
  try
  {
    return FindFormat(path);
  }
  catch (const std::exception&)
  {
    return nullptr;
  }
}

/// As OpenVolumeFile, but that a format without levels, or datasets, does not look at the one that is wanted.
std::shared_ptr<VolumeFile> OpenAsItIs(const std::string& path, const OpenOptions& options)
{
  if (IsUrl(path))
  {
    return OpenUrl(path, options);
  }
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
  if (const Format open = FindFormat(path))
  {
    return open(path, options);
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
  throw FileError(HideCredentials(path), "cannot be opened: " + why + ".");
}

} // namespace

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
  if (!options.Dataset.empty() && FindZarrFolder(path).empty() && !IsZip(path) &&
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
  const std::string extension = ToLower(std::filesystem::path(path).extension().string());
  const bool isApart = extension == ".nhdr" || extension == ".mhd" || !FindZarrFolder(path).empty();
  OpenOptions header = options;
  header.OnlyHeader = true;
  return isApart ? OpenVolumeFile(path, header)->GetStamp() : PositionedFile(path).GetStamp();
}

bool IsBareFile(const std::string& path)
{
  return TryFindFormat(path) == &OpenRaw;
}

bool MayBeVolumeFile(const std::string& path)
{
  return TryFindFormat(path) != nullptr;
}

} // namespace vol
