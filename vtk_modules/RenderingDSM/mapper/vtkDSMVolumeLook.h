// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMVolumeLook_h
#define vtkDSMVolumeLook_h

#include "DSMRayTracing/scene/Scene.h"
#include "vtkDSMVolumeData.h"

#include <glm/mat4x4.hpp>

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

class vtkDSMVolumeMapper;
class vtkProp3D;
class vtkVolumeProperty;

/// What a volume's mapper and prop ask for now, in the ray tracer's words. Owns neither; local, the same on every rank where
/// they are.
class vtkDSMVolumeLook
{
public:
  vtkDSMVolumeLook(vtkDSMVolumeMapper* mapper, vtkProp3D* prop);

  /// Whether isovalues and look come from the volume's property; else they are the mapper's.
  bool IsLikeRayCastMapper() const;
  /// Whether the volume is a medium, as its property and the blend mode say, and there are no isosurfaces and slices.
  bool IsMedium() const;
  /// Whether there are slices, or may be, and no isosurfaces.
  bool IsSlicesOnly() const;
  bool HasIsosurfaces() const { return !this->IsMedium() && !this->IsSlicesOnly(); }
  /// What a medium shows of its array's components: one, or the magnitude; each one by its own functions, as a medium of
  /// its own; colors by the first ones and opacities by the last one; or nothing, for there are not so many.
  enum class Components
  {
    One,
    Independent,
    Dependent,
    Refused
  };
  /// `arrays`: those that there are.
  Components GetComponents(const vtkDSMImageArrays& arrays) const;
  /// Tells what the property asks for, of the array's components, that media do not have yet.
  void FindMissingFeatures(
    const vtkDSMImageArrays& arrays, std::vector<std::string>& warnings) const;
  /// All that the colors and opacities of the medium depend on: the values' range, the length of a cell, that of
  /// the medium, the property and its time, the blend mode and the range of an average, the component whose functions are
  /// taken and its weight.
  using MediumKey = std::tuple<double, double, double, double, vtkVolumeProperty*, vtkMTimeType,
    int, std::array<double, 2>, int, double>;
  /// `component`: one of several independent ones, or none (std::nullopt).
  MediumKey GetMediumKey(const bricks::ValueRange& range, double cellLength, double diagonal,
    const std::optional<int>& component) const;
  /// Whether another array says how dense the medium is.
  bool HasOpacityArray() const;
  /// Makes the medium that has the values of a field, within a region.
  using MediumMaker =
    std::function<rt::SceneMedium(const rt::LatticeField&, const rt::ClipRegion&)>;
  /// Of the blend mode. Expensive: keep it as long as the key is the same. Empty where the mode is none that is drawn.
  static MediumMaker GetMediumMaker(const MediumKey& key);
  /// The arrays that are to be shown, as the mapper names them: that of the isosurfaces, and that of the colours, if any.
  /// Of slices alone the one that colors them, if any. Of a medium that of the opacities, and that of the colors; or, where
  /// its components are independent, each of these. `arrays`: those that there are.
  std::vector<vtkDSMVolumeData::Choice> GetShown(const vtkDSMImageArrays& arrays) const;
  /// Whether the cells' scalars are asked for, of which there are no isosurfaces.
  bool TakesPointsForCells() const;
  /// Finite, ascending, each once; `suggested` where none is chosen and the mapper takes what data suggest. Adds what is
  /// wrong with them to the messages.
  std::vector<double> GetIsovalues(
    const std::optional<double>& suggested, std::vector<std::string>& messages) const;
  void SetMaterials(double isovalue, rt::IsosurfaceLook& look) const;
  /// Whether the slices, and the faces of isosurfaces, have the colors of an array.
  bool HasColoredSlices() const;
  /// The slices of a lattice of so many points, in world space; `toWorld`: from its indices. Slices by an index that the
  /// lattice does not have are left out.
  std::vector<rt::SectionPlane> GetSlices(
    const glm::dmat4& toWorld, const bricks::Index3& points) const;
  /// Sets how slices and faces of isosurfaces look, but for their colors.
  void SetSliceLook(bool isLit, rt::LatticeSlice& slice) const;
  rt::ClipRegion GetClipRegion(const glm::dmat4& dataToWorld) const;
  /// The planes of a region's half spaces.
  static std::vector<rt::SectionPlane> GetFaces(const rt::ClipRegion& region);

private:
  bool HasColorArray() const;
  int GetColorComponent() const;
  std::string GetIsoArray() const;

  vtkDSMVolumeMapper* Mapper;
  vtkProp3D* Prop;
};

#endif
