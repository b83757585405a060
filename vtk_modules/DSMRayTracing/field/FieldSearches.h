// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_FieldSearches_h
#define rt_FieldSearches_h

// Includes the searches and samplers of the fields of AnyField, for the files that make tracers for a store.
#include "DSMRayTracing/field/lattice/LatticeSearches.h"
#include "DSMRayTracing/field/levels/LevelSearches.h"

#endif
