// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_ArrayStep_h
#define vol_ArrayStep_h

#include "DSMVolumeFiles/format/VolumeFile.h"

#include <cstddef>
#include <memory>

namespace vol
{

/// An array of a file at a time step. Keeps the file open.
struct ArrayStep
{
  std::shared_ptr<const VolumeFile> File;
  std::size_t Array = 0;
  int Step = 0;

  const FileArray& Get() const { return this->File->GetArrays()[this->Array]; }
};

} // namespace vol

#endif
