// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMRankGroup_h
#define vtkDSMRankGroup_h

#include "DSMCore/publish/Publications.h"
#include "DSMCore/store/BlockStore.h"
#include "DSMCore/transport/Messenger.h"
#include "DSMRayTracing/frame/FrameRenderer.h"
#include "vtkDSMMemoryOptions.h"

#include "vtkNew.h"

#include <cstdint>
#include <memory>
#include <vector>

class vtkMultiProcessController;

/// The ranks that pool their memory: one messenger, one store and one frame renderer for each
/// communicator of the process, shared by all scenes that use it, so that all views draw on one
/// cache. Communication thread only.
class vtkDSMRankGroup
{
public:
  /// A scene, which publishes blocks or uses blocks of other scenes. Every rank has the same
  /// publishers, which joined in the same order.
  class Publisher
  {
  public:
    virtual ~Publisher() = default;
    /// Releases all blocks that the publisher uses, because their organization changes; the last user retires
    /// them. The publisher publishes again at its next render.
    virtual void GiveUpBlocks() = 0;
    /// A time: of the last frame that showed the oldest of what it has blocks of but does not show;
    /// 0 without any. In the same order on every rank.
    virtual std::uint64_t GetOldestHidden() const = 0;
    /// Lets go of the blocks of that, likewise.
    virtual void GiveUpOldestHidden() = 0;
  };

  /// Returns the group of a controller. The first call creates it, and it exists until its last user releases
  /// it. Without MPI, or with one process, it is a group of one. Collective over the controller if the group
  /// does not exist yet. Throws dsm::Error.
  static std::shared_ptr<vtkDSMRankGroup> Get(vtkMultiProcessController* controller);

  explicit vtkDSMRankGroup(std::unique_ptr<dsm::Transport> transport);
  vtkDSMRankGroup(const vtkDSMRankGroup&) = delete;
  vtkDSMRankGroup& operator=(const vtkDSMRankGroup&) = delete;

  dsm::Messenger& GetMessenger() { return this->Messenger; }
  dsm::BlockStore& GetStore() { return this->Store; }
  rt::FrameRenderer& GetFrameRenderer() { return this->FrameRenderer; }
  /// Returns the publications in the store, for all publishers of the same data.
  dsm::Publications& GetPublications() { return this->Publications; }

  /// Local, in the same order on every rank.
  void Join(Publisher* publisher);
  void Leave(Publisher* publisher);

  /// How the ranks keep their bricks, for all of their publishers.
  vtkDSMMemoryOptions* GetOptions() const { return this->Options; }
  /// Applies the current options to the next publication or frame. All publishers give up their blocks if
  /// these cannot pass to the new organization unchanged. Between frames; local, in the same order on every
  /// rank. Throws dsm::Error.
  void Configure();

  /// Collective. Calls `work`, which throws dsm::Error on all ranks where memory is short, and again for
  /// as long as anything hidden can make room: what was shown the longest ago goes first. Not for
  /// frames, which fail for other reasons, and may have waited long for a rank that is gone.
  template <class Work>
  auto WithRoom(const Work& work)
  {
    for (;;)
    {
      try
      {
        return work();
      }
      catch (const dsm::Error&)
      {
        if (!this->MakeRoom())
        {
          throw;
        }
      }
    }
  }

  /// Collective, likewise, for `publish`, which receives the place of the blocks: a scratch directory, if the
  /// user has set one and nothing else makes room in memory.
  template <class Publish>
  auto PublishWithRoom(const Publish& publish)
  {
    using Place = dsm::BlockStore::Place;
    try
    {
      return this->WithRoom([&] { return publish(Place::Memory); });
    }
    catch (const dsm::MemoryShortage&)
    {
      if (this->Store.GetSettings().ScratchDirectory.empty())
      {
        throw;
      }
    }
    try
    {
      return publish(Place::Scratch);
    }
    catch (const dsm::Error&)
    {
      ++this->ScratchFailures;
      throw;
    }
  }

  /// Collective, before what is read through the cache of chunks is published: from now on it holds so many bytes
  /// together, where an eighth of the memory that any rank may take is as much; and `least`, where half of it is.
  /// Returns what it holds.
  std::uint64_t WidenRoomForChunks(std::uint64_t bytes, std::uint64_t least);

  /// Collective: the store keeps what is published as it is asked to. False when all publishers had to give
  /// up their blocks, since a part of them has to go to the scratch directory. Throws dsm::Error.
  bool Settle();

  /// Local, after a frame: freed memory goes back to the system when much was read from files since, whose chunks and
  /// bricks come and go.
  void ReturnMemoryOfFiles();

  /// Grows when memory is to be kept otherwise: what was refused may succeed now.
  unsigned GetSettingsVersion() const { return this->SettingsVersion; }
  /// Grows then, too, and whenever a scratch directory was of no use: there may be room in it the next time.
  unsigned GetRetryVersion() const { return this->SettingsVersion + this->ScratchFailures; }

  /// Reports on rank 0 what Automatic has chosen, again when that changes: in the output window where memory is
  /// short, else in the log.
  void TellOrganization();

private:
  bool MakeRoom();
  /// Returns the largest part of so much memory that chunks may take.
  std::uint64_t GetMostForChunks(std::uint64_t memoryBytes) const;
  /// Limits the cache of chunks to its part of the memory, and returns the limit in bytes; 0: the
  /// memory is the amount found by the store.
  std::uint64_t RestrictRoomForChunks(std::uint64_t memoryBytes) const;

  std::uint64_t LeastForChunks = 0; ///< see WidenRoomForChunks

  vtkNew<vtkDSMMemoryOptions> Options;
  std::vector<Publisher*> Publishers; ///< in the order in which they joined
  unsigned SettingsVersion = 0;
  unsigned ScratchFailures = 0;
  std::uint64_t BytesOfFiles = 0; ///< read by this process when memory was returned last
  dsm::Messenger Messenger;
  dsm::BlockStore Store;
  rt::FrameRenderer FrameRenderer;
  dsm::Publications Publications;
};

#endif
