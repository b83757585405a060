// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_ReducedOrigin_h
#define vol_ReducedOrigin_h

#include "DSMVolumeFiles/cache/ChunkCache.h"
#include "DSMVolumeFiles/write/ValueOrigin.h"

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace vol
{

/// The first step of a file at half of its samples along each axis that has at least three points. A point's value
/// is the mean of the file's 2 x 2 x 2 points around it, so it lies half a sample further than the first of them:
/// linear functions stay as they are, and thin things fade instead of breaking up. A last point without a partner
/// stands alone, so that nothing of the volume is cut off. Numbers count, not NaN; integers are rounded. A cell's
/// value is that of the file's cell at its center: what cells have are often names, not amounts.
class ReducedOrigin final : public ValueOrigin
{
public:
  /// Every rank reads by itself. `source`: of which values the file's are; `cacheBytes` for chunks of the file.
  ReducedOrigin(
    std::shared_ptr<const VolumeFile> file, std::string source, int ranks, std::size_t cacheBytes);

  /// Returns whether any axis is long enough to be halved.
  static bool CanReduce(const FileGeometry& geometry);

  const FileGeometry& GetGeometry() const override { return this->Geometry; }
  const std::vector<FileArray>& GetArrays() const override { return this->Arrays; }
  std::string Describe() const override { return this->Source; }
  /// Each rank gets such as lie beside one another.
  std::vector<int> Deal(std::size_t array, const std::vector<bricks::Box>& boxes) override;
  void Read(std::size_t array, const bricks::Box& box, std::byte* out) const override;

private:
  bricks::Box GetFineBox(std::size_t array, const bricks::Box& box) const;

  std::shared_ptr<const VolumeFile> File;
  std::string Source;
  int Ranks;
  bricks::Index3 Factors; ///< along each axis, 2 or 1
  FileGeometry Geometry;
  std::vector<FileArray> Arrays;
  mutable ChunkCache Cache;
};

} // namespace vol

#endif
