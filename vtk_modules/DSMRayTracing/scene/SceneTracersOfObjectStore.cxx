// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/scene/SceneTracers-inl.h"
#include "DSMRayTracing/scene/StoreFieldReader.h"

#include "DSMCore/table/ObjectStore.h"

template rt::SceneTracers rt::CreateSceneTracers(
  dsm::ObjectStore&, dsm::ObjectStore::Worker&, const Scene&);
template std::unique_ptr<rt::FieldReader> rt::CreateFieldReader(
  dsm::ObjectStore&, dsm::ObjectStore::Worker&);
