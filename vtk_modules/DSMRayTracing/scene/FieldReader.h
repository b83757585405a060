// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_FieldReader_h
#define rt_FieldReader_h

#include "DSMBricks/base/Box.h"
#include "DSMBricks/base/ScalarType.h"
#include "DSMCore/base/Block.h"
#include "DSMCore/base/FunctionRef.h"
#include "DSMCore/publish/BlockSegment.h"
#include "DSMRayTracing/field/Fields.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <vector>

namespace rt
{

/// Reads what is published, on whichever rank and in whichever store it is. For the thread that FrameRenderer::Read
/// calls with one; waits for bricks.
class FieldReader
{
public:
  virtual ~FieldReader() = default;

  /// A copy of a voxel brick.
  struct Brick
  {
    bricks::Index3 Cells;        ///< on each axis
    std::vector<double> Samples; ///< at the points, one more than cells on each axis, x fastest
    std::vector<std::uint8_t>
      HoldsData; ///< of the cells, x fastest; all corners of those with 1 are finite
  };

  /// Calls `visit` with each of the bricks, in their order.
  virtual void ReadBricks(const dsm::BlockSegment& segment, bricks::ScalarType type,
    const std::vector<dsm::BlockId>& ids,
    dsm::FunctionRef<void(dsm::BlockId, const Brick&)> visit) = 0;

  /// How fast values grow at points in the field's world space, on each axis of its own space (FindSmoothGradients
  /// of its Sampler); 0 where there are none.
  virtual std::vector<glm::dvec3> FindGradients(
    const AnyField& field, const std::vector<glm::dvec3>& points) = 0;

  /// The values at points in the field's world space; NaN where there are none.
  virtual std::vector<double> FindValues(
    const AnyField& field, const std::vector<glm::dvec3>& points) = 0;
};

/// Keeps references. For the stores of dsm::BlockStore; compiled where CreateSceneTracers is.
template <class Store>
std::unique_ptr<FieldReader> CreateFieldReader(Store& store, typename Store::Worker& worker);

} // namespace rt

#endif
