// SPDX-License-Identifier: BSD-3-Clause
#include "BenchmarkCamera.h"

#include "DSMCore/base/Error.h"

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <fstream>
#include <sstream>

std::vector<Position> GetPositions(const VolumeOptions& options)
{
  std::vector<Position> positions;
  if (options.Session.empty())
  {
    for (int frame = 0; frame < options.Frames; ++frame)
    {
      positions.emplace_back().Azimuth = 360.0 * frame / options.Frames;
    }
    return positions;
  }
  std::ifstream file(options.Session);
  for (std::string line; std::getline(file, line);)
  {
    if (line.empty() || line.front() == '#')
    {
      continue;
    }
    std::istringstream numbers(line);
    Position& next = positions.emplace_back();
    if (!(numbers >> next.Azimuth >> next.Elevation >> next.Distance >> next.IsovalueFactor))
    {
      throw dsm::Error("A line of " + options.Session + " is not four numbers: " + line);
    }
  }
  if (positions.empty())
  {
    throw dsm::Error("There is no session in " + options.Session + ".");
  }
  return positions;
}

Camera GetCamera(const rt::LatticeField& field, double aspect, const Position& position)
{
  const glm::dvec3 last(field.Voxels->Lattice.GetCells());
  const glm::dvec3 center(field.IndexToWorld * glm::dvec4(0.5 * last, 1.0));
  glm::dvec3 halfExtents(0.0);
  for (int axis = 0; axis < 3; ++axis)
  {
    halfExtents += 0.5 * last[axis] * glm::abs(glm::dvec3(field.IndexToWorld[axis]));
  }
  return GetCamera(center, halfExtents, aspect, position);
}

Camera GetCamera(
  const glm::dvec3& center, const glm::dvec3& halfExtents, double aspect, const Position& position)
{
  const double distance =
    position.Distance * std::max({ halfExtents.x, halfExtents.y, halfExtents.z });
  const double elevation = glm::radians(position.Elevation);
  const double azimuth = glm::radians(position.Azimuth);
  const glm::dvec3 outward(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
    std::cos(elevation) * std::cos(azimuth));
  const double radius = 1.01 * glm::length(halfExtents);
  return { glm::perspective(glm::radians(30.0), aspect, std::max(distance - radius, 0.01 * radius),
             distance + radius) *
      glm::lookAt(center + distance * outward, center, glm::dvec3(0.0, 1.0, 0.0)),
    -outward };
}

rt::FrameRequest CreateRequest(const VolumeOptions& options, const Camera& camera)
{
  rt::FrameRequest request;
  request.Width = options.Width;
  request.Height = options.Height;
  request.TileSize = options.TileSize;
  request.Samples = options.Samples;
  request.Tolerance = static_cast<float>(options.Tolerance / 255.0);
  request.WorldToClip = camera.WorldToClip;
  request.Scheduling = options.Scheduling;
  return request;
}

rt::LightTransport CreateTransport(const VolumeOptions& options, const rt::LatticeField& field)
{
  rt::LightTransport transport;
  transport.Shadows = options.Shadows;
  transport.LightRadius = options.LightRadius;
  transport.AmbientOcclusionSamples = options.Occlusion;
  transport.AmbientOcclusionDistance = 0.2 *
    glm::length(glm::dmat3(field.IndexToWorld) * glm::dvec3(field.Voxels->Lattice.GetCells()));
  return transport;
}

rt::Light CreateLamp(const VolumeOptions& options, const Camera& camera)
{
  const glm::dvec3 aside = glm::cross(camera.ViewDirection, glm::dvec3(0.0, 0.0, 1.0));
  rt::Light lamp;
  lamp.Direction = glm::normalize(camera.ViewDirection + (options.Shadows ? 0.7 : 0.0) * aside);
  return lamp;
}
