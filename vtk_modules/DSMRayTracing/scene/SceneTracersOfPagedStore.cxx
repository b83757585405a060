// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/scene/SceneTracers-inl.h"
#include "DSMRayTracing/scene/StoreFieldReader.h"

#include "DSMCore/paged/PagedStore.h"

template rt::SceneTracers rt::CreateSceneTracers(
  dsm::PagedStore&, dsm::PagedStore::Worker&, const Scene&);
template std::unique_ptr<rt::FieldReader> rt::CreateFieldReader(
  dsm::PagedStore&, dsm::PagedStore::Worker&);
