// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/hdf/ImarisVolumes.h"

#include "DSMVolumeFiles/base/SmallFile.h"
#include "DSMVolumeFiles/hdf/HdfOrigins.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace vol
{

namespace
{

/// Attributes are arrays of characters.
std::string ReadText(const HdfHandle& object, const std::string& name)
{
  const std::vector<std::string> letters =
    object.IsOpen() ? ReadHdfTexts(object.Get(), name.c_str()) : std::vector<std::string>();
  return std::accumulate(letters.begin(), letters.end(), std::string());
}

std::optional<double> ReadNumber(const HdfHandle& object, const std::string& name)
{
  const std::string text = ReadText(object, name);
  double number = 0.0;
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), number);
  return parsed.ec == std::errc() && std::isfinite(number) ? std::optional<double>(number)
                                                           : std::nullopt;
}

/// Numbers in "DataSet/ResolutionLevel 0/TimePoint 0/Channel 0/Data".
struct DataPlace
{
  int Level = 0;
  int Time = 0;
  int Channel = 0;

  static std::optional<DataPlace> Find(const std::string& dataset)
  {
    DataPlace place;
    int end = 0;
    const std::string path =
      dataset.substr(std::min(dataset.size(), dataset.find_first_not_of('/')));
    // Of more digits, the number would be undefined.
    std::sscanf(path.c_str(), "DataSet/ResolutionLevel %9d/TimePoint %9d/Channel %9d/Data%n",
      &place.Level, &place.Time, &place.Channel, &end);
    return end != 0 && static_cast<std::size_t>(end) == path.size() &&
        std::min({ place.Level, place.Time, place.Channel }) >= 0
      ? std::optional<DataPlace>(place)
      : std::nullopt;
  }
};

/// Returns whether the chunks of a dataset stay numbered as they are when it is cut to so many
/// samples.
bool CanCut(hid_t file, const HdfVolume& volume, const bricks::Index3& samples)
{
  const HdfHandle dataset = OpenHdfDataset(file, volume.Name);
  const HdfHandle properties(H5Dget_create_plist(dataset.Get()), &H5Pclose);
  hsize_t edges[3] = { 0, 0, 0 }; // of z, y, x
  if (H5Pget_layout(properties.Get()) != H5D_CHUNKED ||
    H5Pget_chunk(properties.Get(), 3, edges) != 3)
  {
    return false;
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    const auto edge = static_cast<std::int64_t>(edges[2 - axis]);
    if (edge < 1 || (samples[axis] - 1) / edge != (volume.Axes.Samples[axis] - 1) / edge)
    {
      return false;
    }
  }
  return true;
}

void Place(hid_t file, const HdfHandle& image, int level, HdfVolume& volume)
{
  const std::string group = volume.Name.substr(0, volume.Name.rfind('/'));
  const HdfHandle channel(H5Gopen2(file, group.c_str(), H5P_DEFAULT), &H5Gclose);
  bricks::Index3 samples = volume.Axes.Samples;
  AxisNotes notes(3);
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::string letter(1, "XYZ"[axis]);
    std::optional<double> size = ReadNumber(channel, "ImageSize" + letter);
    size = size || level > 0 ? size : ReadNumber(image, letter);
    samples[axis] =
      size ? ToInteger(*size, 1, samples[axis]).value_or(samples[axis]) : samples[axis];
    const std::string number = std::to_string(axis);
    const std::optional<double> least = ReadNumber(image, "ExtMin" + number);
    const std::optional<double> most = ReadNumber(image, "ExtMax" + number);
    AxisNote& note = notes[static_cast<std::size_t>(2 - axis)];
    note.Name = letter;
    note.Unit = ReadText(image, "Unit");
    if (least && most && *most > *least)
    {
      note.Spacing = (*most - *least) / static_cast<double>(samples[axis]);
      note.Origin = *least + 0.5 * note.Spacing;
    }
  }
  volume.Notes = std::make_shared<const AxisNotes>(std::move(notes));
  if (samples != volume.Axes.Samples && CanCut(file, volume, samples))
  {
    volume.Axes.Samples = samples;
  }
  else if (samples != volume.Axes.Samples)
  {
    volume.Warnings.push_back("has more samples in " + Quote(volume.Name) + " than its image of " +
      DescribeShape(samples) + ". They are shown, too.");
  }
}

/// Joins the datasets of each channel, by their time points.
void Join(HdfVolumes& volumes)
{
  std::map<int, std::map<int, HdfVolume>> channels;
  std::size_t steps = 1;
  for (HdfVolume& volume : volumes.Found)
  {
    const std::optional<DataPlace> place = DataPlace::Find(volume.Name);
    if (place && place->Level == 0)
    {
      auto& channel = channels[place->Channel];
      channel.emplace(place->Time, std::move(volume));
      steps = std::max(steps, channel.size());
    }
  }
  if (channels.empty())
  {
    return;
  }
  volumes.Shape = channels.begin()->second.begin()->second.Axes.GetShape();
  volumes.Found.clear();
  for (auto& [number, times] : channels)
  {
    HdfVolume joined = std::move(times.begin()->second);
    joined.Name = "Channel " + std::to_string(number);
    bool isAlike = times.size() == steps && joined.Axes.Samples == volumes.Shape.Samples;
    for (auto time = std::next(times.begin()); time != times.end(); ++time)
    {
      isAlike = isAlike && time->second.Axes.Samples == joined.Axes.Samples;
      joined.Datasets.push_back(time->second.Datasets.front());
    }
    if (isAlike)
    {
      volumes.Found.push_back(std::move(joined));
    }
    else
    {
      volumes.Warnings.push_back("has " + Quote(joined.Name) +
        " with other sizes or time points than the rest. It is not shown.");
    }
  }
  volumes.Steps = static_cast<int>(steps);
}

} // namespace

void PlaceImaris(hid_t file, HdfVolumes& volumes, bool isWhole)
{
  const char* const name = "DataSetInfo/Image";
  if (H5Lexists(file, "DataSetInfo", H5P_DEFAULT) <= 0 || H5Lexists(file, name, H5P_DEFAULT) <= 0)
  {
    return;
  }
  const HdfHandle image(H5Gopen2(file, name, H5P_DEFAULT), &H5Gclose);
  for (HdfVolume& volume : volumes.Found)
  {
    const std::optional<DataPlace> place = DataPlace::Find(volume.Name);
    if (place)
    {
      Place(file, image, place->Level, volume);
      volumes.Shape = volume.Axes.GetShape();
    }
  }
  if (isWhole)
  {
    Join(volumes);
  }
}

} // namespace vol
