// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMVolumeSettings_h
#define vtkDSMVolumeSettings_h

#include "vtkDSMBlockLooks.h" // for ivars
#include "vtkSmartPointer.h"  // for ivars
#include "vtkType.h"          // for ivars

#include <string>  // for ivars
#include <utility> // for ivars
#include <vector>  // for ivars

class vtkDSMLightOptions;
class vtkDSMMemoryOptions;
class vtkPiecewiseFunction;
class vtkPlaneCollection;
class vtkProperty;
class vtkScalarsToColors;

/// Single values among the settings of a vtkDSMVolumeMapper: name, type and default, in the order in which they are
/// printed.
#define VTK_DSM_VOLUME_SETTINGS(X)                                                                 \
  X(IsoArray, std::string, "")                                                                     \
  X(IsoArrayOnCells, bool, false)                                                                  \
  X(IsoComponent, int, 0)                                                                          \
  X(AutomaticIsoValue, bool, false)                                                                \
  X(SurfacesOnly, bool, false)                                                                     \
  X(Scattering, double, 0.0)                                                                       \
  X(OpacityArray, std::string, "")                                                                 \
  X(OpacityArrayOnCells, bool, false)                                                              \
  X(OpacityComponent, int, 0)                                                                      \
  X(Transfer2DYAxisArray, std::string, "")                                                         \
  X(Transfer2DYAxisComponent, int, 0)                                                              \
  X(Slicing, bool, false)                                                                          \
  X(SlicePlanes, vtkSmartPointer<vtkPlaneCollection>, {})                                          \
  X(SliceOpacity, vtkSmartPointer<vtkPiecewiseFunction>, {})                                       \
  X(ColorArray, std::string, "")                                                                   \
  X(ColorArrayOnCells, bool, false)                                                                \
  X(MapScalars, bool, true)                                                                        \
  X(ScalarVisibility, bool, false)                                                                 \
  X(BlockScalarVisibility, bool, false)                                                            \
  X(LookupTable, vtkSmartPointer<vtkScalarsToColors>, {})                                          \
  X(SurfaceProperty, vtkSmartPointer<vtkProperty>, {})                                             \
  X(BackfaceProperty, vtkSmartPointer<vtkProperty>, {})                                            \
  X(LightOptions, vtkSmartPointer<vtkDSMLightOptions>, {})                                         \
  X(MemoryOptions, vtkSmartPointer<vtkDSMMemoryOptions>, {})                                       \
  X(MakesScene, bool, true)                                                                        \
  VTK_DSM_KEPT_SETTINGS(X)
/// Settings of vtkGPUVolumeRayCastMapper and vtkAMRVolumeMapper. The mapper keeps them without effect.
#define VTK_DSM_KEPT_SETTINGS(X)                                                                   \
  X(AutoAdjustSampleDistances, vtkTypeBool, 1)                                                     \
  X(LockSampleDistanceToInputSpacing, vtkTypeBool, 0)                                              \
  X(UseJittering, vtkTypeBool, 0)                                                                  \
  X(SampleDistance, float, 1.0f)                                                                   \
  X(ImageSampleDistance, float, 1.0f)                                                              \
  X(MinimumImageSampleDistance, float, 1.0f)                                                       \
  X(MaximumImageSampleDistance, float, 10.0f)                                                      \
  X(MaxMemoryInBytes, vtkIdType, 0)                                                                \
  X(MaxMemoryFraction, float, 0.75f)                                                               \
  X(ReportProgress, bool, true)                                                                    \
  X(RequestedRenderMode, int, 0)                                                                   \
  X(InterpolationMode, int, VTK_CUBIC_INTERPOLATION)                                               \
  X(RequestedResamplingMode, int, 0)                                                               \
  X(FreezeFocalPoint, bool, false)                                                                 \
  X(ResamplerUpdateTolerance, double, 1e-7)                                                        \
  X(UseDefaultThreading, bool, false)

/// All that a user sets of a vtkDSMVolumeMapper, beside what its base classes have. Settings that displays have as
/// properties are in mapper/properties.cmake.
struct vtkDSMVolumeSettings
{
#define vtkDSMDeclare(name, type, value) type name = value;
  VTK_DSM_VOLUME_SETTINGS(vtkDSMDeclare)
#undef vtkDSMDeclare
  std::vector<double> IsoValues;
  std::vector<std::pair<int, int>> Slices; ///< axis, index; ascending
  vtkDSMBlockLooks BlockLooks;
  int NumberOfSamples[3] = { 128, 128, 128 }; ///< of vtkAMRVolumeMapper; kept without effect
};

#endif
