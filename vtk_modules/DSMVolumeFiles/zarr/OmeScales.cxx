// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/zarr/OmeScales.h"

#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/FileLimits.h"
#include "DSMVolumeFiles/base/SmallFile.h"
#include "DSMVolumeFiles/zarr/ZarrJson.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace vol
{

namespace
{

using Json = nlohmann::json;
using ReadNumbers = OmeLevel::ReadNumbers;
using Matrix = std::vector<std::vector<double>>; ///< rows

/// From the indices of an array to a coordinate system; the slowest axis first.
class Placement
{
public:
  Placement(std::string folder, const ReadNumbers& readNumbers)
    : Folder(std::move(folder))
    , ReadFrom(readNumbers)
  {
  }

  /// Applies transformations one after another. `depth`: of sequences in one another.
  void Apply(const Json& transformations, int depth = 0)
  {
    CheckLimit(
      this->Folder, "coordinate transformations", transformations.size(), FileLimits::Axes);
    if (!transformations.is_array() && !transformations.is_null())
    {
      throw FileError(
        this->Folder, "has invalid metadata: 'coordinateTransformations' is not an array.");
    }
    for (const Json& one : transformations)
    {
      this->ApplyOne(one, depth);
    }
  }

  /// Moves the first sample of a coarser level to the mean of the samples of the finest level that
  /// it stands for.
  void MoveToMean(const Placement& finest)
  {
    const std::size_t axes = this->CountAxes();
    for (std::size_t row = 0; row < axes && finest.CountAxes() == axes; ++row)
    {
      for (std::size_t column = 0; column < axes; ++column)
      {
        this->Rows[row][axes] += 0.5 * (this->Rows[row][column] - finest.Rows[row][column]);
      }
    }
  }

  bool HasTranslation() const { return this->IsMoved; }
  std::size_t CountAxes() const { return this->Rows.size(); }
  /// Of each axis of the coordinate system, with the offset as the last column.
  const Matrix& GetRows() const { return this->Rows; }

private:
  [[noreturn]] void Refuse(const std::string& type, const std::string& why) const
  {
    throw FileError(this->Folder,
      "has the coordinate transformation " + Quote(type) + ", which " + why +
        ". Enter Spacing (and Origin) of the reader to place the samples yourself.");
  }

  void ApplyOne(const Json& one, int depth)
  {
    constexpr int mostDepth = 4;
    const std::string type = ZarrJson::GetText(this->Folder, one, "type");
    if (type == "sequence")
    {
      const Json& inner = ZarrJson::Find(one, "transformations");
      if (!inner.is_array() || depth == mostDepth)
      {
        this->Refuse(type, "has no list of transformations, or is nested too deeply");
      }
      this->Apply(inner, depth + 1);
    }
    else if (type == "scale" || type == "translation" || type == "mapAxis")
    {
      this->ApplyToAxes(type, this->GetNumbers(one, type));
    }
    else if (type == "rotation" || type == "affine")
    {
      this->ApplyRows(type, ZarrJson::Find(one, type.c_str()));
    }
    else if (type != "identity")
    {
      this->Refuse(type,
        "cannot be shown. Supported are identity, scale, translation, rotation, affine, mapAxis "
        "and "
        "sequence");
    }
  }

  /// The numbers of a transformation, or of the array that its path names.
  std::vector<double> GetNumbers(const Json& one, const std::string& type) const
  {
    const std::string path = ZarrJson::GetText(this->Folder, one, "path");
    std::vector<double> numbers = path.empty()
      ? ZarrJson::GetNumbers(this->Folder, one, type.c_str(), FileLimits::Axes)
      : this->ReadFrom(path);
    const bool areFinite = std::all_of(
      numbers.begin(), numbers.end(), [](double number) { return std::isfinite(number); });
    if (numbers.empty() || !areFinite)
    {
      this->Refuse(type, "has no numbers, or some that are not finite");
    }
    return numbers;
  }

  void ApplyToAxes(const std::string& type, const std::vector<double>& numbers)
  {
    const std::size_t axes = numbers.size();
    Matrix rows = MakeIdentity(axes);
    for (std::size_t axis = 0; axis < axes; ++axis)
    {
      if (type != "mapAxis")
      {
        rows[axis][type == "scale" ? axis : axes] = numbers[axis];
        continue;
      }
      const auto from = ToInteger(numbers[axis], 0, static_cast<std::int64_t>(axes) - 1);
      if (!from || std::count(numbers.begin(), numbers.end(), numbers[axis]) != 1)
      {
        this->Refuse(type, "does not name each axis once");
      }
      rows[axis][axis] = 0.0;
      rows[axis][static_cast<std::size_t>(*from)] = 1.0;
    }
    this->Combine(type, rows);
    this->IsMoved = this->IsMoved || type == "translation";
  }

  /// The matrix of a rotation is square; that of an affine transformation has a column of offsets behind it.
  void ApplyRows(const std::string& type, const Json& json)
  {
    const std::size_t axes = json.is_array() ? json.size() : 0;
    const std::size_t columns = axes + (type == "affine" ? 1 : 0);
    Matrix rows;
    for (std::size_t row = 0; row < std::min<std::size_t>(axes, FileLimits::Axes + 1); ++row)
    {
      rows.push_back(ZarrJson::ToNumbers(json[row]));
      if (rows.back().size() != columns)
      {
        this->Refuse(type, "is not a matrix of " + std::to_string(columns) + " columns");
      }
      rows.back().resize(axes + 1, 0.0);
    }
    this->Combine(type, rows);
    this->IsMoved = this->IsMoved || type == "affine";
  }

  /// No change: each row has the column of an offset behind those of the axes.
  static Matrix MakeIdentity(std::size_t axes)
  {
    Matrix rows(axes, std::vector<double>(axes + 1, 0.0));
    for (std::size_t axis = 0; axis < axes; ++axis)
    {
      rows[axis][axis] = 1.0;
    }
    return rows;
  }

  /// Applies rows of such a matrix after what there is.
  void Combine(const std::string& type, const Matrix& rows)
  {
    const std::size_t axes = rows.size();
    if (axes > FileLimits::Axes || (!this->Rows.empty() && this->Rows.size() != axes))
    {
      this->Refuse(type, "has not as many numbers as there are axes");
    }
    const Matrix before = this->Rows.empty() ? MakeIdentity(axes) : std::move(this->Rows);
    this->Rows.assign(axes, std::vector<double>(axes + 1, 0.0));
    for (std::size_t row = 0; row < axes; ++row)
    {
      this->Rows[row][axes] = rows[row][axes];
      for (std::size_t inner = 0; inner < axes; ++inner)
      {
        for (std::size_t column = 0; column <= axes; ++column)
        {
          this->Rows[row][column] += rows[row][inner] * before[inner][column];
        }
      }
    }
  }

  std::string Folder;
  const ReadNumbers& ReadFrom;
  Matrix Rows; ///< empty: nothing was applied
  bool IsMoved = false;
};

/// The axes of the coordinate system in which a dataset lies: 0.6 names it, versions before have one.
const Json& FindAxes(const std::string& folder, const Json& scale, const Json& dataset)
{
  const Json& systems = ZarrJson::Find(scale, "coordinateSystems");
  const Json& transformations = ZarrJson::Find(dataset, "coordinateTransformations");
  if (!systems.is_array() || systems.empty())
  {
    return ZarrJson::Find(scale, "axes");
  }
  const Json& output = transformations.is_array() && !transformations.empty()
    ? ZarrJson::Find(transformations.back(), "output")
    : Json();
  const std::string wanted =
    output.is_string() ? output.get<std::string>() : ZarrJson::GetText(folder, output, "name");
  for (const Json& system : systems)
  {
    if (wanted.empty() || ZarrJson::GetText(folder, system, "name") == wanted)
    {
      return ZarrJson::Find(system, "axes");
    }
  }
  throw FileError(folder,
    "has invalid metadata: a dataset's coordinate system " + Quote(wanted) +
      " is not among its coordinateSystems.");
}

AxisNotes ReadAxes(const std::string& folder, const Json& axes, std::vector<std::string>& warnings)
{
  AxisNotes notes;
  CheckLimit(folder, "axes", axes.size(), FileLimits::Axes);
  bool hasOrientation = false;
  for (const Json& axis : axes)
  {
    AxisNote note;
    note.Name =
      axis.is_string() ? axis.get<std::string>() : ZarrJson::GetText(folder, axis, "name");
    note.Type = ZarrJson::GetText(folder, axis, "type");
    note.Unit = ZarrJson::GetText(folder, axis, "unit");
    hasOrientation = hasOrientation || !ZarrJson::Find(axis, "orientation").is_null() ||
      !ZarrJson::Find(axis, "anatomicalOrientation").is_null();
    notes.push_back(std::move(note));
  }
  if (hasOrientation)
  {
    warnings.push_back("has an anatomical 'orientation' of its axes, which is not honored.");
  }
  return notes;
}

/// Which axis of the coordinate system each axis of the array runs along; none where one is along several.
std::optional<std::vector<std::size_t>> FindAlong(const Matrix& linear)
{
  std::vector<std::size_t> along;
  for (std::size_t column = 0; column < linear.size(); ++column)
  {
    std::optional<std::size_t> found;
    for (std::size_t row = 0; row < linear.size(); ++row)
    {
      if (linear[row][column] != 0.0)
      {
        if (found)
        {
          return std::nullopt;
        }
        found = row;
      }
    }
    if (!found || std::count(along.begin(), along.end(), *found) > 0)
    {
      return std::nullopt;
    }
    along.push_back(*found);
  }
  return along;
}

/// Axes of space that are turned or sheared, but for those of time and channels.
void Turn(const std::string& folder, const Placement& placement, OmeLevel& level)
{
  std::array<std::size_t, 3> places{}; // of x, y and z
  std::array<bool, 3> isFound{};
  const Matrix& linear = placement.GetRows();
  for (std::size_t axis = 0; axis < level.Axes.size(); ++axis)
  {
    AxisNote& note = level.Axes[axis];
    const auto space = note.FindSpaceAxis();
    if (space)
    {
      places[static_cast<std::size_t>(*space)] = axis;
      isFound[static_cast<std::size_t>(*space)] = true;
    }
    for (std::size_t other = 0; other < level.Axes.size(); ++other)
    {
      const bool isOutside = !space || !level.Axes[other].FindSpaceAxis();
      if (isOutside && other != axis && linear[axis][other] != 0.0)
      {
        throw FileError(folder,
          "has a coordinate transformation that turns its axes of space into others, which cannot "
          "be shown.");
      }
    }
    note.Origin = linear[axis].back();
    note.Spacing = space ? 1.0 : linear[axis][axis];
  }
  if (std::count(isFound.begin(), isFound.end(), true) != 3)
  {
    throw FileError(folder,
      "has a coordinate transformation that turns its axes, which need the names x, y and z.");
  }
  std::array<double, 9> direction{};
  for (std::size_t column = 0; column < 3; ++column)
  {
    double length = 0.0;
    for (std::size_t row = 0; row < 3; ++row)
    {
      length = std::hypot(length, linear[places[row]][places[column]]);
    }
    for (std::size_t row = 0; row < 3 && length > 0.0; ++row)
    {
      direction[3 * row + column] = linear[places[row]][places[column]] / length;
    }
    level.Axes[places[column]].Spacing = length > 0.0 ? length : 1.0;
  }
  level.Direction = direction;
}

Placement Place(
  const std::string& folder, const Json& scale, const Json& dataset, const ReadNumbers& readNumbers)
{
  Placement placement(folder, readNumbers);
  if (!readNumbers)
  {
    return placement;
  }
  placement.Apply(ZarrJson::Find(dataset, "coordinateTransformations"));
  if (ZarrJson::Find(scale, "coordinateSystems").is_null())
  {
    placement.Apply(ZarrJson::Find(scale, "coordinateTransformations"));
  }
  return placement;
}

} // namespace

OmeLevel OmeLevel::Find(const std::string& folder, const Json& scale, std::size_t level,
  const ReadNumbers& readNumbers, std::vector<std::string>& warnings)
{
  const Json& datasets = ZarrJson::Find(scale, "datasets");
  const Json& dataset = datasets.at(level);
  OmeLevel found;
  found.Array = ZarrJson::GetText(folder, dataset, "path");
  found.Axes = ReadAxes(folder, FindAxes(folder, scale, dataset), warnings);
  if (!ZarrJson::Find(scale, "coordinateSystems").is_null() &&
    ZarrJson::Find(scale, "coordinateTransformations").size() > 0)
  {
    warnings.push_back(
      "has 'coordinateTransformations' to further coordinate systems, which are not honored.");
  }
  Placement placement = Place(folder, scale, dataset, readNumbers);
  const auto hasTranslation = [&](const Json& one)
  {
    Placement own(folder, readNumbers);
    own.Apply(ZarrJson::Find(one, "coordinateTransformations"));
    return own.HasTranslation();
  };
  if (readNumbers && level > 0 && std::none_of(datasets.begin(), datasets.end(), hasTranslation))
  {
    placement.MoveToMean(Place(folder, scale, datasets.front(), readNumbers));
  }
  const std::size_t axes = placement.CountAxes();
  if (axes == 0)
  {
    return found;
  }
  if (found.Axes.empty())
  {
    found.Axes.resize(axes);
  }
  const auto along = FindAlong(placement.GetRows());
  if (axes > found.Axes.size() || (axes < found.Axes.size() && !along))
  {
    throw FileError(folder,
      "has coordinate transformations of " + std::to_string(axes) + " axes, but " +
        std::to_string(found.Axes.size()) + " axes.");
  }
  if (along)
  {
    // If there are fewer numbers than axes, they belong to the last axes.
    const std::size_t first = found.Axes.size() - axes;
    const AxisNotes system = found.Axes;
    for (std::size_t axis = 0; axis < axes; ++axis)
    {
      AxisNote& note = found.Axes[first + axis];
      note = system[first + (*along)[axis]];
      note.Spacing = placement.GetRows()[(*along)[axis]][axis];
      note.Origin = placement.GetRows()[(*along)[axis]].back();
    }
  }
  else
  {
    Turn(folder, placement, found);
    return found;
  }
  return found;
}

} // namespace vol
