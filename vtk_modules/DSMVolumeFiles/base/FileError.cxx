// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/base/FileError.h"

#include <utility>

namespace vol
{

namespace
{

std::string Describe(const FileError::Place& place)
{
  const std::string path = "'" + place.Path + "'";
  if (place.Array.empty())
  {
    return path;
  }
  const std::string array = "array '" + place.Array + "' in " + path;
  if (!place.Chunk)
  {
    return "The " + array;
  }
  const bricks::Index3& chunk = *place.Chunk;
  return "Chunk (" + std::to_string(chunk.x) + ", " + std::to_string(chunk.y) + ", " +
    std::to_string(chunk.z) + ") of the " + array;
}

} // namespace

FileError::FileError(Place place, const std::string& what)
  : dsm::Error(Describe(place) + " " + what)
  , Where(std::move(place))
{
}

FileError::FileError(const std::string& path, const std::string& what)
  : FileError(Place{ path, {}, {} }, what)
{
}

FileError::FileError(Place place, const dsm::Error& cause)
  : FileError(std::move(place), "cannot be read: " + std::string(cause.what()))
{
}

} // namespace vol
