// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_StoreInterface_h
#define dsm_StoreInterface_h

#include "DSMCore/base/Block.h"
#include "DSMCore/base/Counters.h"
#include "DSMCore/base/FunctionRef.h"
#include "DSMCore/publish/BlockDirectory.h"
#include "DSMCore/publish/BlockSegment.h"
#include "DSMCore/publish/Publication.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace dsm
{

/// Interface that every store implements, for templates over the store. The compiler checks it at
/// instantiation. It is not a base class, because a hit must cost no more than a load.
/// ObjectStore.h and FetchingStore.h document the members.
template <class Store>
class StoreInterface
{
  using Worker = typename Store::Worker;
  using Pin = typename Store::Pin;
  using Settings = typename Store::Settings;

  template <class Expected, class Actual>
  static constexpr bool Is = std::is_same_v<Expected, Actual>;

  static Store& Get();
  static const Store& GetConst();
  static Worker& GetWorker();
  static const BlockSegment& GetSegment();

  // Blocks, on a worker's thread.
  static_assert(Is<Pin, decltype(Get().Acquire(GetWorker(), GetSegment(), BlockId()))>);
  static_assert(Is<std::pair<Pin, Pin>,
    decltype(Get().AcquirePair(GetWorker(), GetSegment(), BlockId(), GetSegment(), BlockId()))>);
  static_assert(Is<const std::byte*, decltype(std::declval<const Pin&>().GetData())>);
  static_assert(Is<std::size_t, decltype(std::declval<const Pin&>().GetBytes())>);
  static_assert(std::is_move_constructible_v<Pin>, "it is returned");
  static_assert(Is<bool,
    decltype(Get().Prefetch(GetSegment(), std::declval<const BlockId*>(), std::size_t(),
      FunctionRef<void(BlockId, std::vector<BlockId>&)>()))>);
  static_assert(Is<void, decltype(Get().Enter(GetWorker()))>);
  static_assert(Is<void, decltype(Get().Quiesce(GetWorker()))>);
  static_assert(Is<void, decltype(Get().Leave(GetWorker()))>);
  static_assert(Is<std::uint64_t, decltype(GetConst().GetMisses(std::declval<const Worker&>()))>);

  // A frame, on the communication thread.
  static_assert(Is<bool, decltype(GetConst().MayBeginFrame())>);
  static_assert(Is<bool, decltype(GetConst().MayPrefetch())>);
  static_assert(Is<void, decltype(Get().BeginFrame(bool()))>);
  static_assert(Is<bool, decltype(Get().Service())>);
  static_assert(Is<void, decltype(Get().Cancel(std::string()))>);
  static_assert(Is<bool, decltype(Get().Drain())>);
  static_assert(Is<void, decltype(Get().EndFrame())>);
  static_assert(Is<Worker&, decltype(Get().GetWorker(int()))>);
  static_assert(alignof(Worker) >= 64, "workers write to it all the time");

  // Between frames, on the communication thread.
  static_assert(Is<void, decltype(Get().SetSettings(std::declval<const Settings&>()))>);
  static_assert(Is<const Settings&, decltype(GetConst().GetSettings())>);
  static_assert(Is<std::shared_ptr<BlockSegment>,
    decltype(Get().Publish(std::string(), std::declval<BlockDirectory>(),
      std::declval<FragmentSource&>(), std::declval<FragmentSink&>()))>);
  static_assert(
    Is<void, decltype(Get().Retire(std::declval<const std::shared_ptr<BlockSegment>&>()))>);
  static_assert(Is<void,
    decltype(Get().Refresh(
      std::string(), GetSegment(), std::declval<const std::vector<bool>&>()))>);
  static_assert(Is<StoreCounters, decltype(GetConst().GetCounters())>);
  static_assert(Is<std::uint64_t, decltype(GetConst().GetBytesFrom(int()))>);
  static_assert(Is<std::vector<WorkerCounters>, decltype(GetConst().GetWorkerCounters())>);
  static_assert(!std::is_copy_constructible_v<Store>, "it has the memory");
};

} // namespace dsm

#endif
