// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMVolumeLook_h
#define vtkDSMVolumeLook_h

#include "DSMRayTracing/field/Fields.h"
#include "DSMRayTracing/scene/Scene.h"
#include "vtkDSMVolumeData.h"
#include "vtkDSMVolumeMapper.h"

#include <glm/mat4x4.hpp>

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

class vtkDSMVolumeMapper;
class vtkImageData;
class vtkProp3D;
class vtkVolumeProperty;

/// Current settings of a volume's mapper and prop, translated for the ray tracer. Owns neither;
/// local, the same on every rank where they are.
class vtkDSMVolumeLook
{
public:
  vtkDSMVolumeLook(vtkDSMVolumeMapper* mapper, vtkProp3D* prop);

  /// Returns whether isovalues and look come from the volume's property; otherwise they are the
  /// mapper's.
  bool IsLikeRayCastMapper() const;
  /// Returns whether the volume is a medium: its property and blend mode select one, and there are
  /// no isosurfaces and slices.
  bool IsMedium() const;
  /// Returns whether there are slices, or may be, and no isosurfaces.
  bool IsSlicesOnly() const;
  bool HasIsosurfaces() const { return !this->IsMedium() && !this->IsSlicesOnly(); }
  /// Components of the array that a medium shows. One: a single component, or the magnitude.
  /// Independent: each component with its own functions, as a separate medium. Dependent: the first
  /// ones define the colors, the last one the opacities. Refused: nothing is shown, because the
  /// number of components does not fit.
  enum class Components
  {
    One,
    Independent,
    Dependent,
    Refused
  };
  /// `arrays`: those that there are.
  Components GetComponents(const vtkDSMImageArrays& arrays) const;
  /// The grids that have the values of a medium.
  enum class Grids
  {
    Lattices, ///< all are at the points of lattices, or in their cells
    Cells, ///< all are of curvilinear or unstructured grids, where VTK's mappers interpolate in any case
    Others ///< some are on levels, or they are of grids of several kinds
  };
  /// Adds warnings about features that the property requests for the array's components, and media do not have yet.
  void FindMissingFeatures(
    const vtkDSMImageArrays& arrays, Grids grids, std::vector<std::string>& warnings) const;
  /// The value of a place in a medium. Linear: interpolated between samples. Nearest: that of the nearest sample.
  /// Categories: the same, and only annotated values have a color and an opacity.
  enum class Sampling
  {
    Linear,
    Nearest,
    Categories
  };
  /// Returns what the property requests for a component, or Linear where that is not possible.
  Sampling GetSampling(const vtkDSMImageArrays& arrays, Grids grids, int component) const;
  /// All that the colors and opacities of the medium depend on: the values' range, the length of a cell, that of
  /// the medium, the property and its time, the blend mode and the range of an average, the component whose
  /// functions are taken and its weight. And the sampling of values; a two-dimensional function (null: there is
  /// none), its time, and the range of its second axis.
  using MediumKey = std::tuple<double, double, double, double, vtkVolumeProperty*, vtkMTimeType,
    int, std::array<double, 2>, int, double, Sampling, vtkImageData*, vtkMTimeType,
    std::array<double, 2>>;
  /// `component`: one of several independent ones, or none (std::nullopt). `seconds`: the range of the second axis of
  /// a two-dimensional function, which defines the medium; none: it does not.
  MediumKey GetMediumKey(const bricks::ValueRange& range, double cellLength, double diagonal,
    const std::optional<int>& component, Sampling sampling,
    const std::optional<std::array<double, 2>>& seconds) const;
  /// Returns whether a two-dimensional function defines the medium.
  bool HasFunction2D(const vtkDSMImageArrays& arrays) const;
  /// Returns whether the values of another array are its second axis. Then a single component of the medium's array
  /// is shown.
  bool HasSecondArray(const vtkDSMImageArrays& arrays) const;
  /// Returns whether another array defines the density of the medium.
  bool HasOpacityArray() const;
  /// Makes the medium that has the values of a field, within a region.
  using MediumMaker = std::function<rt::SceneMedium(const rt::AnyField&, const rt::ClipRegion&)>;
  /// Returns the maker for the blend mode. Expensive: keep the result as long as the key is the
  /// same. Empty if the blend mode is not supported.
  static MediumMaker GetMediumMaker(const MediumKey& key);
  /// Returns the shown arrays, as the mapper names them. Isosurfaces: their array and, if any, that
  /// of the colors. Slices alone: the array that colors them, if any. Media: the array of the
  /// opacities and that of the colors; if the components are independent, each component; with a second axis, that
  /// of the medium and that of the axis. `arrays`: the available arrays.
  std::vector<vtkDSMVolumeData::Choice> GetShown(const vtkDSMImageArrays& arrays) const;
  /// Finite, ascending, each once; `suggested` where none is chosen and the mapper takes what data suggest. Adds
  /// what is wrong with them to the messages.
  std::vector<double> GetIsovalues(
    const std::optional<double>& suggested, std::vector<std::string>& messages) const;
  void SetMaterials(double isovalue, rt::IsosurfaceLook& look) const;
  /// Returns whether the slices, and the faces of isosurfaces, have the colors of an array.
  bool HasColoredSlices() const;
  /// The slices of a part, in world space, by the indices of these values. Those by an index that the part does not
  /// have are left out.
  std::vector<rt::SectionPlane> GetSlices(
    const glm::dmat4& dataToWorld, const vtkDSMPartValues& values) const;
  /// Sets how slices and faces of isosurfaces look, but for their colors.
  template <class FieldType>
  void SetSliceLook(bool isLit, rt::SliceOf<FieldType>& slice) const
  {
    this->SetMaterials(0.0, slice.Look);
    slice.NearestValues = !this->Mapper->GetInterpolateSlices();
    if (!isLit)
    {
      rt::Material& surface = slice.Look.Surface;
      surface.Lighting = false;
      surface.Ambient = 0.0f;
      surface.Diffuse = 1.0f;
      surface.Reflectivity = 0.0f;
    }
  }
  rt::ClipRegion GetClipRegion(const glm::dmat4& dataToWorld) const;
  /// The planes of a region's half spaces.
  static std::vector<rt::SectionPlane> GetFaces(const rt::ClipRegion& region);

private:
  /// Why a medium cannot show the nearest sample, as the end of a sentence, and what to do instead.
  struct Obstacle
  {
    std::string Reason;
    std::string Remedy;
  };
  /// Null: there is none.
  std::optional<Obstacle> FindNearestObstacle(const vtkDSMImageArrays& arrays, Grids grids) const;
  /// Why a two-dimensional function that the property requests does not define the medium. Null: it does.
  std::optional<Obstacle> FindFunction2DObstacle(const vtkDSMImageArrays& arrays) const;
  /// Returns whether the property requests one.
  bool WantsFunction2D() const;
  /// Returns the components of the array that are shown as media of their own; the first one, if none has a weight.
  std::vector<int> GetWeightedComponents(const vtkDSMImageArrays& arrays) const;
  /// Returns the sampling that the property requests for a component.
  Sampling GetRequestedSampling(int component) const;
  bool HasColorArray() const;
  int GetColorComponent() const;
  /// Returns the array of the isosurfaces or of the medium. Without a name: the active scalars.
  vtkDSMVolumeData::Choice GetIsoChoice(const vtkDSMImageArrays& arrays) const;
  /// The same as the mapper names it.
  vtkDSMVolumeData::Choice GetNamedIsoChoice() const;

  vtkDSMVolumeMapper* Mapper;
  vtkProp3D* Prop;
};

#endif
