// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/hdf/HdfVolumes.h"

#include "DSMVolumeFiles/base/SmallFile.h"
#include "DSMVolumeFiles/hdf/HdfNotes.h"
#include "DSMVolumeFiles/hdf/HdfOrigins.h"
#include "DSMVolumeFiles/hdf/HdfValues.h"
#include "DSMVolumeFiles/hdf/ImarisVolumes.h"
#include "DSMVolumeFiles/hdf/OpenPmdSteps.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>

namespace vol
{

namespace
{

/// Datasets that make no volume, for messages.
struct OtherDatasets
{
  std::map<hsize_t, std::string> OfNumbers; ///< with their axes, by the number of values
  std::size_t CountOfNumbers = 0;
  std::vector<std::string> OfTypes; ///< names of those of three axes and more, and their types
  std::vector<std::string> Types;
  std::vector<std::string> Closed; ///< names of those that cannot be opened
  bool AreAll = true; ///< else an object cannot be read, and those after it are not known

  void Add(const std::string& name, const std::vector<hsize_t>& shape, const AxisNotes& notes)
  {
    const hsize_t count =
      MultiplyWithin(FileLimits::ArrayBytes, shape).value_or(FileLimits::ArrayBytes);
    std::string names;
    for (const AxisNote& note : notes)
    {
      names += (names.empty() ? "" : ", ") + (note.Name.empty() ? "no name" : Quote(note.Name));
    }
    const bool areNamed = std::any_of(
      notes.begin(), notes.end(), [](const AxisNote& note) { return !note.Name.empty(); });
    this->OfNumbers.try_emplace(
      count, "'" + name + "' (" + DescribeHdfShape(shape) + (areNamed ? "; " + names : "") + ")");
    ++this->CountOfNumbers;
  }
  /// The fault of the file; empty: it has none.
  std::string DescribeDamage() const
  {
    const std::string closed = this->Closed.empty()
      ? std::string()
      : "datasets that HDF5 cannot open, which are damaged or in files that do not exist: " +
        ListNames(this->Closed);
    return this->AreAll ? closed
                        : "an object that cannot be read, so that the file is damaged. Datasets "
                          "after it are not shown.";
  }
  /// Likewise, what is not shown.
  std::string DescribeTypes() const
  {
    return this->OfTypes.empty() ? std::string()
                                 : "datasets that are not shown because their values are not "
                                   "numbers. Write them as numbers: " +
        ListNames(this->OfTypes, this->Types);
  }

  /// As HdfVolumes::Missing.
  std::string DescribeMissing(hid_t file, const std::string& wanted) const
  {
    const auto& others = this->OfNumbers;
    const std::string damage = this->DescribeDamage();
    const std::string types = this->DescribeTypes();
    const std::string shapes = (damage.empty() ? std::string() : " It has " + damage) +
      (types.empty() ? std::string() : " It has " + types) +
      (others.empty()
          ? std::string()
          : " A volume has numbers along three axes (z, y, x). It may have a first axis of time "
            "steps, others of length 1, and a last axis of components. Further axes need names: "
            "in h5py, for example, dataset.dims[0].label = 'time', and 'c', 'z', 'y', 'x' of the "
            "others. Datasets of numbers: " +
            others.rbegin()->second +
            (this->CountOfNumbers > 1
                ? " and " + std::to_string(this->CountOfNumbers - 1) + " more."
                : "."));
    if (wanted.empty())
    {
      return "numeric dataset with three axes." + shapes;
    }
    return OpenHdfDataset(file, wanted).IsOpen()
      ? "volume in its dataset '" + wanted + "'." + shapes
      : "dataset '" + wanted + "'. Valid datasets: " + ListNames(FindHdfDatasets(file));
  }
};

/// Adds a volume for each member of a dataset's values, and each position along its further axes.
void AddEach(const std::vector<HdfValues>& values, const std::vector<HdfAxes>& places,
  const HdfVolume& dataset, std::vector<HdfVolume>& found)
{
  for (const HdfValues& one : values)
  {
    for (std::size_t place = 0; place < places.size(); ++place)
    {
      HdfVolume volume = dataset;
      volume.Member = one.Member;
      volume.Name += one.Member.empty() ? "" : "/" + one.Member;
      volume.Name += places.size() == 1 ? "" : " " + std::to_string(place);
      volume.Axes = places[place];
      found.push_back(std::move(volume));
    }
  }
}

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
    if (!dataset.IsOpen())
    {
      continue;
    }
    const std::vector<hsize_t> shape = GetHdfShape(dataset.Get());
    const std::vector<HdfValues> values = FindHdfValues(dataset.Get());
    if (values.empty())
    {
      if (shape.size() >= 3)
      {
        others.OfTypes.push_back(name);
        others.Types.push_back(DescribeHdfType(dataset.Get()));
      }
      continue;
    }
    HdfVolume volume;
    volume.Name = name;
    volume.Datasets = { name };
    volume.Notes =
      std::make_shared<const AxisNotes>(ReadHdfNotes(file, dataset.Get(), volume.Warnings));
    std::string tooLong;
    if (volume.Axes.Find(shape, HdfAxes::Kind::Unknown, *volume.Notes, &tooLong))
    {
      const VolumeShape own = volume.Axes.GetShape();
      volumes.Shape = own.IsLargerThan(volumes.Shape) ? own : volumes.Shape;
      const std::vector<HdfAxes> places = volume.Axes.Split();
      CheckLimit(
        path, "arrays", volumes.Found.size() + values.size() * places.size(), FileLimits::Arrays);
      AddEach(values, places, volume, volumes.Found);
    }
    else if (!tooLong.empty() && names.size() == 1)
    {
      HdfAxes::RefuseLength(path, name, tooLong);
    }
    else
    {
      others.Add(name, shape, *volume.Notes);
    }
  }
  auto& found = volumes.Found;
  found.erase(
    std::remove_if(found.begin(), found.end(),
      [&](const HdfVolume& one) { return !one.Axes.GetShape().BelongsTo(volumes.Shape); }),
    found.end());
  volumes.Missing = others.DescribeMissing(file, wanted);
  for (const std::string& what : { others.DescribeDamage(), others.DescribeTypes() })
  {
    if (!what.empty())
    {
      volumes.Warnings.push_back("has " + what);
    }
  }
  volumes.Steps = static_cast<int>(std::max<std::int64_t>(1, volumes.Shape.Times));
  if (wanted.empty())
  {
    JoinOpenPmdSteps(file, volumes);
  }
  PlaceImaris(file, volumes, wanted.empty());
  std::stable_sort(found.begin(), found.end(),
    [](const HdfVolume& a, const HdfVolume& b) { return a.Datasets.front() < b.Datasets.front(); });
  return volumes;
}

} // namespace vol
