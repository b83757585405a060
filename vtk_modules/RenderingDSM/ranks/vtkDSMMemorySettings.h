// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMMemorySettings_h
#define vtkDSMMemorySettings_h

#include "DSMCore/store/MemoryOrganization.h"
#include "DSMRayTracing/schedule/TileScheduler.h"

#include <algorithm>
#include <cstdint>
#include <string>

/// How the ranks keep their bricks, as one object of a scene, a scene, or all scenes together ask for
/// it. All that is shown shares one memory, so what differs is merged, by the present values alone:
/// neither the order of the user's changes nor a saved session's order of loading makes a difference.
struct vtkDSMMemorySettings
{
  /// Of several that are not Automatic, the first counts.
  dsm::MemoryOrganization Organization = dsm::MemoryOrganization::Automatic;
  /// Off when anyone wants it off.
  bool HostSharing = true;
  /// Of each rank, for its own bricks, copies and cache; 0: automatic. The largest counts.
  std::uint64_t MemoryBytes = 0;
  /// The most that the cache may take of it. The largest counts.
  std::uint64_t CacheBytes = std::uint64_t(1) << 20;
  /// For bricks that do not fit the memory; empty: none. The first that is given counts.
  std::string ScratchDirectory;
  /// Whether coarser data stand in while the camera moves. On when anyone wants it.
  bool CoarserWhileMoving = false;
  /// Tracing threads of each rank; 0: the cores of the host divided by its ranks. The largest counts.
  int Threads = 0;
  /// The central queue when anyone wants it.
  rt::TileScheduling Scheduling = rt::TileScheduling::WorkStealing;
  /// Seconds that a rank may be silent; infinity: no limit. The largest counts.
  double SilenceLimit = 0.0;

  void Merge(const vtkDSMMemorySettings& other)
  {
    if (this->Organization == dsm::MemoryOrganization::Automatic)
    {
      this->Organization = other.Organization;
    }
    this->HostSharing = this->HostSharing && other.HostSharing;
    this->MemoryBytes = std::max(this->MemoryBytes, other.MemoryBytes);
    this->CacheBytes = std::max(this->CacheBytes, other.CacheBytes);
    if (this->ScratchDirectory.empty())
    {
      this->ScratchDirectory = other.ScratchDirectory;
    }
    this->CoarserWhileMoving = this->CoarserWhileMoving || other.CoarserWhileMoving;
    this->Threads = std::max(this->Threads, other.Threads);
    if (other.Scheduling == rt::TileScheduling::CentralQueue)
    {
      this->Scheduling = other.Scheduling;
    }
    this->SilenceLimit = std::max(this->SilenceLimit, other.SilenceLimit);
  }
};

#endif
