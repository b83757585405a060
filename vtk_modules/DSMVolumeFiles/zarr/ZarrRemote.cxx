// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/zarr/ZarrRemote.h"

#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/FileLimits.h"
#include "DSMVolumeFiles/remote/HttpClient.h"
#include "DSMVolumeFiles/remote/RemoteKeys.h"
#include "DSMVolumeFiles/zarr/ZarrJson.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <set>
#include <utility>
#include <vector>

namespace vol
{

namespace
{

class ZarrRemote final : public ZarrStore
{
public:
  ZarrRemote(const std::string& url, const OpenOptions& options)
    : Keys(std::make_shared<RemoteKeys>(url, options.GoesOn, options.OpenedAt))
    , Root(url)
  {
    const std::size_t last = url.rfind('/');
    const bool hasParent = last > url.find("://") + 2;
    this->Parent = hasParent ? url.substr(0, last + 1) : url + "/";
    this->FindRoot();
  }

  void EndOpening() override { this->Keys->EndOpening(); }

  std::optional<std::string> ReadMetadata(
    const std::string& folder, const std::string& name) const override
  {
    // A store has one version. Some servers answer 403 for what they do not have.
    if ((name == "zarr.json") != this->IsThird)
    {
      return std::nullopt;
    }
    const std::string path = folder + "/" + name;
    const std::string& around = this->Parent;
    if (path.compare(0, around.size(), around) != 0)
    {
      return std::nullopt;
    }
    const std::lock_guard<std::mutex> lock(this->Guard);
    const auto known = this->Texts.find(path);
    if (known != this->Texts.end())
    {
      return known->second;
    }
    const bool isInside = path.compare(0, this->Root.size() + 1, this->Root + "/") == 0;
    if (this->IsConsolidated && isInside)
    {
      return std::nullopt;
    }
    return this->Texts[path] = this->Fetch(path);
  }

  bool HasMetadata(const std::string& folder) const override
  {
    const auto names = { "zarr.json", ".zarray", ".zgroup" };
    return std::any_of(names.begin(), names.end(),
      [&](const char* name) { return this->ReadMetadata(folder, name).has_value(); });
  }

  void AddStamps(const std::string& folder, bricks::ByteHash& hash) const override
  {
    const std::string name = this->IsThird ? "zarr.json" : ".zarray";
    const std::string text = this->ReadMetadata(folder, name).value_or("");
    hash.Add(text.data(), text.size());
    this->Keys->AddStamp(this->IsConsolidated ? this->RootKey : folder + "/" + name, hash);
  }

  void CheckThere(const std::string&) const override { this->Keys->CheckThere(this->RootKey); }

  bool KnowsFolders() const override { return this->IsConsolidated; }

  std::vector<std::string> FindFolders(const std::string& folder) const override
  {
    if (!this->IsConsolidated)
    {
      throw FileError(folder,
        "is a group, and a server does not list what is in it. Enter the path of an array or image "
        "in it as Dataset, or write consolidated metadata (Python: zarr.consolidate_metadata).");
    }
    const std::lock_guard<std::mutex> lock(this->Guard);
    const std::string beginning = folder + "/";
    std::set<std::string> found;
    for (auto text = this->Texts.lower_bound(beginning);
         text != this->Texts.end() && text->first.compare(0, beginning.size(), beginning) == 0;
         ++text)
    {
      // One folder, and a file of metadata in it.
      const std::string rest = text->first.substr(beginning.size());
      const std::size_t slash = rest.find('/');
      if (text->second && slash != std::string::npos &&
        rest.find('/', slash + 1) == std::string::npos &&
        rest.compare(slash, std::string::npos, "/.zattrs") != 0)
      {
        found.insert(rest.substr(0, slash));
      }
    }
    return { found.begin(), found.end() };
  }

  bool MayHaveFolder(const std::string& path) const override
  {
    try
    {
      return this->HasMetadata(path);
    }
    catch (const HttpClient::Refusal&) // as some say of what they do not have
    {
      return false;
    }
  }
  bool LooksNested(const std::string& folder, std::size_t axes) const override
  {
    std::string first = folder;
    for (std::size_t axis = 0; axis < axes; ++axis)
    {
      first += "/0";
    }
    try
    {
      return this->Keys->Open(first, { 0, 1, false }) != nullptr;
    }
    catch (const HttpClient::Refusal&)
    {
      return false;
    }
  }

  bool CanList() const override { return false; }

  std::shared_ptr<const StampedSource> Open(
    const std::string& path, const Manner& manner) const override
  {
    using Kind = Manner::Kind;
    return manner.How == Kind::Whole
      ? this->Keys->Fetch(path, manner.Bytes)
      : this->Keys->Open(path, { 0, manner.Bytes, manner.How == Kind::FromLast });
  }

private:
  std::optional<std::string> Fetch(const std::string& path) const
  {
    const auto key = this->Keys->Fetch(path, FileLimits::JsonBytes);
    if (!key)
    {
      return std::nullopt;
    }
    std::string text(static_cast<std::size_t>(key->GetBytes()), '\0');
    key->Read({ { 0, text.size() } }, reinterpret_cast<std::byte*>(text.data()));
    return text;
  }

  void FindRoot()
  {
    static std::mutex guard;
    static std::map<std::string, std::string> found; // what stores had, which are opened again
    std::vector<std::string> names{ "zarr.json", ".zmetadata", ".zgroup", ".zarray" };
    {
      const std::lock_guard<std::mutex> lock(guard);
      const auto known = found.find(this->Root);
      if (known != found.end())
      {
        std::stable_partition(names.begin(), names.end(),
          [&](const std::string& name) { return name == known->second; });
      }
    }
    std::string refusal;
    for (const std::string& name : names)
    {
      const std::string path = this->Root + "/" + name;
      std::optional<std::string> text;
      try
      {
        text = this->Fetch(path);
      }
      catch (const HttpClient::Refusal& error)
      {
        refusal = refusal.empty() ? error.what() : refusal;
      }
      if (text)
      {
        {
          const std::lock_guard<std::mutex> lock(guard);
          found[this->Root] = name;
        }
        this->RootKey = path;
        this->IsThird = path.back() == 'n';
        this->TakeConsolidated(name, *text);
        this->Texts[path] = std::move(text);
        return;
      }
    }
    if (!refusal.empty())
    {
      throw dsm::Error(refusal);
    }
    throw FileError(this->Root,
      "is not a Zarr store: the server answers 404 Not Found for 'zarr.json', '.zmetadata', "
      "'.zgroup' and '.zarray' in it. Only Zarr is read from servers: copy other files to this "
      "computer, or convert them to Zarr there.");
  }

  /// Takes the copies of other files that are in one. Where there are too many, they are fetched one by one.
  void TakeConsolidated(const std::string& name, const std::string& text)
  {
    const bool isApart = name == ".zmetadata";
    if (!isApart && !this->IsThird)
    {
      return;
    }
    nlohmann::json all;
    try
    {
      all = ZarrJson::Parse(text, "");
    }
    catch (const dsm::Error&)
    {
      return;
    }
    const nlohmann::json& inside = isApart ? all : ZarrJson::Find(all, "consolidated_metadata");
    const nlohmann::json& copies = ZarrJson::Find(inside, "metadata");
    if (!copies.is_object())
    {
      return;
    }
    this->IsConsolidated = true;
    for (const auto& [path, copy] : copies.items())
    {
      this->Texts[this->Root + "/" + path + (isApart ? "" : "/zarr.json")] =
        copy.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    }
  }

  std::shared_ptr<RemoteKeys> Keys;
  std::string Root;
  std::string Parent;  ///< the folder around it, or itself, where it has none, with '/'
  std::string RootKey; ///< whose change is a change of the store
  bool IsThird = false;
  bool IsConsolidated = false;
  mutable std::mutex Guard;
  mutable std::map<std::string, std::optional<std::string>> Texts; ///< by path
};

} // namespace

std::shared_ptr<ZarrStore> MakeZarrRemote(const std::string& url, const OpenOptions& options)
{
  return std::make_shared<ZarrRemote>(url, options);
}

} // namespace vol
