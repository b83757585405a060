// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_Fields_h
#define rt_Fields_h

#include "DSMRayTracing/field/FieldCheck.h"

#define RT_FIELD_HEADER(begin) <DSMRayTracing/field/begin##Field.h>
#include "DSMRayTracing/field/FieldList.h"
#undef RT_FIELD_HEADER

#include <variant>

namespace rt
{

/// Kinds of fields.
template <class... Kinds>
struct FieldKinds
{
  static_assert((FieldCheck<Kinds>::HasAll() && ...), "see above");

  using Any = std::variant<Kinds...>;
  /// Returns whether all have what finds something in them, for one store; else, it does not compile.
  template <class Store>
  static constexpr bool HaveSearches()
  {
    return (FieldCheck<Kinds>::template HasSearches<Store>() && ...);
  }
};

using AllFields = FieldKinds<RT_FIELD_CLASSES>;
/// A field of any kind.
using AnyField = AllFields::Any;

} // namespace rt

#endif
