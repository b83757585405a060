// SPDX-License-Identifier: BSD-3-Clause
#ifndef fuzz_KeptVolume_h
#define fuzz_KeptVolume_h

#include "InputFolder.h"

#include "DSMBricks/build/VoxelIndex.h"
#include "DSMVolumeFiles/open/OpenVolumeFile.h"

#include <algorithm>
#include <string>

namespace fuzz
{

/// A small volume that something is kept of in the cache folder, and the lattice of its bricks.
class KeptVolume
{
public:
  KeptVolume()
  {
    const std::string header =
      "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 9 9 5\nencoding: raw\n\n";
    std::string text = header;
    for (int sample = 0; sample < 9 * 9 * 5; ++sample)
    {
      text += static_cast<char>(sample % 101);
    }
    const std::filesystem::path path = GetInputFolder() / "kept.nrrd";
    WriteInput(path, reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
    this->File = vol::OpenVolumeFile(path.string());
    const vol::FileArray& array = this->File->GetArrays().front();
    this->Lattice = bricks::BrickLattice(array.Grid.Samples, array.Type, false, 4);
    this->Whole = { bricks::Index3(0), array.Grid.Samples };
  }

  std::shared_ptr<const vol::VolumeFile> File;
  bricks::BrickLattice Lattice;
  bricks::Box Whole;

  /// As it is kept, with bytes of its own for all that a file could say, from the first one on; behind these, zeros.
  bricks::VoxelIndex MakeIndex(const std::uint8_t* bytes, std::size_t count) const
  {
    bricks::VoxelIndex index;
    index.Bricks.resize(this->Lattice.GetBrickCount());
    index.Digests.resize(this->Lattice.GetBrickCount());
    const auto take = [&](void* to, std::size_t size)
    {
      const std::size_t some = std::min(size, count);
      std::copy_n(bytes, some, static_cast<std::uint8_t*>(to));
      bytes += some;
      count -= some;
    };
    take(&index.Survey, sizeof(index.Survey));
    take(index.Bricks.data(), index.Bricks.size() * sizeof(bricks::ValueRange));
    return index;
  }
};

} // namespace fuzz

#endif
