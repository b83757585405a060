// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/hdf/HdfOrigins.h"

#include "DSMBricks/base/ByteHash.h"
#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/FileLimits.h"
#include "DSMVolumeFiles/base/PositionedFile.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <system_error>

namespace vol
{

namespace
{

namespace fs = std::filesystem;

/// Finds a file that another names, as the library does: first in folders of the environment
/// variable. Returns nothing if there is none.
std::optional<std::string> FindFile(
  const std::string& name, const fs::path& folder, const char* variable)
{
  std::vector<fs::path> places;
  const char* const prefixes = std::getenv(variable);
  std::string rest = prefixes ? prefixes : "";
  while (!rest.empty())
  {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    std::string one = rest.substr(0, end);
    rest.erase(0, end + 1);
    const std::string origin = "${ORIGIN}";
    if (one.rfind(origin, 0) == 0)
    {
      one.replace(0, origin.size(), folder.string());
    }
    places.push_back(fs::path(one) / name);
  }
  places.push_back(folder / name);
  places.emplace_back(name);
  places.push_back(folder / fs::path(name).filename());
  for (const fs::path& place : places)
  {
    // The library would wait for a pipe, or read a device without an end.
    std::error_code failure;
    if (fs::is_regular_file(place, failure))
    {
      return place.string();
    }
  }
  return std::nullopt;
}

/// A source's name, in which %b stands for the number of a block.
std::string WithNumber(const std::string& name, std::size_t number)
{
  std::string made;
  for (std::size_t at = 0; at < name.size(); ++at)
  {
    if (name[at] == '%' && at + 1 < name.size())
    {
      ++at;
      made += name[at] == 'b' ? std::to_string(number) : std::string(1, name[at]);
    }
    else
    {
      made += name[at];
    }
  }
  return made;
}

bool HasDataset(const std::string& path, const std::string& name)
{
  const HdfHandle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), &H5Fclose);
  return file.IsOpen() && OpenHdfDataset(file.Get(), name).IsOpen();
}

/// The library asks before it opens the file of an external link; -1 forbids it.
herr_t CheckLinkedFile(
  const char* from, const char*, const char* file, const char*, unsigned*, hid_t, void*)
{
  try
  {
    return FindFile(file, fs::path(from).parent_path(), "HDF5_EXT_PREFIX") ? 0 : -1;
  }
  catch (const std::exception&)
  {
    return -1;
  }
}

} // namespace

HdfHandle OpenHdfDataset(hid_t group, const std::string& name)
{
  const HdfHandle access(H5Pcreate(H5P_DATASET_ACCESS), &H5Pclose);
  H5Pset_elink_cb(access.Get(), &CheckLinkedFile, nullptr);
  return { H5Dopen2(group, name.c_str(), access.Get()), &H5Dclose };
}

HdfHandle OpenHdfObject(hid_t group, const std::string& name)
{
  const HdfHandle access(H5Pcreate(H5P_LINK_ACCESS), &H5Pclose);
  H5Pset_elink_cb(access.Get(), &CheckLinkedFile, nullptr);
  return { H5Oopen(group, name.c_str(), access.Get()), &H5Oclose };
}

bool HdfOrigins::Add(const std::string& path, hid_t file, hid_t dataset)
{
  const std::string in = GetHdfText(&H5Fget_name, dataset);
  const bool isLinked = in != GetHdfText(&H5Fget_name, file);
  if (isLinked)
  {
    this->Keep(in);
  }
  const HdfHandle properties(H5Dget_create_plist(dataset), &H5Pclose);
  const int bare = std::max(0, H5Pget_external_count(properties.Get()));
  CheckLimit(
    path, "external files of a dataset", static_cast<std::uint64_t>(bare), FileLimits::Sources);
  for (int number = 0; number < bare; ++number)
  {
    std::string name(FileLimits::NameBytes, '\0');
    off_t offset = 0;
    hsize_t bytes = 0;
    H5Pget_external(properties.Get(), static_cast<unsigned>(number), name.size() - 1, name.data(),
      &offset, &bytes);
    name.resize(std::min(name.size(), name.find('\0')));
    const auto found = FindFile(name, fs::path(in).parent_path(), "HDF5_EXTFILE_PREFIX");
    if (!found)
    {
      throw FileError(path,
        "refers to the file '" + name +
          "' for values. That file does not exist or is not a regular file.");
    }
    this->Keep(*found);
  }
  const bool isVirtual = H5Pget_layout(properties.Get()) == H5D_VIRTUAL;
  if (isVirtual)
  {
    this->AddSources(in, properties.Get());
  }
  return isLinked || bare > 0 || isVirtual;
}

void HdfOrigins::AddSources(const std::string& path, hid_t properties)
{
  std::size_t count = 0;
  H5Pget_virtual_count(properties, &count);
  CheckLimit(path, "sources of a virtual dataset", count, FileLimits::Sources);
  for (std::size_t source = 0; source < count; ++source)
  {
    const std::string file = GetHdfText(&H5Pget_virtual_filename, properties, source);
    const std::string dataset = GetHdfText(&H5Pget_virtual_dsetname, properties, source);
    const auto find = [&](const std::string& name)
    {
      return name == "." ? std::optional<std::string>(path)
                         : FindFile(name, fs::path(path).parent_path(), "HDF5_VDS_PREFIX");
    };
    if (WithNumber(file, 0) != WithNumber(file, 1))
    {
      // As many as there are: more may come, and the library finds out by itself. Where the number is in the name of a
      // folder, the search may end at the same file for every number.
      std::string last;
      for (std::size_t number = 0; number < FileLimits::Sources; ++number)
      {
        const std::optional<std::string> found = find(WithNumber(file, number));
        if (!found || *found == last)
        {
          break;
        }
        this->Keep(*found);
        last = *found;
      }
      continue;
    }
    const std::optional<std::string> found = find(WithNumber(file, 0));
    const bool isNumbered = WithNumber(dataset, 0) != WithNumber(dataset, 1);
    if (!found || (!isNumbered && !HasDataset(*found, WithNumber(dataset, 0))))
    {
      throw FileError(path,
        "refers to the dataset '" + dataset + "' of the file '" + file +
          "' for values. It does not exist or cannot be read.");
    }
    if (*found != path)
    {
      this->Keep(*found);
    }
  }
}

void HdfOrigins::Keep(const std::string& path)
{
  this->Stamps.emplace(path, PositionedFile::FindStampOf(path));
}

std::vector<std::string> HdfOrigins::GetPaths() const
{
  std::vector<std::string> paths;
  for (const auto& [path, stamp] : this->Stamps)
  {
    paths.push_back(path);
  }
  return paths;
}

std::uint64_t HdfOrigins::GetStamp(std::uint64_t own) const
{
  if (this->Stamps.empty())
  {
    return own;
  }
  bricks::ByteHash hash;
  hash.Add(&own, sizeof(own));
  for (const auto& [path, stamp] : this->Stamps)
  {
    hash.Add(&stamp, sizeof(stamp));
  }
  return hash.Get();
}

std::string HdfOrigins::FindChanged() const
{
  const auto changed = std::find_if(this->Stamps.begin(), this->Stamps.end(),
    [](const auto& one) { return PositionedFile::FindStampOf(one.first) != one.second; });
  return changed == this->Stamps.end() ? std::string() : changed->first;
}

bool HdfOrigins::AreUnchanged() const
{
  return this->FindChanged().empty();
}

void HdfOrigins::CheckUnchanged() const
{
  const std::string changed = this->FindChanged();
  if (!changed.empty())
  {
    throw FileError(
      changed, "changed or was deleted after it was opened. Reload the files that refer to it.");
  }
}

} // namespace vol
