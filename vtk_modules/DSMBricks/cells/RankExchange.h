// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_RankExchange_h
#define bricks_RankExchange_h

#include "DSMCore/base/FunctionRef.h"
#include "DSMCore/transport/Messenger.h"

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace bricks
{

/// Records of equal size that each rank has for each other.
struct RankExchange
{
  using Write =
    dsm::FunctionRef<void(int to, std::uint64_t first, std::size_t count, std::byte* records)>;
  using Read = dsm::FunctionRef<void(
    int from, std::uint64_t first, std::size_t count, const std::byte* records)>;

  std::size_t RecordBytes;
  /// Records for each rank, this one included.
  std::vector<std::uint64_t> Counts;
  /// Writes some of the records for a rank.
  Write WriteRecords;
  /// Receives some records of a rank. They arrive in order, but other ranks' may arrive in between. They need not be
  /// aligned.
  Read ReadRecords;

  /// Collective: moves all records in a bounded stream. Rethrows what any rank's functions throw as the same dsm::Error
  /// on every rank.
  void Run(std::string_view what, dsm::Messenger& messenger) const;
};

} // namespace bricks

#endif
