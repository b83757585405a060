// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/hdf/HdfChunkIndex.h"

#include "DSMVolumeFiles/hdf/HdfIndexReader.h"

#include <algorithm>

namespace vol
{

bool HdfChunkIndex::Read(const PositionedFile& file, const HdfChunkLayout& layout,
  const std::vector<std::uint64_t>& most, const Visit& visit)
{
  using Index = HdfChunkLayout::Index;
  if (layout.Edges.size() != most.size() + 1 ||
    std::find(layout.Edges.begin(), layout.Edges.end(), 0u) != layout.Edges.end())
  {
    return false;
  }
  if (layout.Address == HdfUndefined)
  {
    return true; // no chunk has been written
  }
  HdfIndexReader reader(file, layout, most, visit);
  if (layout.Kind != Index::Tree1 && !layout.IsFiltered && reader.GetPlainBytes() == 0)
  {
    return false;
  }
  switch (layout.Kind)
  {
    case Index::Tree1:
      return reader.ReadTree1(layout.Address);
    case Index::Single:
      return reader.AddNumbered(0,
        { layout.Address,
          layout.IsFiltered
            ? static_cast<std::uint32_t>(std::min<std::uint64_t>(layout.SingleBytes, UINT32_MAX))
            : reader.GetPlainBytes(),
          layout.SingleSkippedFilters });
    case Index::Implicit:
      return reader.ReadImplicit(layout.Address);
    case Index::FixedArray:
      return reader.ReadFixedArray(layout.Address);
    case Index::ExtensibleArray:
      return reader.ReadExtensibleArray(layout.Address);
    case Index::Tree2:
      return reader.ReadTree2(layout.Address);
  }
  return false;
}

} // namespace vol
