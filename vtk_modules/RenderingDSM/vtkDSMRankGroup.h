// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMRankGroup_h
#define vtkDSMRankGroup_h

#include "DSMCore/BlockStore.h"
#include "DSMCore/Messenger.h"
#include "DSMRayTracing/frame/FrameRenderer.h"

#include <memory>

class vtkMultiProcessController;

/// The ranks that pool their memory: one messenger, one store and one frame renderer for each
/// communicator of the process, shared by all scenes that use it, so that all views draw on one
/// cache. Communication thread only.
class vtkDSMRankGroup
{
public:
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

  /// `threads` 0 means the cores of the host divided by the ranks on it. Local.
  void Configure(std::size_t cacheBytes, int threads);

private:
  dsm::Messenger Messenger;
  dsm::BlockStore Store;
  rt::FrameRenderer FrameRenderer;
};

#endif
