// SPDX-License-Identifier: BSD-3-Clause
#include "MediumReference.h"

#include "DSMRayTracing/frame/PixelRays.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>
#include <vector>

namespace
{

/// Samples of type T, and rays through them.
template <class T>
class PlainVolume
{
public:
  PlainVolume(const BenchmarkSamples& samples, int stepsPerCell)
    : Values(reinterpret_cast<const T*>(samples.Bytes.data()))
    , Points(samples.Points)
    , WorldToIndex(glm::inverse(samples.IndexToWorld))
    , Step(std::min({ glm::length(glm::dvec3(samples.IndexToWorld[0])),
             glm::length(glm::dvec3(samples.IndexToWorld[1])),
             glm::length(glm::dvec3(samples.IndexToWorld[2])) }) /
        stepsPerCell)
  {
  }

  /// Premultiplied color and opacity.
  glm::dvec4 Integrate(const rt::Ray& ray, const MediumFunction& function) const
  {
    const glm::dvec3 origin(this->WorldToIndex * glm::dvec4(ray.Origin, 1.0));
    const glm::dvec3 direction(this->WorldToIndex * glm::dvec4(ray.Direction, 0.0));
    double begin = ray.Min;
    double end = ray.Max;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double last = static_cast<double>(this->Points[axis] - 1);
      if (direction[axis] == 0.0)
      {
        end = origin[axis] < 0.0 || origin[axis] > last ? begin : end;
        continue;
      }
      const double near = -origin[axis] / direction[axis];
      const double far = (last - origin[axis]) / direction[axis];
      begin = std::max(begin, std::min(near, far));
      end = std::min(end, std::max(near, far));
    }
    glm::dvec4 seen(0.0);
    if (begin >= end)
    {
      return seen;
    }
    const double length = (end - begin) * glm::length(ray.Direction);
    const double steps = std::ceil(length / this->Step);
    for (double step = 0.5; step < steps; ++step)
    {
      const double t = begin + step / steps * (end - begin);
      const glm::dvec4 look = function.GetLook(this->GetValue(origin + t * direction));
      const double opacity = -std::expm1(-look.w * length / steps);
      seen += (1.0 - seen.w) * opacity * glm::dvec4(glm::dvec3(look), 1.0);
    }
    return seen;
  }

private:
  double GetValue(const glm::dvec3& place) const
  {
    bricks::Index3 low;
    glm::dvec3 part;
    for (int axis = 0; axis < 3; ++axis)
    {
      low[axis] =
        std::clamp<std::int64_t>(static_cast<std::int64_t>(place[axis]), 0, this->Points[axis] - 2);
      part[axis] = std::clamp(place[axis] - static_cast<double>(low[axis]), 0.0, 1.0);
    }
    const T* const corner =
      this->Values + (low.z * this->Points.y + low.y) * this->Points.x + low.x;
    double planes[2];
    for (int z = 0; z < 2; ++z)
    {
      double rows[2];
      for (int y = 0; y < 2; ++y)
      {
        const T* const row = corner + (z * this->Points.y + y) * this->Points.x;
        rows[y] =
          (1.0 - part.x) * static_cast<double>(row[0]) + part.x * static_cast<double>(row[1]);
      }
      planes[z] = (1.0 - part.y) * rows[0] + part.y * rows[1];
    }
    return (1.0 - part.z) * planes[0] + part.z * planes[1];
  }

  const T* Values;
  bricks::Index3 Points;
  glm::dmat4 WorldToIndex;
  double Step; ///< length
};

template <class T>
MediumReference::Difference CompareTile(const rt::Tile& tile, const rt::PixelRays& rays,
  const PlainVolume<T>& volume, const MediumFunction& function)
{
  MediumReference::Difference result;
  for (int y = 0; y < tile.Height; ++y)
  {
    for (int x = 0; x < tile.Width; ++x)
    {
      const glm::dvec4 right = volume.Integrate(rays.GetRay(tile.X + x, tile.Y + y), function);
      const glm::dvec4 found(tile.Sum[static_cast<std::size_t>(y) * tile.Width + x]);
      if (right.w == 0.0 && found.w == 0.0)
      {
        continue;
      }
      ++result.Seen;
      for (int channel = 0; channel < 4; ++channel)
      {
        const double difference = 255.0 * std::abs(found[channel] - right[channel]);
        result.Sum += difference;
        result.Largest = std::max(result.Largest, difference);
      }
    }
  }
  return result;
}

} // namespace

void MediumReference::Difference::Add(const Difference& other)
{
  this->Sum += other.Sum;
  this->Largest = std::max(this->Largest, other.Largest);
  this->Seen += other.Seen;
}

MediumReference::Difference MediumReference::Compare(
  const rt::Frame& frame, const rt::FrameRequest& request, const MediumFunction& function) const
{
  const rt::PixelRays rays(request);
  std::vector<Difference> parts(frame.Tiles.size());
  bricks::Dispatch(this->Samples.Type,
    [&](auto sample)
    {
      const PlainVolume<decltype(sample)> volume(this->Samples, this->StepsPerCell);
      std::atomic<std::size_t> next{ 0 };
      const auto work = [&]
      {
        for (std::size_t tile = next++; tile < parts.size(); tile = next++)
        {
          parts[tile] = CompareTile(frame.Tiles[tile], rays, volume, function);
        }
      };
      std::vector<std::thread> workers;
      for (int thread = 0; thread < this->Threads; ++thread)
      {
        workers.emplace_back(work);
      }
      for (std::thread& worker : workers)
      {
        worker.join();
      }
    });
  Difference all;
  for (const Difference& part : parts)
  {
    all.Add(part);
  }
  return all;
}
