// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/open/NamedVectors.h"

#include "DSMCore/base/FunctionRef.h"
#include "DSMVolumeFiles/base/ByteBuffer.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

namespace vol
{

namespace
{

using Parts = std::array<std::size_t, 3>; ///< numbers of the arrays x, y and z

/// Returns the vectors of a file: their names, and the arrays that they consist of.
std::vector<std::pair<std::string, Parts>> FindVectors(const std::vector<FileArray>& arrays)
{
  std::vector<std::pair<std::string, Parts>> found;
  const auto findPlace = [&](const std::string& name)
  {
    return std::find_if(
      arrays.begin(), arrays.end(), [&](const FileArray& one) { return one.Name == name; });
  };
  for (const FileArray& x : arrays)
  {
    const std::size_t end = x.Name.size() - std::min<std::size_t>(2, x.Name.size());
    const std::string name = x.Name.substr(0, end);
    Parts parts{};
    bool isVector = end > 0 && x.Name.compare(end, 2, "/x") == 0 && findPlace(name) == arrays.end();
    for (std::size_t part = 0; part < parts.size() && isVector; ++part)
    {
      const auto one = findPlace(name + "/" + "xyz"[part]);
      isVector = one != arrays.end() && one->Components == 1 && one->OnCells == x.OnCells &&
        one->Type == x.Type && one->Valid == x.Valid && one->Grid.Samples == x.Grid.Samples &&
        one->Grid.ChunkSamples == x.Grid.ChunkSamples;
      parts[part] = static_cast<std::size_t>(one - arrays.begin());
    }
    if (isVector)
    {
      found.emplace_back(name, parts);
    }
  }
  return found;
}

class VectorFile final : public VolumeFile
{
public:
  VectorFile(std::shared_ptr<const VolumeFile> file,
    const std::vector<std::pair<std::string, Parts>>& vectors)
    : VolumeFile(file->GetPath())
    , File(std::move(file))
  {
    this->Geometry = this->File->GetGeometry();
    this->Coordinates = this->File->GetCoordinates();
    this->Arrays = this->File->GetArrays();
    this->Steps = this->File->GetSteps();
    for (int step = 0; step < this->Steps; ++step)
    {
      this->Times.push_back(this->File->GetTime(step));
    }
    this->Levels = this->File->GetLevels();
    this->Warnings = this->File->GetWarnings();
    this->Stamp = this->File->GetStamp();
    for (const auto& [name, parts] : vectors)
    {
      FileArray vector = this->Arrays[parts.front()];
      vector.Name = name;
      vector.Components = static_cast<int>(parts.size());
      vector.IsActive = false;
      vector.IsOffered = true;
      CheckSizes(this->Path, vector);
      this->Vectors.push_back(parts);
      this->Arrays.push_back(std::move(vector));
    }
  }

  std::vector<std::string> GetPaths() const override { return this->File->GetPaths(); }
  std::vector<std::string> GetFiles(int step) const override { return this->File->GetFiles(step); }
  StepOrigin GetOrigin(int step) const override { return this->File->GetOrigin(step); }
  std::uint64_t GetTableBytes() const override { return this->File->GetTableBytes(); }

  void ReadChunk(
    std::size_t array, int step, const bricks::Index3& chunk, std::byte* out) const override
  {
    this->Read(array, this->Arrays[array].Grid.GetBox(chunk), out,
      [&](std::size_t part, std::byte* to)
      {
        this->File->ReadChunk(part, step, chunk, to);
        return true;
      });
  }
  bool ReadPart(std::size_t array, int step, const bricks::Index3& chunk, const bricks::Box& box,
    std::byte* out) const override
  {
    return this->Read(array, box, out,
      [&](std::size_t part, std::byte* to)
      { return this->File->ReadPart(part, step, chunk, box, to); });
  }
  bool ReadWithHalo(
    std::size_t array, int step, const bricks::Index3& chunk, std::byte* out) const override
  {
    return this->Read(array, this->Arrays[array].Grid.GetBoxWithHalo(chunk), out,
      [&](std::size_t part, std::byte* to)
      { return this->File->ReadWithHalo(part, step, chunk, to); });
  }

  bool IsFill(std::size_t array, int step, const bricks::Box& box) const override
  {
    const std::vector<std::size_t> parts = this->GetParts(array);
    return std::all_of(parts.begin(), parts.end(),
      [&](std::size_t part) { return this->File->IsFill(part, step, box); });
  }
  void Prefetch(std::size_t array, int step, const std::vector<ChunkPart>& wanted) const override
  {
    for (const std::size_t part : this->GetParts(array))
    {
      this->File->Prefetch(part, step, wanted);
    }
  }
  Index ReadIndex(std::size_t array, int step) const override
  {
    return this->IsVector(array) ? Index() : this->File->ReadIndex(array, step);
  }

private:
  bool IsVector(std::size_t array) const { return array >= this->File->GetArrays().size(); }
  std::vector<std::size_t> GetParts(std::size_t array) const
  {
    if (!this->IsVector(array))
    {
      return { array };
    }
    const Parts& parts = this->Vectors[array - this->File->GetArrays().size()];
    return { parts.begin(), parts.end() };
  }

  /// `read(part, to)` reads the samples of a box of an array of the file. Returns false where it
  /// does.
  bool Read(std::size_t array, const bricks::Box& box, std::byte* out,
    const dsm::FunctionRef<bool(std::size_t part, std::byte* to)>& read) const
  {
    if (!this->IsVector(array))
    {
      return read(array, out);
    }
    const auto count = static_cast<std::size_t>(box.GetCount());
    const std::size_t bytes = bricks::GetBytes(this->Arrays[array].Type);
    const std::vector<std::size_t> parts = this->GetParts(array);
    ByteBuffer samples(count * bytes);
    for (std::size_t part = 0; part < parts.size(); ++part)
    {
      if (!read(parts[part], samples.data()))
      {
        return false;
      }
      for (std::size_t sample = 0; sample < count; ++sample)
      {
        std::memcpy(
          out + (sample * parts.size() + part) * bytes, samples.data() + sample * bytes, bytes);
      }
    }
    return true;
  }

  std::shared_ptr<const VolumeFile> File;
  std::vector<Parts> Vectors;
};

} // namespace

std::shared_ptr<VolumeFile> OfferVectors(std::shared_ptr<VolumeFile> file)
{
  const auto vectors = FindVectors(file->GetArrays());
  return vectors.empty() ? std::move(file) : std::make_shared<VectorFile>(std::move(file), vectors);
}

} // namespace vol
