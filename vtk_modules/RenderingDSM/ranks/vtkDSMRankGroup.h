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
  /// Who publishes blocks, or uses what others published: a scene. On every rank the same ones, which joined in the same order.
  class Publisher
  {
  public:
    virtual ~Publisher() = default;
    /// The blocks are to be kept in another way: lets go of all it uses, which is retired with its last
    /// user. It publishes again when it draws the next time.
    virtual void GiveUpBlocks() = 0;
    /// A time: of the last frame that showed the oldest of what it has blocks of but does not show;
    /// 0 without any. In the same order on every rank.
    virtual std::uint64_t GetOldestHidden() const = 0;
    /// Lets go of the blocks of that, likewise.
    virtual void GiveUpOldestHidden() = 0;
  };

  /// The group of a controller, made at the first call and kept until its last user lets go. Without
  /// MPI, or with one process, a group of one. Collective over the controller when the group does
  /// not exist yet. Throws dsm::Error.
  static std::shared_ptr<vtkDSMRankGroup> Get(vtkMultiProcessController* controller);

  explicit vtkDSMRankGroup(std::unique_ptr<dsm::Transport> transport);
  vtkDSMRankGroup(const vtkDSMRankGroup&) = delete;
  vtkDSMRankGroup& operator=(const vtkDSMRankGroup&) = delete;

  dsm::Messenger& GetMessenger() { return this->Messenger; }
  dsm::BlockStore& GetStore() { return this->Store; }
  rt::FrameRenderer& GetFrameRenderer() { return this->FrameRenderer; }
  /// What is in the store, for all who would publish the same.
  dsm::Publications& GetPublications() { return this->Publications; }

  /// Local, in the same order on every rank.
  void Join(Publisher* publisher);
  void Leave(Publisher* publisher);

  /// How the ranks keep their bricks, for all of their publishers.
  vtkDSMMemoryOptions* GetOptions() const { return this->Options; }
  /// The options as they are now have their effect with the next publication or frame. All publishers give up their
  /// blocks when these cannot pass to the new organization as they are. Between frames; local, in the same order on
  /// every rank. Throws dsm::Error.
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

  /// Collective, likewise, for `publish`, which is told where the blocks are to be: in a scratch directory,
  /// where the user has given one and nothing else makes room in memory.
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
  /// What chunks may take of so much memory.
  std::uint64_t GetMostForChunks(std::uint64_t memoryBytes) const;
  /// Of the cache of chunks, which keeps within that from now on; 0: the memory is what it has found.
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
