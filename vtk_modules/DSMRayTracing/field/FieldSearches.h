// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_FieldSearches_h
#define rt_FieldSearches_h

// Includes the searches and samplers of the fields of AnyField, for the files that make tracers for a store.
#include "DSMCore/table/ReplicatedStore.h"
#include "DSMRayTracing/field/Fields.h"

#define RT_FIELD_HEADER(begin) <DSMRayTracing/field/begin##Searches.h>
#include "DSMRayTracing/field/FieldList.h"
#undef RT_FIELD_HEADER

namespace rt
{

static_assert(AllFields::HaveSearches<dsm::ReplicatedStore>(), "one store stands for all");

} // namespace rt

#endif
