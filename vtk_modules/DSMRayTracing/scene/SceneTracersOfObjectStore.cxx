// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/scene/SceneTracers-inl.h"

#include "DSMCore/table/ObjectStore.h"

template rt::SceneTracers rt::CreateSceneTracers(
  dsm::ObjectStore&, dsm::ObjectStore::Worker&, const Scene&);
