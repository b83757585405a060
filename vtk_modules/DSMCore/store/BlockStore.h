// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_BlockStore_h
#define dsm_BlockStore_h

#include "DSMCore/base/Counters.h"
#include "DSMCore/base/WorkerSlots.h"
#include "DSMCore/paged/PagedStore.h"
#include "DSMCore/publish/BlockDirectory.h"
#include "DSMCore/publish/BlockSegment.h"
#include "DSMCore/publish/HostGroups.h"
#include "DSMCore/publish/Publication.h"
#include "DSMCore/publish/SegmentList.h"
#include "DSMCore/store/MemoryOrganization.h"
#include "DSMCore/store/MemoryPlan.h"
#include "DSMCore/table/ObjectStore.h"
#include "DSMCore/table/ReplicatedStore.h"
#include "DSMCore/transport/Messenger.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace dsm
{

/// Keeps blocks in the organization and within the memory that the user has chosen. It is the one interface
/// to the three stores for all publishers. Readers of blocks use the store that has them, which Visit
/// provides: one switch in each frame, none on an access.
///
/// All that is published is in one organization at a time. It changes between frames, when settings
/// or data do: segments pass from the object based to the replicated store and back as they are.
/// Communication thread only.
class BlockStore
{
public:
  /// The same on every rank, but for the number of workers.
  struct Settings
  {
    MemoryOrganization Organization = MemoryOrganization::Automatic;
    /// Memory limit of a rank in bytes, for its own blocks, copies and cache. 0: half of the memory
    /// that the host has left at the first publication, divided among its ranks, and more if a
    /// rank's own blocks need it.
    std::uint64_t MemoryBytes = 0;
    /// The most that the cache may take of it, unless sources bring blocks: then it is the resident set, too.
    std::size_t CacheBytes = SIZE_MAX;
    /// Part of MemoryBytes that sources of blocks use for a cache of their own, for all such
    /// sources together, while there are any (BlockDirectory::SetReadThroughCache).
    std::uint64_t SourceCacheBytes = 0;
    /// Number of workers that trace at a time.
    int Workers = 1;
    /// As many times the threads, where blocks are fetched: while some wait, others trace. 1: a
    /// worker that waits idles.
    int Overlap = 4;
    /// Bricks that a tile will probably need are asked for before it gets to them.
    bool Prefetch = true;
    /// Ranks of one host read one another's blocks in place. For what is published from then on.
    bool HostSharing = true;
    /// A directory on the node's own disk for bricks that do not fit the memory; empty: none. For what is
    /// published from then on; on every rank, or on none.
    std::string ScratchDirectory;
    /// Page based only; see PagedStore.
    bool PureFaulting = false;
  };

  /// The messenger must outlive the store.
  BlockStore(Messenger& messenger, const Settings& settings);
  ~BlockStore();
  BlockStore(const BlockStore&) = delete;
  BlockStore& operator=(const BlockStore&) = delete;

  /// Between frames; local: another organization or budget has its effect with the next Settle or
  /// Publish. Throws Error for less than one worker, and when the page based organization is to be
  /// entered or left while anything is published: retire it, and publish it again.
  void SetSettings(const Settings& settings);
  const Settings& GetSettings() const { return this->Current; }

  /// Returns whether Settle has nothing to do on this rank. If any rank has something to do, all
  /// ranks must settle.
  bool IsSettled() const { return this->Settled; }
  /// Collective, between frames: chooses the organization again, if Automatic, and rearranges the published
  /// blocks. Throws the same Error on every rank when the memory does not suffice; then nothing has changed,
  /// and the next Settle tries again.
  void Settle();

  /// Storage of the blocks of a publication.
  enum class Place
  {
    Memory,
    Scratch ///< in a file in the scratch directory of the rank that owns them
  };

  /// Collective, between frames; see ObjectStore. Throws the same MemoryShortage on every rank, before
  /// any data move, when a rank's memory does not suffice: with the number of bytes needed and the number
  /// of ranks that would do. In Scratch, they leave memory, and are read again when they are needed;
  /// `sink` and `source` have the same to do.
  std::shared_ptr<BlockSegment> Publish(std::string_view what, BlockDirectory directory,
    FragmentSource& source, FragmentSink& sink, FunctionRef<void(double)> progress = {},
    Place place = Place::Memory);

  /// Collective. As above, but the blocks are brought by `source` when they are needed, and leave memory
  /// again; see ObjectStore. By the owner, once for all, or, where Replicated was chosen, by each rank
  /// that needs them: every rank's source must be able to bring any.
  std::shared_ptr<BlockSegment> Publish(
    std::string_view what, BlockDirectory directory, std::shared_ptr<BlockSource> source);

  /// Local, between frames: returns whether Update may be called. False for blocks that leave memory, and
  /// while Settle has something to do. All ranks must agree.
  bool MayUpdate(const std::shared_ptr<BlockSegment>& segment) const;
  /// Collective, between frames. Changes the blocks for which `chosen` is true (the same on every rank), from
  /// the fragments of `source`, which has none of other blocks. Other ranks keep their copies of blocks that
  /// turn out to be equal. Throws the same Error on every rank; then the segment must not be used any more,
  /// and must be retired.
  void Update(std::string_view what, const std::shared_ptr<BlockSegment>& segment,
    const std::vector<bool>& chosen, FragmentSource& source, FragmentSink& sink,
    FunctionRef<void(double)> progress = {});

  /// Local, between frames: the same of Refresh.
  bool MayRefresh(const std::shared_ptr<BlockSegment>& segment) const;
  /// Collective, between frames. The source of these blocks has other contents from now on, for the blocks
  /// for which `changed` is true (the same on every rank): the ranks drop them from memory. Throws as Update
  /// does.
  void Refresh(std::string_view what, const std::shared_ptr<BlockSegment>& segment,
    const std::vector<bool>& changed);

  /// Local: how many of Publish, Update and Refresh there were.
  std::uint64_t CountPublications() const { return this->Publications; }

  /// Collective in order (no message is exchanged), between frames.
  void Retire(const std::shared_ptr<BlockSegment>& segment);

  /// The organization in force: never Automatic. Replicated, too, where each rank has the bricks that it
  /// needs read for itself.
  MemoryOrganization GetOrganization() const
  {
    return this->ReadByAll ? MemoryOrganization::Replicated : this->InForce;
  }
  /// MemoryPlan::LacksMemory of what is in force.
  bool LacksMemory() const { return this->IsShort; }
  /// A sentence for the user: what is in force, and why.
  const std::string& GetExplanation() const { return this->Explanation; }
  /// Returns the memory limit of this rank in bytes; 0 before the first publication.
  std::uint64_t GetMemoryBytes() const { return this->Budget.Bytes; }

  /// Calls `use` with the ObjectStore, PagedStore or ReplicatedStore that has all segments.
  template <class Use>
  decltype(auto) Visit(Use&& use)
  {
    switch (this->InForce)
    {
      case MemoryOrganization::Replicated:
        return use(this->Replicated);
      case MemoryOrganization::PageBased:
        return use(*this->Paged);
      default:
        return use(this->Objects);
    }
  }

  /// Slots for the workers that trace at the same time. A worker takes one while it traces.
  WorkerSlots& GetSlots() { return *this->Slots; }

  /// See ObjectStore; of the store in force.
  StoreCounters GetCounters();
  std::uint64_t GetBytesFrom(int owner);
  /// Settings::Workers of them: the workers beyond are added to those that they take turns with.
  std::vector<WorkerCounters> GetWorkerCounters();

private:
  /// Data that the ranks exchange before they decide.
  struct Stance
  {
    MemoryPlan::Budget Budget;
    std::uint64_t Choice;          ///< digest of what must be equal on all ranks
    std::uint64_t LacksHostMemory; ///< 1: what comes next is more than the host has left
  };

  /// Organization that all ranks have agreed on, and its explanation for the user.
  struct Decision
  {
    MemoryOrganization Chosen = MemoryOrganization::ObjectBased;
    MemoryPlan::Room Room; ///< room on this rank
    std::string Explanation;
    bool IsShort = false; ///< true if memory is short
  };

  /// Collective: decides for what is published and, unless null, for what is to be, which may then be added without
  /// fail. `fallback`: the decision if the copies that Automatic wants fail. Throws the same Error, which begins
  /// with `what`, on every rank, of kind MemoryShortage if memory does not suffice.
  Decision Decide(std::string_view what, const BlockDirectory* next, Decision& fallback);
  /// Called before any rank takes memory, and only if blocks can be kept elsewhere.
  bool LacksHostMemory(const BlockDirectory* next) const;
  std::shared_ptr<BlockSegment> PublishToScratch(std::string_view what, BlockDirectory&& directory,
    FragmentSource& source, FragmentSink& sink, FunctionRef<void(double)> progress);
  MemoryPlan MakePlan(const std::vector<Stance>& stances, const BlockDirectory* next) const;
  void FindBudget();
  /// Returns the number of workers of the stores that fetch.
  int CountWorkers() const;
  bool IsAnyFromSource() const;
  /// Collective: moves segments between the stores, or makes up its mind otherwise where it may.
  /// Throws when they cannot be replicated as they should.
  void MoveTo(Decision& decision, Decision&& fallback);
  void Replicate();
  /// Local: no segment has copies from now on.
  void GiveUpCopies();
  /// Local: hands the settings to the stores.
  void Configure();
  void PutInForce(Decision&& decision);

  Messenger& Messages;
  Settings Current;
  const std::shared_ptr<WorkerSlots> Slots = std::make_shared<WorkerSlots>();
  bool Settled = true;
  std::uint64_t Publications = 0;
  std::uint64_t BytesPublished = 0;
  MemoryOrganization InForce = MemoryOrganization::ObjectBased;
  bool ReadByAll = false;
  std::string Explanation;
  bool IsShort = false;
  MemoryPlan::Budget Budget;
  std::uint64_t AvailableBytes = 0; ///< to this rank, when first asked
  MemoryPlan::Room Room;
  /// As of the last plan.
  std::shared_ptr<const HostGroups> Groups;
  SegmentList<BlockSegment> Segments;

  ObjectStore Objects;
  ReplicatedStore Replicated;
  std::unique_ptr<PagedStore> Paged; ///< made when it is first chosen
};

} // namespace dsm

#endif
