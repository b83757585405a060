// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/publish/BlockDirectory.h"

#include "DSMCore/base/ByteDigest.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace dsm
{

BlockDirectory::BlockDirectory(
  std::vector<std::uint32_t> bytes, BlockAssigner assigner, std::uint64_t indexBytes)
  : Bytes(std::move(bytes))
  , Largest(this->Bytes.empty() ? 0 : *std::max_element(this->Bytes.begin(), this->Bytes.end()))
  , Assigner(std::move(assigner))
  , IndexBytes(indexBytes)
{
}

std::uint64_t BlockDirectory::GetResidentBytes(int owner, std::size_t unit) const
{
  std::uint64_t sum = 0;
  for (BlockId id = 0; id < this->GetCount(); ++id)
  {
    if (this->GetOwner(id) == owner && !this->FromSource)
    {
      sum += (this->Bytes[id] + unit - 1) / unit * unit;
    }
  }
  return sum;
}

std::uint64_t BlockDirectory::GetTotalBytes() const
{
  return std::accumulate(this->Bytes.begin(), this->Bytes.end(), std::uint64_t(0));
}

std::uint64_t BlockDirectory::GetFingerprint() const
{
  std::uint64_t hash = 0;
  for (BlockId id = 0; id < this->GetCount(); ++id)
  {
    const std::uint64_t block[] = { this->GetBytes(id),
      static_cast<std::uint64_t>(this->GetOwner(id)) };
    hash = HashBytes(block, sizeof(block), hash);
  }
  return hash;
}

} // namespace dsm
