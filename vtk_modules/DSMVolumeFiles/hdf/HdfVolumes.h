// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_HdfVolumes_h
#define vol_HdfVolumes_h

#include "DSMVolumeFiles/format/AxisNotes.h"
#include "DSMVolumeFiles/format/VolumeShape.h"
#include "DSMVolumeFiles/hdf/HdfAxes.h"
#include "DSMVolumeFiles/hdf/HdfLibrary.h"

#include <memory>
#include <string>
#include <vector>

namespace vol
{

/// A volume in a dataset, and what is known of its axes.
struct HdfVolume
{
  /// Path in the file, or in each iteration of an openPMD file; of a member with "/" and its name
  /// behind it, of several volumes in a dataset with a blank and a number.
  std::string Name;
  std::vector<std::string> Datasets; ///< paths in the file: of all steps, or one of each
  std::string Member;                ///< see HdfValues
  HdfAxes Axes;
  std::shared_ptr<const AxisNotes> Notes; ///< volumes of one dataset share them
  std::vector<std::string> Warnings;      ///< as VolumeFile has them
};

/// The volumes of the largest shape in a file that is not VTKHDF.
struct HdfVolumes
{
  VolumeShape Shape;
  std::vector<HdfVolume> Found;
  int Steps = 1;
  std::vector<double> Times;         ///< of the steps; empty: as the axes tell
  std::vector<std::string> Warnings; ///< as VolumeFile has them
  std::string Missing; ///< what there must be, where none is found, as the end of a sentence

  /// `wanted`: the path of a dataset; empty: all are looked at. Throws dsm::Error, which names the file, where an
  /// axis is too long. The caller has GetHdfLock.
  static HdfVolumes Find(hid_t file, const std::string& path, const std::string& wanted);
};

} // namespace vol

#endif
