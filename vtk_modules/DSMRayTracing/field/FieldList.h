// SPDX-License-Identifier: BSD-3-Clause

// The one list of the kinds of fields: a line with the begin of its headers, and its class. It is included twice, by
// Fields.h and FieldSearches.h, which define RT_FIELD_HEADER: so it has no include guard. Spaces around / would get
// into the names.
// clang-format off
#include RT_FIELD_HEADER(lattice/Lattice)
#include RT_FIELD_HEADER(levels/Level)
#include RT_FIELD_HEADER(tetrahedra/Cell)
// clang-format on

#ifndef RT_FIELD_CLASSES
#define RT_FIELD_CLASSES LatticeField, LevelField, CellField
#endif
