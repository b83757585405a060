// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/hdf/OpenPmdSteps.h"

#include "DSMVolumeFiles/base/SmallFile.h"
#include "DSMVolumeFiles/hdf/HdfOrigins.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace vol
{

namespace
{

/// The place of a mesh in a file.
struct MeshPlace
{
  std::uint64_t Iteration;
  std::string Group; ///< of the iteration
  std::string Name;  ///< in it
};

/// `dataset`: path in the file. `base`: the part of basePath before the iteration's number.
std::optional<MeshPlace> FindPlace(
  const std::string& dataset, const std::string& base, const std::string& meshes)
{
  const std::size_t first = base.size();
  const std::size_t end = dataset.find('/', first);
  constexpr std::size_t mostDigits = 19; // of a 64-bit number
  if (dataset.compare(0, first, base) != 0 || end == std::string::npos || end == first ||
    end - first > mostDigits || dataset.find_first_not_of("0123456789", first) != end)
  {
    return std::nullopt;
  }
  const bool isMesh = !meshes.empty() && dataset.compare(end + 1, meshes.size(), meshes) == 0;
  return MeshPlace{ std::stoull(dataset.substr(first, end - first)), dataset.substr(0, end),
    dataset.substr(end + 1 + (isMesh ? meshes.size() : 0)) };
}

/// Returns the times of the iterations in seconds, by their numbers; none where one has no time, or they do not rise.
std::vector<double> ReadTimes(hid_t file, const std::map<std::uint64_t, std::string>& iterations,
  std::vector<std::string>& warnings)
{
  AxisNote note;
  note.Name = "time";
  for (const auto& [number, path] : iterations)
  {
    const HdfHandle group(H5Gopen2(file, path.c_str(), H5P_DEFAULT), &H5Gclose);
    const std::vector<double> time = ReadHdfNumbers(group.Get(), "time");
    const std::vector<double> seconds = ReadHdfNumbers(group.Get(), "timeUnitSI");
    if (time.size() != 1)
    {
      return {};
    }
    note.Coordinates.push_back(time.front() * (seconds.size() == 1 ? seconds.front() : 1.0));
  }
  return FindTimes(note, static_cast<int>(iterations.size()), warnings);
}

/// Volumes with time steps of their own cannot be shown beside the iterations if the numbers of both differ.
void LeaveOutOthersInTime(std::size_t iterations, HdfVolumes& volumes)
{
  const auto first = std::stable_partition(volumes.Found.begin(), volumes.Found.end(),
    [=](const HdfVolume& one) { return one.Axes.Frames == 0 || one.Axes.Frames == iterations; });
  for (auto volume = first; volume != volumes.Found.end(); ++volume)
  {
    volumes.Warnings.push_back("has array " + Quote(volume->Name) + " with " +
      std::to_string(volume->Axes.Frames) + " time steps beside " + std::to_string(iterations) +
      " iterations. It is not shown. To show it, give its dataset " +
      Quote(volume->Datasets.front()) + ".");
  }
  volumes.Found.erase(first, volumes.Found.end());
}

bool IsSameNote(const AxisNote& a, const AxisNote& b)
{
  return a.Origin == b.Origin && a.Spacing == b.Spacing;
}

} // namespace

void JoinOpenPmdSteps(hid_t file, HdfVolumes& volumes)
{
  const std::string path = ReadHdfText(file, "basePath");
  const std::size_t wildcard = path.find("%T");
  if (ReadHdfText(file, "openPMD").empty() || wildcard == std::string::npos)
  {
    return;
  }
  const std::size_t slashes = std::min(path.find_first_not_of('/'), wildcard);
  const std::string base = path.substr(slashes, wildcard - slashes);
  const std::string meshes = ReadHdfText(file, "meshesPath");
  std::map<std::uint64_t, std::string> iterations;
  std::map<std::string, std::map<std::uint64_t, HdfVolume>> found;
  std::vector<HdfVolume> others;
  for (HdfVolume& volume : volumes.Found)
  {
    const std::optional<MeshPlace> place = FindPlace(volume.Name, base, meshes);
    // Another mesh may have the name already: one lies in the group of meshes, one beside it.
    if (!place || !found[place->Name].try_emplace(place->Iteration, std::move(volume)).second)
    {
      others.push_back(std::move(volume));
      continue;
    }
    iterations[place->Iteration] = place->Group;
  }
  volumes.Found = std::move(others);
  for (auto& [name, steps] : found)
  {
    HdfVolume joined = steps.begin()->second;
    joined.Name = name;
    joined.Datasets.clear();
    bool isAlike = steps.size() == iterations.size();
    bool moves = false;
    for (const auto& [iteration, step] : steps)
    {
      joined.Datasets.push_back(step.Datasets.front());
      isAlike = isAlike && step.Axes.Order == joined.Axes.Order &&
        step.Axes.Lengths == joined.Axes.Lengths && step.Axes.Space == joined.Axes.Space &&
        step.Axes.Component == joined.Axes.Component && step.Member == joined.Member &&
        (iterations.size() == 1 || step.Axes.Frames == 0);
      moves = moves ||
        !std::equal(step.Notes->begin(), step.Notes->end(), joined.Notes->begin(),
          joined.Notes->end(), &IsSameNote);
    }
    if (!isAlike)
    {
      const bool isEverywhere = steps.size() == iterations.size();
      volumes.Warnings.push_back("has array " + Quote(name) +
        (isEverywhere ? " with different axes or components in its iterations"
                      : " in " + std::to_string(steps.size()) + " of " +
              std::to_string(iterations.size()) + " iterations only") +
        ". It is not shown. To show it, give one of its datasets, such as " +
        Quote(joined.Datasets.front()) + ".");
      continue;
    }
    if (moves)
    {
      joined.Warnings.push_back("has array " + Quote(name) +
        " at positions that differ between iterations. All iterations are shown at those of the "
        "first one.");
    }
    volumes.Found.push_back(std::move(joined));
  }
  if (iterations.size() > 1)
  {
    LeaveOutOthersInTime(iterations.size(), volumes);
    volumes.Steps = static_cast<int>(iterations.size());
    volumes.Times = ReadTimes(file, iterations, volumes.Warnings);
    volumes.Missing = "mesh that all iterations have in one form. Give one of its datasets.";
  }
}

} // namespace vol
