// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_FileError_h
#define vol_FileError_h

#include "DSMBricks/base/Box.h"
#include "DSMCore/base/Error.h"

#include <optional>
#include <string>

namespace vol
{

/// Error in a file, or in a folder of files, with its place. Only this class words the place.
class FileError final : public dsm::Error
{
public:
  struct Place
  {
    std::string Path;
    std::string Array; ///< empty: the entire file
    std::optional<bricks::Index3>
      Chunk; ///< in chunks from the array's first; none: the entire array
  };

  /// `what`: the rest of the sentence that begins with the place, such as "is empty."
  FileError(Place place, const std::string& what);
  FileError(const std::string& path, const std::string& what);
  /// The place cannot be read for a reason that does not name it.
  FileError(Place place, const dsm::Error& cause);

  const Place& GetPlace() const { return this->Where; }

private:
  Place Where;
};

} // namespace vol

#endif
