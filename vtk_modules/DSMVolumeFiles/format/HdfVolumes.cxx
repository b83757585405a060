// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/format/HdfVolumes.h"

#include "DSMVolumeFiles/format/HdfNotes.h"
#include "DSMVolumeFiles/format/HdfOrigins.h"
#include "DSMVolumeFiles/format/HdfValues.h"
#include "DSMVolumeFiles/format/ImarisVolumes.h"
#include "DSMVolumeFiles/format/OpenPmdSteps.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace vol
{

namespace
{

/// Datasets that make no volume, for messages.
struct OtherDatasets
{
  std::vector<std::string> OfNumbers; ///< with their shapes
  std::vector<std::string> Closed;    ///< names of those that cannot be opened
  bool AreAll = true; ///< else an object cannot be read, and those after it are not known

  /// What is wrong with the file; empty: nothing.
  std::string DescribeDamage() const
  {
    const std::string closed = this->Closed.empty()
      ? std::string()
      : "datasets that HDF5 cannot open, which are damaged or in files that do not exist: " +
        ListHdfNames(this->Closed);
    return this->AreAll ? closed
                        : "an object that cannot be read, so that the file is damaged. Datasets "
                          "after it are not shown.";
  }

  /// As HdfVolumes::Missing.
  std::string DescribeMissing(hid_t file, const std::string& wanted) const
  {
    const auto& others = this->OfNumbers;
    const std::string damage = this->DescribeDamage();
    const std::string shapes = (damage.empty() ? std::string() : " It has " + damage) +
      (others.empty()
          ? std::string()
          : " A volume has numbers along three axes (z, y, x). It may have a first axis of time "
            "steps, others of length 1, and a last axis of components. Datasets of numbers: " +
            others.front() +
            (others.size() > 1 ? " and " + std::to_string(others.size() - 1) + " more." : "."));
    if (wanted.empty())
    {
      return "numeric dataset with three axes." + shapes;
    }
    return OpenHdfDataset(file, wanted).IsOpen()
      ? "volume in its dataset '" + wanted + "'." + shapes
      : "dataset '" + wanted + "'. Valid datasets: " + ListHdfNames(FindHdfDatasets(file));
  }
};

} // namespace

HdfVolumes HdfVolumes::Find(hid_t file, const std::string& path, const std::string& wanted)
{
  OtherDatasets others;
  const std::vector<std::string> names =
    wanted.empty() ? FindHdfDatasets(file, &others.AreAll) : std::vector<std::string>{ wanted };
  HdfVolumes volumes;
  for (const std::string& name : names)
  {
    const HdfHandle dataset = OpenHdfDataset(file, name);
    if (!dataset.IsOpen() && !OpenHdfObject(file, name).IsOpen())
    {
      others.Closed.push_back(name);
    }
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
      others.OfNumbers.push_back("'" + name + "' (" + DescribeHdfShape(shape) + ")");
    }
  }
  auto& found = volumes.Found;
  found.erase(
    std::remove_if(found.begin(), found.end(),
      [&](const HdfVolume& one) { return !one.Axes.GetShape().BelongsTo(volumes.Shape); }),
    found.end());
  volumes.Missing = others.DescribeMissing(file, wanted);
  const std::string damage = others.DescribeDamage();
  if (!damage.empty())
  {
    volumes.Warnings.push_back("has " + damage);
  }
  volumes.Steps = static_cast<int>(std::max<std::int64_t>(1, volumes.Shape.Times));
  if (wanted.empty())
  {
    JoinOpenPmdSteps(file, volumes);
  }
  PlaceImaris(file, volumes, wanted.empty());
  std::sort(found.begin(), found.end(),
    [](const HdfVolume& a, const HdfVolume& b) { return a.Name < b.Name; });
  return volumes;
}

} // namespace vol
