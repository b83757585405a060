// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/scene/SceneTracers-inl.h"

#include "DSMCore/table/ReplicatedStore.h"

template rt::SceneTracers rt::CreateSceneTracers(
  dsm::ReplicatedStore&, dsm::ReplicatedStore::Worker&, const Scene&);
