// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/scene/SceneTracers-inl.h"

#include "DSMCore/paged/PagedStore.h"

template rt::SceneTracers rt::CreateSceneTracers(
  dsm::PagedStore&, dsm::PagedStore::Worker&, const Scene&);
