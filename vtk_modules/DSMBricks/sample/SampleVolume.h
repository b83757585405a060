// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_SampleVolume_h
#define bricks_SampleVolume_h

#include "DSMBricks/base/Box.h"
#include "DSMBricks/base/ScalarType.h"
#include "DSMBricks/build/VoxelSource.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <string>

namespace bricks
{

/// Generated volumes of any size, for demonstrations, tests and benchmarks. A sample depends on its
/// index and on the volume's size only, so every rank makes its own piece, with the same bits.
class SampleVolume
{
public:
  enum class Kind
  {
    /// x^2 + y^2 + z^2 + noise on [-1, 1]^3, as in the paper; isovalue 0.5.
    Sphere,
    /// A turbulent mixing layer in [0, 255], after the Richtmyer-Meshkov simulation that the paper
    /// renders; isovalue 100.
    MixingLayer
  };

  /// `points` per axis, each >= 2.
  SampleVolume(Kind kind, const Index3& points);

  const Index3& GetPoints() const { return this->Points; }
  /// World position of sample (0, 0, 0), and the distance of two samples on every axis: the longest
  /// axis of the sphere's volume is 2 long, the mixing layer's x axis 1.
  glm::dvec3 GetOrigin() const;
  double GetSpacing() const;

  double Evaluate(std::int64_t i, std::int64_t j, std::int64_t k) const;

  /// Samples in `type`, x fastest. Integer types get the mixing layer's value rounded, and 64 times
  /// the sphere's (isovalue 32), clamped to [0, 255] or less where the type holds less.
  void Fill(const Box& points, ScalarType type, std::byte* out) const;

private:
  double EvaluateSphere(std::int64_t i, std::int64_t j, std::int64_t k) const;
  double EvaluateMixingLayer(double x, double y, double z) const;

  Kind Type;
  Index3 Points;
};

/// A piece of a sample volume that is computed when it is read, and never stored.
class SampleVolumeSource final : public VoxelSource
{
public:
  SampleVolumeSource(const SampleVolume& volume, const Box& cells, ScalarType type)
    : Volume(volume)
    , Cells(cells)
    , Type(type)
  {
  }
  Box GetCells() const override { return this->Cells; }
  void ReadSamples(const Box& points, std::byte* out) const override
  {
    this->Volume.Fill(points, this->Type, out);
  }

private:
  SampleVolume Volume;
  Box Cells;
  ScalarType Type;
};

} // namespace bricks

#endif
