// SPDX-License-Identifier: BSD-3-Clause
// The bytes of a chunk, or a shard, of Zarr. The first byte chooses an array of zarr_arrays.json, whose metadata are as
// they should be; the others are its first chunk.
#include "InputFolder.h"
#include "VolumeCheck.h"

#include <nlohmann/json.hpp>

#include <fstream>
#include <string>
#include <vector>

namespace
{

struct Array
{
  std::filesystem::path Folder;
  std::filesystem::path Chunk;
};

std::vector<Array> MakeArrays()
{
  std::ifstream file(FUZZ_ZARR_ARRAYS);
  std::vector<Array> arrays;
  for (const nlohmann::json& one : nlohmann::json::parse(file))
  {
    const auto folder = fuzz::GetInputFolder() / (one.at("name").get<std::string>() + ".zarr");
    const auto chunk = folder / one.at("chunk").get<std::string>();
    std::filesystem::create_directories(chunk.parent_path());
    const bool isThird = one.at("metadata").at("zarr_format") == 3;
    const std::string metadata = one.at("metadata").dump();
    fuzz::WriteInput(folder / (isThird ? "zarr.json" : ".zarray"),
      reinterpret_cast<const std::uint8_t*>(metadata.data()), metadata.size());
    if (fuzz::CheckVolume(folder) == 0)
    {
      fuzz::Fail("this array is not as it should be: " + folder.string());
    }
    arrays.push_back({ folder, chunk });
  }
  return arrays;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count)
{
  static const std::vector<Array> arrays = MakeArrays();
  if (count > 0)
  {
    const Array& array = arrays[bytes[0] % arrays.size()];
    fuzz::WriteInput(array.Chunk, bytes + 1, count - 1);
    fuzz::CheckVolume(array.Folder);
  }
  return 0;
}
