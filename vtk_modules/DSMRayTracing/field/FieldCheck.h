// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_FieldCheck_h
#define rt_FieldCheck_h

#include "DSMBricks/base/Box.h"
#include "DSMCore/publish/BlockSegment.h"
#include "DSMRayTracing/field/Field.h"
#include "DSMRayTracing/object/ObjectDigest.h"
#include "DSMRayTracing/object/ObjectTracer.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <type_traits>

namespace rt
{

/// Checks at compile time that a class has what Field.h asks of a kind of field. Each member that is missing gives one
/// error, which names it.
template <class FieldType, class = void>
struct FieldCheck
{
  static_assert(
    !sizeof(FieldType), "A kind of field must have types Values and Place; see Field.h");
  static constexpr bool HasAll() { return true; }
  template <class Store>
  static constexpr bool HasSearches()
  {
    return true;
  }
};

template <class FieldType>
struct FieldCheck<FieldType, std::void_t<typename FieldType::Values, typename FieldType::Place>>
{
private:
  /// Arguments of members.
  struct Use
  {
    const FieldType& Field;
    const typename FieldType::Values& Values;
    typename FieldType::Place& Place;
    const glm::dvec3& Vector;
    ObjectDigest& Digest;
  };
  template <class Result, class Call>
  static constexpr bool Returns(const Call&)
  {
    return std::is_invocable_r_v<Result, const Call&, const Use&>;
  }
  static constexpr bool IsWalked = std::is_base_of_v<WalkedField<FieldType>, FieldType>;

public:
// The call must compile, and return what converts to `Result`.
#define RT_FIELD_HAS(Result, call)                                                                 \
  static_assert(Returns<Result>([](const auto& use) -> decltype(use.call) { return use.call; }),   \
    "A kind of field must have " #call "; see Field.h")

  /// Checks all but its searches.
  static constexpr bool HasAll()
  {
    static_assert(std::is_trivially_copyable_v<typename FieldType::Place>,
      "A field's Place must be plain data");
    RT_FIELD_HAS(const typename FieldType::Values&, Field.GetValues());
    RT_FIELD_HAS(const dsm::BlockSegment*, Field.GetSegment(use.Values));
    RT_FIELD_HAS(ObjectTracer::Brick, Field.FindBrick(use.Place));
    RT_FIELD_HAS(ObjectTracer::Brick, Field.FindBrick(use.Vector));
    RT_FIELD_HAS(bricks::Index3, Field.GetBlockCell(use.Place));
    RT_FIELD_HAS(glm::dvec3, Field.GetNormal(use.Vector, use.Vector));
    RT_FIELD_HAS(double, Field.GetFinestLength());
    RT_FIELD_HAS(double, Field.GetFinestLength(glm::dmat3(1.0)));
    RT_FIELD_HAS(double, Field.GetGrowth(use.Vector));
    RT_FIELD_HAS(void, Field.AddTo(use.Digest));
    RT_FIELD_HAS(void, Field.AddTo(use.Digest, use.Values));
    RT_FIELD_HAS(bool, Field.HasHoles(use.Values));
    if constexpr (IsWalked)
    {
      RT_FIELD_HAS(bool, Field.FindPlace(use.Vector, use.Place));
      RT_FIELD_HAS(void, Field.MovePlace(use.Vector, use.Place));
    }
    return true;
  }
#undef RT_FIELD_HAS

  /// Checks its searches, too, for one store.
  template <class Store>
  static constexpr bool HasSearches()
  {
    static_assert(IsMade<typename FieldType::template Sampler<Store>, Store>,
      "A field's Sampler must be made by Sampler(Store&, Store::Worker&)");
    static_assert(IsMade<typename FieldType::template Surfaces<Store>, Store>,
      "A field's Surfaces must be made by Surfaces(Store&, Store::Worker&)");
    static_assert(IsMade<typename FieldType::template Media<Store>, Store>,
      "A field's Media must be made by Media(Store&, Store::Worker&)");
    static_assert(IsMade<typename FieldType::template Extrema<Store>, Store>,
      "A field's Extrema must be made by Extrema(Store&, Store::Worker&)");
    static_assert(sizeof(typename FieldType::Sections) > 0, "A field's Sections must be included");
    if constexpr (IsWalked)
    {
      static_assert(IsMade<typename FieldType::template Walk<Store>, Store>,
        "A field's Walk must be made by Walk(Store&, Store::Worker&)");
    }
    return HasAll();
  }

private:
  template <class Search, class Store>
  static constexpr bool IsMade = std::is_constructible_v<Search, Store&, typename Store::Worker&>;
};

} // namespace rt

#endif
