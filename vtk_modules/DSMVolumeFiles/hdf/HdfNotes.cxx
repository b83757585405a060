// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/hdf/HdfNotes.h"

#include "DSMVolumeFiles/base/FileLimits.h"
#include "DSMVolumeFiles/base/SmallFile.h"
#include "DSMVolumeFiles/hdf/HdfAxes.h"
#include "DSMVolumeFiles/hdf/HdfOrigins.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

namespace vol
{

namespace
{

/// Returns the path of the group that a dataset is in, with a slash behind it.
std::string GetGroupPath(hid_t dataset)
{
  const std::string path = GetHdfText(&H5Iget_name, dataset);
  return path.substr(0, path.rfind('/') + 1);
}

std::string GetLastWord(const std::string& path)
{
  return path.substr(path.rfind('/') + 1);
}

/// All numbers of a dataset, where it has as many as an axis, or two, which are the first ones of an even distance.
std::vector<double> ReadCoordinates(hid_t group, const char* name, hsize_t length)
{
  std::vector<double> numbers;
  const auto most = static_cast<hsize_t>(FileLimits::Coordinates);
  ReadHdfWhole(group, name, H5T_NATIVE_DOUBLE, std::min(most, length), numbers);
  if (numbers.size() == 2 && length > 2 && length <= most)
  {
    for (hsize_t index = 2; index < length; ++index)
    {
      numbers.push_back(numbers[0] + static_cast<double>(index) * (numbers[1] - numbers[0]));
    }
  }
  return numbers.size() == length ? numbers : std::vector<double>();
}

/// Reads the notes of a dataset that is a mesh's record, or a component of one.
AxisNotes ReadOpenPmd(
  hid_t file, hid_t dataset, const std::vector<hsize_t>& shape, std::vector<std::string>& warnings)
{
  AxisNotes notes;
  if (ReadHdfText(file, "openPMD").empty())
  {
    return notes;
  }
  const std::string path = GetHdfText(&H5Iget_name, dataset);
  const HdfHandle parent(H5Gopen2(file, GetGroupPath(dataset).c_str(), H5P_DEFAULT), &H5Gclose);
  const hid_t record = H5Aexists(dataset, "axisLabels") > 0 ? dataset : parent.Get();
  std::vector<std::string> labels = ReadHdfTexts(record, "axisLabels");
  const std::vector<double> spacing = ReadHdfNumbers(record, "gridSpacing");
  const std::vector<double> offset = ReadHdfNumbers(record, "gridGlobalOffset");
  std::vector<double> position = ReadHdfNumbers(dataset, "position");
  const std::vector<double> unit = ReadHdfNumbers(record, "gridUnitSI");
  const std::size_t rank = shape.size();
  if (labels.size() != rank || spacing.size() != rank || offset.size() != rank)
  {
    if (!labels.empty() || !spacing.empty())
    {
      warnings.push_back("has 'axisLabels', 'gridSpacing' or 'gridGlobalOffset' of " + Quote(path) +
        " with another number of axes than the array. They are ignored.");
    }
    return notes;
  }
  position.resize(rank, 0.0);
  const std::string geometry = ReadHdfText(record, "geometry");
  if (!geometry.empty() && geometry != "cartesian")
  {
    warnings.push_back("has the 'geometry' " + Quote(geometry) + " of " + Quote(path) +
      ", which is not honored. Its axes are shown as Cartesian ones.");
  }
  const double meters = unit.size() == 1 ? unit.front() : 1.0;
  for (std::size_t axis = 0; axis < rank; ++axis)
  {
    AxisNote note;
    note.Name = labels[axis];
    note.Spacing = spacing[axis] * meters;
    note.Origin = (offset[axis] + position[axis] * spacing[axis]) * meters;
    note.Unit = "m";
    notes.push_back(std::move(note));
  }
  if (ReadHdfText(record, "dataOrder") == "F")
  {
    std::reverse(notes.begin(), notes.end());
  }
  return notes;
}

/// Reads the notes of the dataset "data" in a group that has a dataset of coordinates for each axis.
AxisNotes ReadEmd(hid_t file, hid_t dataset, const std::vector<hsize_t>& shape)
{
  AxisNotes notes;
  const HdfHandle group(H5Gopen2(file, GetGroupPath(dataset).c_str(), H5P_DEFAULT), &H5Gclose);
  if (!group.IsOpen() || H5Aexists(group.Get(), "emd_group_type") <= 0)
  {
    return notes;
  }
  // Version 1.0 counts from 0.
  const int first = H5Lexists(group.Get(), "dim0", H5P_DEFAULT) > 0 ? 0 : 1;
  for (std::size_t axis = 0; axis < shape.size(); ++axis)
  {
    const std::string name = "dim" + std::to_string(first + static_cast<int>(axis));
    AxisNote note;
    if (H5Lexists(group.Get(), name.c_str(), H5P_DEFAULT) > 0)
    {
      note.Coordinates = ReadCoordinates(group.Get(), name.c_str(), shape[axis]);
      const HdfHandle values = OpenHdfDataset(group.Get(), name);
      if (values.IsOpen())
      {
        note.Name = ReadHdfText(values.Get(), "name");
        note.Unit = ReadHdfText(values.Get(), "units");
        // "[n_m]" is a nanometer.
        note.Unit.erase(
          std::remove_if(note.Unit.begin(), note.Unit.end(),
            [](char letter) { return letter == '[' || letter == ']' || letter == '_'; }),
          note.Unit.end());
      }
    }
    notes.push_back(std::move(note));
  }
  const bool areNamed = std::any_of(
    notes.begin(), notes.end(), [](const AxisNote& note) { return !note.Name.empty(); });
  for (std::size_t axis = 0; axis < 3 && notes.size() == 3 && !areNamed; ++axis)
  {
    notes[axis].Name =
      std::string(1, "xyz"[axis]); // as programs for electron microscopes take them
  }
  return notes;
}

/// By netCDF-4, h5netcdf and h5py's make_scale.
AxisNotes ReadScales(hid_t file, hid_t dataset, const std::vector<hsize_t>& shape)
{
  AxisNotes notes;
  std::vector<std::string> scales = FindHdfScales(file, dataset, shape.size());
  std::vector<std::string> labels = ReadHdfTexts(dataset, "DIMENSION_LABELS");
  if (scales.empty() && labels.empty())
  {
    return notes;
  }
  scales.resize(shape.size());
  labels.resize(shape.size());
  for (std::size_t axis = 0; axis < shape.size(); ++axis)
  {
    AxisNote note;
    note.Name = labels[axis];
    const HdfHandle scale = scales[axis].empty() ? HdfHandle() : OpenHdfDataset(file, scales[axis]);
    if (scale.IsOpen())
    {
      note.Name = GetLastWord(scales[axis]);
      const bool isEmpty =
        ReadHdfText(scale.Get(), "NAME").rfind("This is a netCDF dimension but not", 0) == 0;
      note.Coordinates =
        isEmpty ? std::vector<double>() : ReadCoordinates(file, scales[axis].c_str(), shape[axis]);
      note.Unit = ReadHdfText(scale.Get(), "units");
      const std::string letter = ReadHdfText(scale.Get(), "axis"); // CF: X, Y, Z or T
      note.Name = letter.size() == 1 ? letter : note.Name;
      TakeUpDown(ReadHdfText(scale.Get(), "positive"), note);
    }
    notes.push_back(std::move(note));
  }
  return notes;
}

} // namespace

AxisNotes ReadHdfNotes(hid_t file, hid_t dataset, std::vector<std::string>& warnings)
{
  const std::vector<hsize_t> shape = GetHdfShape(dataset);
  if (shape.size() < 3)
  {
    return {};
  }
  AxisNotes notes = ReadOpenPmd(file, dataset, shape, warnings);
  notes = notes.empty() ? ReadEmd(file, dataset, shape) : std::move(notes);
  notes = notes.empty() ? ReadScales(file, dataset, shape) : std::move(notes);
  const std::string group = GetGroupPath(dataset);
  WarnOfOtherPlaces([=](const char* name) { return ReadHdfText(dataset, name); },
    [&](const std::string& name)
    {
      const HdfHandle beside = OpenHdfDataset(file, group + name);
      return beside.IsOpen() ? GetHdfShape(beside.Get()).size() : 0;
    },
    warnings);
  const bool isPlaced = std::any_of(notes.begin(), notes.end(),
    [](const AxisNote& note)
    { return !note.Coordinates.empty() || note.Spacing != 1.0 || note.Origin != 0.0; });
  if (!isPlaced)
  {
    notes.resize(shape.size());
    HdfAxes axes;
    const AxisNotes named = notes;
    if (axes.Find(shape, HdfAxes::Kind::Unknown, named))
    {
      TakeVoxelSize(
        [&](const char* name) { return ReadHdfNumbers(dataset, name); }, notes, axes.Space);
    }
  }
  return notes;
}

} // namespace vol
