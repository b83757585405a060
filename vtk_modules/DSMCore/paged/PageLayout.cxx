// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/paged/PageLayout.h"

#include "DSMCore/base/Error.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <string>

namespace dsm
{

PageLayout::PageLayout(const BlockDirectory& directory, int owners, std::size_t pageBytes)
  : Directory(&directory)
  , PageBytes(pageBytes)
  , ShareBegins(static_cast<std::size_t>(owners) + 1, 0)
  , Offsets(directory.GetCount())
{
  const std::uint64_t count = directory.GetCount();
  const std::uint64_t largest = directory.GetLargest() + this->PageBytes;
  if (count > std::numeric_limits<std::uint64_t>::max() / largest)
  {
    throw Error(std::to_string(count) + " blocks of up to " +
      std::to_string(directory.GetLargest()) + " bytes exceed 64-bit addresses. Use smaller data.");
  }
  for (BlockId id = 0; id < count; ++id)
  {
    this->ShareBegins[directory.GetOwner(id) + 1] += this->GetFootprint(id);
  }
  std::partial_sum(this->ShareBegins.begin(), this->ShareBegins.end(), this->ShareBegins.begin());
  std::vector<std::uint64_t> next(this->ShareBegins);
  this->Order.reserve(count);
  for (BlockId id = 0; id < count; ++id)
  {
    std::uint64_t& offset = next[directory.GetOwner(id)];
    this->Offsets[id] = offset;
    offset += this->GetFootprint(id);
    if (this->GetFootprint(id) > 0)
    {
      this->Order.push_back(id);
    }
  }
  std::sort(this->Order.begin(), this->Order.end(),
    [this](BlockId a, BlockId b) { return this->Offsets[a] < this->Offsets[b]; });
}

bool PageLayout::Find(std::uint64_t offset, BlockId& id) const
{
  if (offset >= this->GetBytes())
  {
    return false;
  }
  const auto behind = std::upper_bound(this->Order.begin(), this->Order.end(), offset,
    [this](std::uint64_t place, BlockId block) { return place < this->Offsets[block]; });
  id = *(behind - 1);
  return true;
}

} // namespace dsm
