// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/format/VolumeFile.h"

#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/SmallFile.h"

#include <glm/ext/vector_uint3_sized.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <set>

namespace vol
{

std::string OpenOptions::GetArrayName(const std::string& path) const
{
  return this->ArrayName.empty() ? GetStem(path) : this->ArrayName;
}

VolumeFile::VolumeFile(std::string path)
  : Path(std::move(path))
{
  static std::atomic<std::uint64_t> last{ 0 };
  this->Number = ++last;
}

bool VolumeFile::IsEvenlySpaced() const
{
  return std::all_of(this->Coordinates.begin(), this->Coordinates.end(),
    [](const std::vector<double>& positions) { return positions.empty(); });
}

void VolumeFile::SetPlace(const OpenOptions& options)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const auto place = static_cast<std::size_t>(axis);
    if (options.Spacing[place] != 0.0)
    {
      this->Geometry.Spacing[axis] = options.Spacing[place];
      this->Coordinates[place].clear();
    }
    if (options.Origin)
    {
      const double origin = (*options.Origin)[place];
      this->Geometry.Origin[axis] = origin;
      std::vector<double>& positions = this->Coordinates[place];
      const double first = positions.empty() ? origin : positions.front();
      for (double& position : positions)
      {
        position += origin - first;
      }
    }
  }
}

void VolumeFile::DropRepeatedWarnings()
{
  std::set<std::string> known;
  const auto isRepeated = [&](const std::string& warning) { return !known.insert(warning).second; };
  this->Warnings.erase(
    std::remove_if(this->Warnings.begin(), this->Warnings.end(), isRepeated), this->Warnings.end());
}

std::string DescribeShape(const bricks::Index3& samples)
{
  return std::to_string(samples.x) + " x " + std::to_string(samples.y) + " x " +
    std::to_string(samples.z);
}

void CheckSizes(const std::string& path, const FileArray& array, std::size_t slices)
{
  const auto refuse = [&](const std::string& what)
  { throw FileError(path, "has an invalid header: it declares " + what + "."); };
  const auto isRight = [&](const bricks::Index3& samples)
  {
    const bricks::Index3 most(static_cast<std::int64_t>(FileLimits::Samples));
    const glm::u64vec3 sides(samples);
    return glm::all(glm::greaterThan(samples, bricks::Index3(0))) &&
      glm::all(glm::lessThanEqual(samples, most)) &&
      MultiplyWithin(
        FileLimits::ArrayBytes, { sides.x, sides.y, sides.z, array.GetSampleBytes(), slices });
  };
  CheckLimit(path, "bytes of an array's name", array.Name.size(), FileLimits::NameBytes);
  if (array.Name.find('\0') != std::string::npos)
  {
    refuse("an array name with a zero byte");
  }
  if (array.Components < 1)
  {
    refuse(std::to_string(array.Components) + " components");
  }
  CheckLimit(
    path, "components", static_cast<std::uint64_t>(array.Components), FileLimits::Components);
  if (!isRight(array.Grid.Samples))
  {
    refuse(DescribeShape(array.Grid.Samples) + " samples");
  }
  if (!isRight(array.Grid.ChunkSamples))
  {
    refuse("chunks of " + DescribeShape(array.Grid.ChunkSamples) + " samples");
  }
}

bool IsSamePlace(const FileGeometry& a, const FileGeometry& b)
{
  constexpr double tolerance = 1e-3;
  bool isSame = a.First == b.First && a.Points == b.Points;
  for (int row = 0; row < 3; ++row)
  {
    double sample = 0.0; // how large it is along this axis of the world
    double apart = std::abs(a.Origin[row] - b.Origin[row]);
    for (int axis = 0; axis < 3; ++axis)
    {
      const double step = a.Direction[3 * row + axis] * a.Spacing[axis];
      const double other = b.Direction[3 * row + axis] * b.Spacing[axis];
      const std::int64_t last = a.First[axis] + a.Points[axis] - 1;
      const auto far = static_cast<double>(std::max(std::abs(a.First[axis]), std::abs(last)));
      sample = std::max(sample, std::abs(step));
      apart += std::abs(step - other) * far;
    }
    isSame = isSame && apart <= tolerance * sample;
  }
  return isSame;
}

void CheckGeometry(const std::string& path, const FileGeometry& geometry)
{
  const auto areFinite = [](const double* numbers, int count)
  {
    return std::all_of(
      numbers, numbers + count, [](double number) { return std::isfinite(number); });
  };
  const auto refuse = [&](const std::string& what, const std::string& why)
  {
    throw FileError(
      path, "has an invalid " + what + ": " + why + ". Fix the source or the file's header.");
  };
  if (!areFinite(geometry.Origin, 3))
  {
    refuse("origin", "a number is not finite");
  }
  if (!areFinite(geometry.Spacing, 3))
  {
    refuse("spacing", "a number is not finite");
  }
  if (std::count(geometry.Spacing, geometry.Spacing + 3, 0.0) > 0)
  {
    refuse("spacing", "a number is zero");
  }
  const double* const m = geometry.Direction;
  if (!areFinite(m, 9))
  {
    refuse("direction matrix", "a number is not finite");
  }
  // Find the volume spanned by axes of length 1. Rounding errors are below this limit.
  constexpr double least = 1e-9;
  glm::dmat3 axes(0.0);
  for (int axis = 0; axis < 3; ++axis)
  {
    const double length = std::hypot(m[axis], m[3 + axis], m[6 + axis]);
    axes[axis] = glm::dvec3(m[axis], m[3 + axis], m[6 + axis]) / (length > 0.0 ? length : 1.0);
  }
  const double determinant = glm::determinant(axes);
  if (!(std::abs(determinant) >= least))
  {
    refuse("direction matrix", "the matrix is singular");
  }
}

} // namespace vol
