// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_ZarrGroup_h
#define vol_ZarrGroup_h

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace vol
{

class ZarrStore;

/// The contents of a folder of Zarr. All functions throw dsm::Error, which names a folder.
namespace ZarrGroup
{

/// Opens only what lies in the folder: a name in its metadata may lead elsewhere.
std::string JoinInside(const std::string& folder, const std::string& name);

/// Returns the names of the arrays in a group that have the largest shape, and a time axis of one
/// length or none; ascending. `refused`: why another array cannot be read; unchanged where all can.
std::vector<std::string> FindArrays(
  const ZarrStore& store, const std::string& folder, std::string& refused);

/// Returns the paths in a folder of groups that can be opened by themselves, at any depth: images
/// of OME-Zarr, and groups of arrays of three axes; ascending. So it finds the images of a plate,
/// of a container (bioformats2raw) and of labels.
std::vector<std::string> FindInner(const ZarrStore& store, const std::string& folder);

/// Returns what OME-Zarr says in the attributes of a group: since 0.5 it has a member of its own.
const nlohmann::json& FindOme(const nlohmann::json& attributes);

/// Returns names for the elements of an image's "multiscales": their own, or else "multiscales/1"
/// and so on.
std::vector<std::string> NameScales(const std::string& folder, const nlohmann::json& scales);

} // namespace ZarrGroup

} // namespace vol

#endif
