// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/format/HdfOrigins.h"

#include "DSMCore/base/Error.h"
#include "DSMRayTracing/base/ByteHash.h"
#include "DSMVolumeFiles/base/PositionedFile.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <system_error>

namespace vol
{

namespace
{

namespace fs = std::filesystem;

/// A text that the library writes to where it is told to, when asked for its length first.
template <class Get>
std::string GetText(const Get& get)
{
  const ssize_t length = get(nullptr, 0);
  std::string text(static_cast<std::size_t>(std::max<ssize_t>(0, length)), '\0');
  get(text.data(), text.size() + 1);
  return text;
}

/// The file that an object is in.
std::string GetFileName(hid_t object)
{
  return GetText([=](char* to, std::size_t size) { return H5Fget_name(object, to, size); });
}

/// Where the library looks for a file that another names, first in folders of the environment's; none: nowhere.
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
    std::error_code failure;
    if (fs::exists(place, failure))
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
  const HdfHandle dataset(
    file.IsOpen() ? H5Dopen2(file.Get(), name.c_str(), H5P_DEFAULT) : H5I_INVALID_HID, &H5Dclose);
  return dataset.IsOpen();
}

} // namespace

bool HdfOrigins::Add(const std::string& path, hid_t file, hid_t dataset)
{
  const std::string in = GetFileName(dataset);
  const bool isLinked = in != GetFileName(file);
  if (isLinked)
  {
    this->Keep(in);
  }
  const HdfHandle properties(H5Dget_create_plist(dataset), &H5Pclose);
  const int bare = std::max(0, H5Pget_external_count(properties.Get()));
  for (int number = 0; number < bare; ++number)
  {
    std::string name(4096, '\0');
    off_t offset = 0;
    hsize_t bytes = 0;
    H5Pget_external(properties.Get(), static_cast<unsigned>(number), name.size() - 1, name.data(),
      &offset, &bytes);
    name.resize(name.find('\0'));
    const auto found = FindFile(name, fs::path(in).parent_path(), "HDF5_EXTFILE_PREFIX");
    if (!found)
    {
      throw dsm::Error(
        "The file '" + path + "' has values in the file '" + name + "', which is not there.");
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
  for (std::size_t source = 0; source < count; ++source)
  {
    const std::string file = GetText([&](char* to, std::size_t size)
      { return H5Pget_virtual_filename(properties, source, to, size); });
    const std::string dataset = GetText([&](char* to, std::size_t size)
      { return H5Pget_virtual_dsetname(properties, source, to, size); });
    const auto find = [&](const std::string& name)
    {
      return name == "." ? std::optional<std::string>(path)
                         : FindFile(name, fs::path(path).parent_path(), "HDF5_VDS_PREFIX");
    };
    if (WithNumber(file, 0) != WithNumber(file, 1))
    {
      // As many as there are: more may come, and the library finds out by itself.
      std::optional<std::string> found;
      for (std::size_t number = 0; (found = find(WithNumber(file, number))); ++number)
      {
        this->Keep(*found);
      }
      continue;
    }
    const std::optional<std::string> found = find(WithNumber(file, 0));
    const bool isNumbered = WithNumber(dataset, 0) != WithNumber(dataset, 1);
    if (!found || (!isNumbered && !HasDataset(*found, WithNumber(dataset, 0))))
    {
      throw dsm::Error("The file '" + path + "' has values of the dataset '" + dataset +
        "' of the file '" + file + "', which is not there, or cannot be read.");
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
  rt::ByteHash hash;
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
    throw dsm::Error("The file '" + changed +
      "' was written to, or is gone, since it was opened, and others have values from it. Reload "
      "them.");
  }
}

} // namespace vol
