// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_StoreFieldReader_h
#define rt_StoreFieldReader_h

#include "DSMBricks/layout/VoxelBrick.h"
#include "DSMRayTracing/field/FieldSearches.h"
#include "DSMRayTracing/scene/FieldReader.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <type_traits>
#include <variant>

namespace rt
{

/// A FieldReader for one worker of a store.
template <class Store>
class StoreFieldReader final : public FieldReader
{
public:
  StoreFieldReader(Store& store, typename Store::Worker& worker)
    : Blocks(store)
    , Self(worker)
  {
  }

  void ReadBricks(const dsm::BlockSegment& segment, bricks::ScalarType type,
    const std::vector<dsm::BlockId>& ids,
    dsm::FunctionRef<void(dsm::BlockId, const Brick&)> visit) override
  {
    Brick brick;
    for (std::size_t place = 0; place < ids.size(); ++place)
    {
      if (place % Lead == 0)
      {
        this->Blocks.Prefetch(segment, ids.data() + place, std::min(2 * Lead, ids.size() - place));
      }
      bricks::Dispatch(type,
        [&](auto sample)
        {
          const typename Store::Pin pin = this->Blocks.Acquire(this->Self, segment, ids[place]);
          Copy(bricks::VoxelBrick<decltype(sample)>(pin.GetData()), brick);
        });
      this->Blocks.Quiesce(this->Self);
      visit(ids[place], brick);
    }
  }

  std::vector<glm::dvec3> FindGradients(
    const AnyField& any, const std::vector<glm::dvec3>& points) override
  {
    std::vector<glm::dvec3> gradients(points.size(), glm::dvec3(0.0));
    this->VisitField(any,
      [&](const auto& field, const auto& sampler)
      { sampler.FindSmoothGradients(field, points, gradients); });
    return gradients;
  }

  std::vector<double> FindValues(
    const AnyField& any, const std::vector<glm::dvec3>& points) override
  {
    std::vector<double> values(points.size(), std::numeric_limits<double>::quiet_NaN());
    this->VisitField(any,
      [&](const auto& field, const auto& sampler)
      {
        typename std::decay_t<decltype(field)>::Place place;
        for (std::size_t number = 0; number < points.size(); ++number)
        {
          if (sampler.FindPlace(field, points[number], place))
          {
            sampler.FindValues(field.GetValues(), &place, 1, &values[number]);
          }
        }
      });
    return values;
  }

private:
  /// Bricks are asked for at most twice as many before they are read.
  static constexpr std::size_t Lead = 16;

  /// Calls `visit(field, sampler)`.
  template <class Visit>
  void VisitField(const AnyField& any, const Visit& visit) const
  {
    std::visit(
      [&](const auto& field)
      {
        using Sampler = typename std::decay_t<decltype(field)>::template Sampler<Store>;
        visit(field, Sampler(this->Blocks, this->Self));
      },
      any);
  }

  template <class T>
  static void Copy(const bricks::VoxelBrick<T>& from, Brick& to)
  {
    to.Cells = { from.GetCells(0), from.GetCells(1), from.GetCells(2) };
    const bricks::Index3 points = to.Cells + bricks::Index3(1);
    to.Samples.assign(from.GetSamples(), from.GetSamples() + points.x * points.y * points.z);
    to.HoldsData.clear();
    bricks::ForEachIndex({ bricks::Index3(0), to.Cells },
      [&](const bricks::Index3& cell)
      {
        const glm::ivec3 at(cell);
        to.HoldsData.push_back(from.HoldsData(at.x, at.y, at.z) ? 1 : 0);
      });
  }

  Store& Blocks;
  typename Store::Worker& Self;
};

template <class Store>
std::unique_ptr<FieldReader> CreateFieldReader(Store& store, typename Store::Worker& worker)
{
  return std::make_unique<StoreFieldReader<Store>>(store, worker);
}

} // namespace rt

#endif
