// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/zarr/ZarrZip.h"

#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/FileLimits.h"
#include "DSMVolumeFiles/base/PositionedFile.h"
#include "DSMVolumeFiles/zarr/ZipDirectory.h"

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <utility>
#include <vector>

namespace vol
{

namespace
{

class ZarrZip final : public ZarrStore
{
public:
  explicit ZarrZip(const std::string& path)
    : Root(path)
    , Zip(std::make_shared<const PositionedFile>(path))
  {
    if (!this->HasMetadata(path))
    {
      this->EnterFolder();
    }
  }

  std::optional<std::string> ReadMetadata(
    const std::string& folder, const std::string& name) const override
  {
    const auto file = this->Open(folder + "/" + name,
      { Manner::Kind::Whole, static_cast<std::uint64_t>(FileLimits::JsonBytes) });
    if (!file)
    {
      return std::nullopt;
    }
    CheckLimit(file->GetPath(), "bytes", file->GetBytes(), FileLimits::JsonBytes);
    std::string text(static_cast<std::size_t>(file->GetBytes()), '\0');
    file->Read({ { 0, text.size() } }, reinterpret_cast<std::byte*>(text.data()));
    return text;
  }

  bool HasMetadata(const std::string& folder) const override
  {
    const auto names = { "/zarr.json", "/.zarray", "/.zgroup" };
    return std::any_of(names.begin(), names.end(),
      [&](const char* name) { return this->Find(folder + name) != nullptr; });
  }

  void AddStamps(const std::string& folder, bricks::ByteHash& hash) const override
  {
    const std::uint64_t stamp = this->Zip.GetArchive().GetStamp();
    hash.Add(&stamp, sizeof(stamp));
    hash.Add(folder.data(), folder.size());
  }

  void CheckThere(const std::string&) const override {}

  std::vector<std::string> FindFolders(const std::string& folder) const override
  {
    std::vector<std::string> found;
    const std::string beginning = this->GetName(folder + "/");
    const auto& members = this->Zip.GetMembers();
    for (auto member = this->Zip.FindFirst(beginning); member != members.end();)
    {
      if (member->Name.compare(0, beginning.size(), beginning) != 0)
      {
        break;
      }
      const std::size_t slash = member->Name.find('/', beginning.size());
      if (slash == std::string::npos)
      {
        ++member;
        continue;
      }
      const std::string name = member->Name.substr(beginning.size(), slash - beginning.size());
      if (this->HasMetadata(folder + "/" + name))
      {
        found.push_back(name);
      }
      // Behind all that begins so: '0' follows '/'.
      member = this->Zip.FindFirst(beginning + name + "0");
    }
    return found;
  }

  bool MayHaveFolder(const std::string& path) const override { return this->HasMetadata(path); }

  bool LooksNested(const std::string& folder, std::size_t) const override
  {
    const std::string beginning = this->GetName(folder + "/0/");
    const auto member = this->Zip.FindFirst(beginning);
    return member != this->Zip.GetMembers().end() &&
      member->Name.compare(0, beginning.size(), beginning) == 0;
  }

  bool CanList() const override { return false; }

  std::shared_ptr<const StampedSource> Open(
    const std::string& path, const Manner& manner) const override
  {
    const ZipDirectory::Member* const member = this->Find(path);
    const std::uint64_t most =
      manner.How == Manner::Kind::Whole ? manner.Bytes : FileLimits::ChunkBytes;
    return member ? this->Zip.Open(*member, path, most) : nullptr;
  }

private:
  /// The name of a member: its path without that of the archive.
  std::string GetName(const std::string& path) const
  {
    return this->Inside + path.substr(std::min(path.size(), this->Root.size() + 1));
  }
  const ZipDirectory::Member* Find(const std::string& path) const
  {
    return path.compare(0, this->Root.size() + 1, this->Root + "/") == 0
      ? this->Zip.Find(this->GetName(path))
      : nullptr;
  }

  /// An archive may have a folder around all.
  void EnterFolder()
  {
    const auto& members = this->Zip.GetMembers();
    const std::size_t slash = members.empty() ? std::string::npos : members.front().Name.find('/');
    if (slash != std::string::npos)
    {
      this->Inside = members.front().Name.substr(0, slash + 1);
    }
    if (!this->HasMetadata(this->Root))
    {
      throw FileError(this->Root,
        "is a ZIP archive without a Zarr volume: neither it nor its first folder has 'zarr.json', "
        "'.zarray' or '.zgroup'. Unpack it and open what it contains.");
    }
  }

  std::string Root;
  std::string Inside; ///< the folder around all, with '/'; or empty
  ZipDirectory Zip;
};

} // namespace

std::shared_ptr<ZarrStore> MakeZarrZip(const std::string& path)
{
  return std::make_shared<ZarrZip>(path);
}

} // namespace vol
