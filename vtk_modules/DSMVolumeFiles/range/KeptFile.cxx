// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/range/KeptFile.h"

#include "DSMRayTracing/base/ByteHash.h"

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <unistd.h>

namespace vol
{

KeptFile::KeptFile(
  const VolumeFile& file, std::size_t array, int step, const rt::Box& box, const std::string& kind)
{
  const char* const caches = std::getenv("XDG_CACHE_HOME");
  const char* const home = std::getenv("HOME");
  if (!(caches && *caches) && !(home && *home))
  {
    return;
  }
  const std::filesystem::path folder =
    caches && *caches ? std::filesystem::path(caches) : std::filesystem::path(home) / ".cache";
  std::error_code failure;
  const VolumeFile::StepOrigin origin = file.GetOrigin(step);
  const std::string path = std::filesystem::absolute(origin.Path, failure).string();
  const std::string& name = file.GetArrays()[array].Name;
  const std::int64_t numbers[] = { static_cast<std::int64_t>(origin.Stamp),
    static_cast<std::int64_t>(array), origin.Step, box.Min.x, box.Min.y, box.Min.z, box.Max.x,
    box.Max.y, box.Max.z };
  rt::ByteHash hash;
  hash.Add(path.data(), path.size());
  hash.Add(name.data(), name.size());
  hash.Add(kind.data(), kind.size());
  hash.Add(numbers, sizeof(numbers));
  this->Path = folder / "dsm-ray-tracer" / (kind + "-" + std::to_string(hash.Get()));
}

std::vector<std::byte> KeptFile::Load() const
{
  std::ifstream kept(this->Path, std::ios::binary | std::ios::ate);
  const std::streamoff bytes = kept ? std::streamoff(kept.tellg()) : 0;
  std::vector<std::byte> content(static_cast<std::size_t>(bytes > 0 ? bytes : 0));
  kept.seekg(0);
  kept.read(reinterpret_cast<char*>(content.data()), static_cast<std::streamsize>(content.size()));
  return kept ? content : std::vector<std::byte>();
}

void KeptFile::Keep(const std::byte* bytes, std::size_t count) const
{
  if (this->Path.empty())
  {
    return;
  }
  std::error_code failure;
  const std::filesystem::path path(this->Path);
  std::filesystem::create_directories(path.parent_path(), failure);
  // Other processes may read it meanwhile.
  std::filesystem::path written = path;
  written += "." + std::to_string(getpid());
  {
    std::ofstream kept(written, std::ios::binary);
    kept.write(reinterpret_cast<const char*>(bytes), static_cast<std::streamsize>(count));
    if (!kept.flush())
    {
      kept.close();
      std::filesystem::remove(written, failure);
      return;
    }
  }
  std::filesystem::rename(written, path, failure);
}

} // namespace vol
