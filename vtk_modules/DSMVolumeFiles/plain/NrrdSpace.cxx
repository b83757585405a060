// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/plain/NrrdSpace.h"

#include "DSMVolumeFiles/base/SmallFile.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vol
{

namespace
{

/// Sets origin and spacing along an axis of a header without vectors. "axis mins" are the positions
/// of the first samples, or of where their cells begin.
void LocateByAxis(
  const HeaderText& header, std::size_t axis, std::int64_t samples, FileGeometry& geometry, int to)
{
  const std::vector<double> spacings = header.GetNumbers("spacings");
  const std::vector<double> mins = header.GetNumbers("axis mins");
  const std::vector<double> maxs = header.GetNumbers("axis maxs");
  const auto get = [axis](const std::vector<double>& numbers)
  { return axis < numbers.size() ? numbers[axis] : std::numeric_limits<double>::quiet_NaN(); };
  const std::vector<std::string> centers = HeaderText::Split(ToLower(header.Get("centers")));
  const bool ofCells = axis < centers.size() && centers[axis] == "cell";
  double step = get(spacings);
  if (!std::isfinite(step) || step == 0.0)
  {
    const auto between = static_cast<double>(ofCells ? samples : samples - 1);
    step = between > 0.0 ? (get(maxs) - get(mins)) / between : 1.0;
  }
  step = std::isfinite(step) && step != 0.0 ? step : 1.0;
  geometry.Spacing[to] = std::abs(step);
  geometry.Direction[4 * to] = step < 0.0 ? -1.0 : 1.0;
  if (std::isfinite(get(mins)))
  {
    geometry.Origin[to] = get(mins) + (ofCells ? 0.5 * step : 0.0);
  }
}

/// Signs of the world's axes that turn a world of `space` to left-posterior-superior, as ITK and Slicer do.
struct Signs
{
  double Of[3] = { 1.0, 1.0, 1.0 };
};

Signs FindSigns(const HeaderText& header, std::vector<std::string>& warnings)
{
  const std::string space = ToLower(header.Get("space"));
  const std::string time = "-time";
  const bool hasTime =
    space.size() > time.size() && space.compare(space.size() - time.size(), time.size(), time) == 0;
  const std::string name = space.substr(0, space.size() - (hasTime ? time.size() : 0));
  const std::string shortName =
    space.size() == 4 && space.back() == 't' ? space.substr(0, 3) : name;
  if (name == "right-anterior-superior" || shortName == "ras")
  {
    return { { -1.0, -1.0, 1.0 } };
  }
  if (name == "left-anterior-superior" || shortName == "las")
  {
    return { { 1.0, -1.0, 1.0 } };
  }
  if (name == "3d-left-handed")
  {
    warnings.push_back(
      "has '3D-left-handed' as its 'space', which is shown as if it were right-handed: "
      "the picture is mirrored.");
  }
  else if (!space.empty() && name != "left-posterior-superior" && shortName != "lps" &&
    name != "scanner-xyz" && name != "3d-right-handed")
  {
    warnings.push_back("has " + Quote(header.Get("space")) +
      " as its 'space', which is unknown: its vectors are taken as they are.");
  }
  return {};
}

/// Gives axes without a vector a direction that is perpendicular to the others', as those of a slice in space.
void CompleteDirections(const bool (&isKnown)[3], FileGeometry& geometry)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const int one = (axis + 1) % 3;
    const int other = (axis + 2) % 3;
    if (isKnown[axis] || !isKnown[one] || !isKnown[other])
    {
      continue;
    }
    double* const m = geometry.Direction;
    double normal[3];
    for (int row = 0; row < 3; ++row)
    {
      const int next = (row + 1) % 3;
      const int last = (row + 2) % 3;
      normal[row] =
        m[3 * next + one] * m[3 * last + other] - m[3 * last + one] * m[3 * next + other];
    }
    const double length = std::hypot(normal[0], normal[1], normal[2]);
    for (int row = 0; row < 3; ++row)
    {
      m[3 * row + axis] = length > 0.0 ? normal[row] / length : m[3 * row + axis];
    }
  }
}

} // namespace

std::vector<std::vector<double>> ParseNrrdVectors(const HeaderText& header, const std::string& name)
{
  std::vector<std::vector<double>> vectors;
  const std::string text = header.Get(name);
  for (std::size_t at = 0; (at = text.find_first_not_of(" \t\r", at)) != std::string::npos;)
  {
    if (vectors.size() == FileLimits::Axes)
    {
      header.Refuse(
        "its field '" + name + "' has more than " + std::to_string(FileLimits::Axes) + " vectors.");
    }
    std::vector<double> numbers;
    std::size_t end = text.find_first_of(text[at] == '(' ? ")" : " \t\r", at);
    if (text[at] == '(')
    {
      if (end == std::string::npos)
      {
        header.Refuse("its field '" + name + "' has a vector without a closing parenthesis.");
      }
      std::string inner = text.substr(at + 1, end - at - 1);
      std::replace(inner.begin(), inner.end(), ',', ' ');
      numbers = header.ToNumbers(name, inner);
      ++end;
    }
    else if (const std::string word = text.substr(at, end - at); word != "none")
    {
      header.Refuse(Quote(word) + " in its field '" + name + "' is not a vector.");
    }
    vectors.push_back(numbers);
    at = std::min(end, text.size());
  }
  return vectors;
}

FileGeometry PlaceNrrd(const HeaderText& header, const std::vector<std::size_t>& domain,
  const bricks::Index3& samples, std::vector<std::string>& warnings)
{
  FileGeometry geometry;
  const auto directions = ParseNrrdVectors(header, "space directions");
  const Signs signs = FindSigns(header, warnings);
  // A space may have fewer than three dimensions, or also time.
  const auto get = [](const std::vector<double>& vector, std::size_t row)
  { return row < vector.size() ? vector[row] : 0.0; };
  bool isKnown[3] = { false, false, false };
  for (std::size_t place = 0; place < domain.size(); ++place)
  {
    const std::size_t number = domain[place];
    const auto axis = static_cast<int>(place);
    LocateByAxis(header, number, samples[axis], geometry, axis);
    if (number < directions.size() && !directions[number].empty())
    {
      const std::vector<double>& way = directions[number];
      // An axis of no length has no direction: OpenVolumeFile refuses that of all formats.
      const double length = std::hypot(get(way, 0), get(way, 1), get(way, 2));
      geometry.Spacing[axis] = length > 0.0 ? length : 1.0;
      for (std::size_t row = 0; row < 3; ++row)
      {
        geometry.Direction[3 * row + place] =
          signs.Of[row] * get(way, row) / geometry.Spacing[axis] + 0.0; // no negative zeros
      }
      isKnown[axis] = true;
    }
  }
  CompleteDirections(isKnown, geometry);
  const auto origin = ParseNrrdVectors(header, "space origin");
  if (!origin.empty() && !origin.front().empty())
  {
    for (std::size_t row = 0; row < 3; ++row)
    {
      geometry.Origin[row] = signs.Of[row] * get(origin.front(), row) + 0.0;
    }
  }
  return geometry;
}

} // namespace vol
