// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_FieldSearches_h
#define rt_FieldSearches_h

// What searches and samples the fields of AnyField: included where tracers are made for a store.
#include "DSMRayTracing/field/lattice/LatticeSearches.h"
#include "DSMRayTracing/field/levels/LevelSearches.h"

#endif
