// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/format/HdfVolumes.h"

#include "DSMVolumeFiles/format/HdfNotes.h"
#include "DSMVolumeFiles/format/HdfOrigins.h"
#include "DSMVolumeFiles/format/HdfValues.h"
#include "DSMVolumeFiles/format/OpenPmdSteps.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace vol
{

namespace
{

/// `others`: datasets of numbers that are no volumes, with their shapes.
std::string DescribeMissing(
  hid_t file, const std::string& wanted, const std::vector<std::string>& others, bool isDamaged)
{
  const std::string shapes = others.empty()
    ? std::string()
    : " A volume has numbers along three axes (z, y, x). It may have a first axis of time steps, "
      "others of length 1, and a last axis of components. Datasets of numbers: " +
      others.front() +
      (others.size() > 1 ? " and " + std::to_string(others.size() - 1) + " more." : ".");
  if (wanted.empty())
  {
    return std::string("numeric dataset with three axes") +
      (isDamaged ? " that can be read: an object in it is damaged." : ".") + shapes;
  }
  return OpenHdfDataset(file, wanted).IsOpen()
    ? "volume in its dataset '" + wanted + "'." + shapes
    : "dataset '" + wanted + "'. Valid datasets: " + ListHdfNames(FindHdfDatasets(file));
}

} // namespace

HdfVolumes HdfVolumes::Find(hid_t file, const std::string& path, const std::string& wanted)
{
  bool isDamaged = false;
  const std::vector<std::string> names =
    wanted.empty() ? FindHdfDatasets(file, &isDamaged) : std::vector<std::string>{ wanted };
  HdfVolumes volumes;
  if (isDamaged)
  {
    volumes.Warnings.push_back("has an object that cannot be read: the file is damaged. Datasets "
                               "that come after it are not shown.");
  }
  std::vector<std::string> others;
  for (const std::string& name : names)
  {
    const HdfHandle dataset = OpenHdfDataset(file, name);
    if (!dataset.IsOpen() || !FindHdfValues(dataset.Get()))
    {
      continue;
    }
    const std::vector<hsize_t> shape = GetHdfShape(dataset.Get());
    HdfVolume volume;
    volume.Name = name;
    volume.Datasets = { name };
    volume.Notes = ReadHdfNotes(file, dataset.Get(), volume.Warnings);
    std::string tooLong;
    if (volume.Axes.Find(shape, HdfAxes::Kind::Unknown, volume.Notes, &tooLong))
    {
      const VolumeShape own = volume.Axes.GetShape();
      volumes.Shape = own.IsLargerThan(volumes.Shape) ? own : volumes.Shape;
      volumes.Found.push_back(std::move(volume));
    }
    else if (!tooLong.empty() && names.size() == 1)
    {
      HdfAxes::RefuseLength(path, name, tooLong);
    }
    else
    {
      others.push_back("'" + name + "' (" + DescribeHdfShape(shape) + ")");
    }
  }
  auto& found = volumes.Found;
  found.erase(
    std::remove_if(found.begin(), found.end(),
      [&](const HdfVolume& one) { return !one.Axes.GetShape().BelongsTo(volumes.Shape); }),
    found.end());
  volumes.Missing = DescribeMissing(file, wanted, others, isDamaged);
  volumes.Steps = static_cast<int>(std::max<std::int64_t>(1, volumes.Shape.Times));
  if (wanted.empty())
  {
    JoinOpenPmdSteps(file, volumes);
  }
  std::sort(found.begin(), found.end(),
    [](const HdfVolume& a, const HdfVolume& b) { return a.Name < b.Name; });
  return volumes;
}

} // namespace vol
