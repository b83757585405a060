// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_TablePublisher_h
#define dsm_TablePublisher_h

#include "DSMCore/publish/Publication.h"
#include "DSMCore/table/BlockTable.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace dsm
{

/// Publishes a segment for the stores that have a BlockTable. Communication thread.
class TablePublisher
{
public:
  struct Plan
  {
    bool HostSharing = false;
    /// Null: found out.
    std::shared_ptr<const HostGroups> Groups = nullptr;
    bool Replicate = false;
    /// What this rank may still take.
    std::uint64_t MemoryBytes = UINT64_MAX;
    /// The store's own objections; may throw.
    std::function<void()> Check;
  };

  /// Collective; the same plan everywhere, but for its memory. Throws the same Error on every rank
  /// when any rank fails, too when the memory does not suffice: before any is taken.
  static std::shared_ptr<BlockTable> Run(Messenger& messenger, const std::string& what,
    const Plan& plan, BlockDirectory directory, FragmentSource& source, FragmentSink& sink,
    const std::function<void(double)>& progress);
};

} // namespace dsm

#endif
