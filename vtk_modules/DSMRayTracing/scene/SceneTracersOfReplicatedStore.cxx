// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/scene/SceneTracers-inl.h"
#include "DSMRayTracing/scene/StoreFieldReader.h"

#include "DSMCore/table/ReplicatedStore.h"

template rt::SceneTracers rt::CreateSceneTracers(
  dsm::ReplicatedStore&, dsm::ReplicatedStore::Worker&, const Scene&);
template std::unique_ptr<rt::FieldReader> rt::CreateFieldReader(
  dsm::ReplicatedStore&, dsm::ReplicatedStore::Worker&);
