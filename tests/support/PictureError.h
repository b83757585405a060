// SPDX-License-Identifier: BSD-3-Clause
#ifndef PictureError_h
#define PictureError_h

#include "DSMRayTracing/frame/FrameGather.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <vector>

/// Returns the pixels that two pictures of one size show alike: no channel of their colors differs by more than
/// `difference`, in 255ths.
inline std::vector<std::size_t> FindAlike(
  const rt::Picture& one, const rt::Picture& other, int difference)
{
  std::vector<std::size_t> alike;
  for (std::size_t pixel = 0; pixel < one.Depth.size(); ++pixel)
  {
    int most = 0;
    for (std::size_t value = 4 * pixel; value < 4 * pixel + 4; ++value)
    {
      most = std::max(most, std::abs(one.Color[value] - other.Color[value]));
    }
    if (most <= difference)
    {
      alike.push_back(pixel);
    }
  }
  return alike;
}

/// Returns the root of the mean square of differences of red, green and blue, in 255ths; 0 without pixels.
inline double GetError(
  const rt::Picture& picture, const rt::Picture& exact, const std::vector<std::size_t>& pixels)
{
  double sum = 0.0;
  for (const std::size_t pixel : pixels)
  {
    for (std::size_t value = 4 * pixel; value < 4 * pixel + 3; ++value)
    {
      const double difference = picture.Color[value] - static_cast<double>(exact.Color[value]);
      sum += difference * difference;
    }
  }
  return std::sqrt(sum / (3.0 * static_cast<double>(std::max<std::size_t>(pixels.size(), 1))));
}

#endif
