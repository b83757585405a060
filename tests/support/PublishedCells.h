// SPDX-License-Identifier: BSD-3-Clause
#ifndef PublishedCells_h
#define PublishedCells_h

#include "tests/support/CellModel.h"

#include "DSMBricks/cells/PointGradients.h"
#include "DSMBricks/cells/PublishCells.h"
#include "DSMBricks/cells/SharedPlaces.h"
#include "DSMBricks/layout/PlaceInBrick.h"
#include "DSMCore/store/BlockStore.h"
#include "DSMCore/transport/Messenger.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <functional>
#include <memory>

/// Collective: publishes the cells of all ranks' models with values of a function of the place.
inline std::shared_ptr<const bricks::CellValues> PublishCellModel(const CellModel& model,
  const std::function<double(const glm::dvec3&)>& function, dsm::Messenger& messenger,
  dsm::BlockStore& store, std::uint32_t brickBytes = 8192)
{
  constexpr auto place = dsm::BlockStore::Place::Memory;
  constexpr int threads = 2;
  bricks::CornerRoutes routes;
  bricks::SortedBrickSettings sorting;
  sorting.BrickBytes = brickBytes;
  const auto cells = bricks::PublishCells("cells", model, sorting, store, messenger, place, routes);
  const auto getValue = [&](std::uint64_t point) { return function(model.GetPlaces()[point]); };
  const auto getPlace = [&](std::uint64_t point, float* at)
  { return bricks::PlaceInBrick(*cells, &model.GetPlaces()[point].x, at); };
  const bricks::SharedPlaces shared("places", model.GetPointCount(), getPlace, threads, messenger);
  const auto gradients =
    bricks::FindPointGradients("gradients", model, *cells, shared, getValue, threads, messenger);
  return bricks::PublishCellValues(
    "values", cells, routes, getValue, gradients, threads, store, messenger, place);
}

#endif
