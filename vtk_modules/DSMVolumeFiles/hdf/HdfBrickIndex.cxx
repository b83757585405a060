// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/hdf/HdfBrickIndex.h"

#include "DSMBricks/build/VoxelIndex.h"
#include "DSMVolumeFiles/base/FileLimits.h"

#include <algorithm>
#include <string>

namespace vol
{

namespace
{

/// Returns the bytes of the index of an array's bricks, which is contiguous in the file; 0 if it is
/// impossible.
std::uint64_t CountBytes(const FileArray& array, int edge, std::uint64_t fileBytes)
{
  if (edge < 1)
  {
    return 0;
  }
  std::uint64_t bricks = 1;
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::int64_t cells = std::max<std::int64_t>(1, array.Grid.Samples[axis] - 1);
    bricks =
      MultiplyWithin(fileBytes, { bricks, static_cast<std::uint64_t>((cells - 1) / edge + 1) })
        .value_or(0);
  }
  const std::uint64_t bytes = bricks::VoxelIndex::CountBytes(bricks);
  return bytes <= fileBytes ? bytes : 0;
}

} // namespace

HdfHandle OpenHdfBrickIndex(hid_t root, const FileArray& array)
{
  const std::string name =
    std::string("DSM/") + (array.OnCells ? "CellData/" : "PointData/") + array.Name;
  return { H5Gopen2(root, name.c_str(), H5P_DEFAULT), &H5Gclose };
}

VolumeFile::Index ReadHdfBrickIndex(hid_t root, const FileArray& array, std::uint64_t fileBytes)
{
  VolumeFile::Index index;
  const HdfHandle group = OpenHdfBrickIndex(root, array);
  const HdfHandle all(H5Gopen2(root, "DSM", H5P_DEFAULT), &H5Gclose);
  if (group.IsOpen() && all.IsOpen() &&
    ReadHdfAttribute(all.Get(), "BrickEdge", H5T_NATIVE_INT, &index.BrickEdge, 1))
  {
    ReadHdfWhole(group.Get(), "ValueRanges", H5T_NATIVE_DOUBLE,
      4 * (static_cast<std::uint64_t>(array.Components) + 1), index.Ranges);
    ReadHdfWhole(group.Get(), "BrickIndex", H5T_NATIVE_UCHAR,
      CountBytes(array, index.BrickEdge, fileBytes), index.Bricks);
  }
  return index;
}

} // namespace vol
