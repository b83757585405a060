// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMKnownBounds_h
#define vtkDSMKnownBounds_h

#include "vtkType.h"

class vtkAlgorithm;

/// The bounds of all ranks' data that a scene has told a mapper, for as long as they are those of the
/// mapper's input. Local.
class vtkDSMKnownBounds
{
public:
  vtkDSMKnownBounds();

  /// Sets the bounds of the mapper's current data.
  void Set(vtkAlgorithm* mapper, const double bounds[6]);

  /// Null when there are none, or when the mapper's input is other than it was: other data, or a change
  /// to them or to the pipeline that makes them. With several pieces the last ones stay until the scene
  /// knows better: this rank's part would be less.
  const double* Get(vtkAlgorithm* mapper, int pieces) const;

  void Clear();

  /// Returns whether the pipeline in front of a mapper has changed since it produced the mapper's
  /// data.
  static bool IsOutOfDate(vtkAlgorithm* mapper);

private:
  double Bounds[6];
  const void* Data = nullptr; ///< never read
  vtkMTimeType Time = 0;
};

#endif
