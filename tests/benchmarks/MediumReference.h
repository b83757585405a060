// SPDX-License-Identifier: BSD-3-Clause
#ifndef MediumReference_h
#define MediumReference_h

#include "BenchmarkVolume.h"
#include "MediumFunction.h"

#include "DSMRayTracing/frame/Frame.h"
#include "DSMRayTracing/frame/FrameRequest.h"

#include <cstdint>

/// Pictures of an unshaded medium by a plain sum in double precision: even steps along each ray, a
/// trilinear value in the middle of each step, and the function itself there. It shares the rays of pixels with the
/// tracer, and nothing else.
class MediumReference
{
public:
  /// How far colors and opacities are from the reference, in 255ths.
  struct Difference
  {
    double Sum = 0.0;       ///< over four channels of the pixels
    double Largest = 0.0;   ///< of any channel of any pixel
    std::uint64_t Seen = 0; ///< pixels in which either picture shows anything

    void Add(const Difference& other);
    double GetMean() const { return this->Sum / static_cast<double>(4 * this->Seen); }
  };

  /// `stepsPerCell`: along its shortest edge. Keeps a reference.
  MediumReference(const BenchmarkSamples& samples, int stepsPerCell, int threads)
    : Samples(samples)
    , StepsPerCell(stepsPerCell)
    , Threads(threads)
  {
  }

  /// Local: of the tiles that this rank traced.
  Difference Compare(
    const rt::Frame& frame, const rt::FrameRequest& request, const MediumFunction& function) const;

private:
  const BenchmarkSamples& Samples;
  int StepsPerCell;
  int Threads;
};

#endif
