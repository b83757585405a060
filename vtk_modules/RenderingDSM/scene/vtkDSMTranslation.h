// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMTranslation_h
#define vtkDSMTranslation_h

#include "DSMRayTracing/frame/FrameRequest.h"
#include "DSMRayTracing/scene/DebugView.h"
#include "DSMRayTracing/scene/Scene.h"

#include <array>
#include <memory>
#include <vector>

class vtkAbstractMapper;
class vtkDSMLightOptions;
class vtkMatrix4x4;
class vtkPiecewiseFunction;
class vtkProperty;
class vtkRenderer;
class vtkScalarsToColors;
class vtkTexture;
class vtkVolumeProperty;

/// VTK's words for a picture in the tracer's.
class vtkDSMTranslation
{
public:
  static glm::dmat4 ToMatrix(vtkMatrix4x4* matrix);

  static rt::Material ToMaterial(vtkProperty* property);

  /// The lines that VTK's OpenGL mapper draws along edges.
  static rt::EdgeLines ToEdgeLines(vtkProperty* property);

  /// The look of an isosurface by the transfer functions and the shading of a volume's property.
  static rt::Material ToMaterial(vtkVolumeProperty* property, double isovalue);

  /// The texture's picture with its settings, after `transform` of the coordinates. Null when
  /// the texture has no picture of bytes.
  static std::shared_ptr<const rt::Texture> ToTexture(vtkTexture* texture, vtkMatrix4x4* transform);

  /// Samples any lookup table or transfer function. `opacity`: gives the opacities of the values,
  /// but that of what is not a number; null: the table does.
  static rt::ColorMap ToColorMap(
    vtkScalarsToColors* table, vtkPiecewiseFunction* opacity = nullptr);

  /// The color and opacity functions of a property's component, and its unit distance, for a medium whose values
  /// are from `first` to `last`. `weight`: of its opacities. `cellLength` and `diagonal`: of a cell's edge, and of
  /// the medium, in the space of the data. `hasCategories`: see vtkDSMVolumeFunctions.
  static std::shared_ptr<const rt::TransferFunction> ToTransferFunction(vtkVolumeProperty* property,
    int component, double weight, double first, double last, double cellLength, double diagonal,
    bool hasCategories);

  /// The same of a two-dimensional function, which must be there. As in vtkGPUVolumeRayCastMapper, the image covers
  /// the values from `first` to `last` and the second numbers between the two of `seconds`, whatever its origin and
  /// spacing are, and is interpolated as the property's InterpolationType says. An opacity is that of a unit distance.
  static std::shared_ptr<const rt::TransferFunction2D> ToTransferFunction2D(
    vtkVolumeProperty* property, int component, double weight, double first, double last,
    const std::array<double, 2>& seconds, double cellLength, double diagonal);

  /// The shading of a property's component, and its gradient opacity, for a medium whose values differ so much.
  static rt::MediumLook ToMediumLook(vtkVolumeProperty* property, int component, double range);
  /// The same functions as colors and opacities of single values.
  static std::shared_ptr<const rt::ColorMap> ToColorMap(vtkVolumeProperty* property, int component,
    double first, double last, bool hasCategories = false);
  /// The color function, as the legend of a property's component shows it, for values of a range, with the
  /// opacities of the same values or opaque. NaN is transparent. `hasCategories`: see vtkDSMVolumeFunctions.
  static rt::ColorMap ToColorMap(vtkVolumeProperty* property, int component,
    const bricks::ValueRange& range, bool hasOpacity, bool hasCategories);
  /// The values, 0 to 1 in that range, times their opacities of a property's first component, which LatticeSum adds
  /// up over `unit` of length. In a mean, the values between the two that are `counted` count.
  static std::shared_ptr<const rt::TransferFunction> ToSum(vtkVolumeProperty* property,
    double first, double last, const std::array<double, 2>& counted, double unit);

  /// Returns the region that a mapper's clipping planes keep, in world space.
  static rt::ClipRegion ToClipRegion(vtkAbstractMapper* mapper);

  /// `bounds` are those of what is shown, in world space. A picture in passing goes without the rays of a first look.
  static rt::LightTransport ToTransport(
    vtkDSMLightOptions* options, const double bounds[6], bool isPassing);
  static rt::DebugView ToDebugView(vtkDSMLightOptions* options);

  /// The lights that are on, in world space. Moves the lights that follow the camera to where the
  /// renderer will have them, and makes the renderer's automatic light if there is none.
  static std::vector<rt::Light> ToLights(vtkRenderer* renderer);

  /// Windows that show one picture together: how many there are along x and y, and the pixels between two.
  struct TileDisplay
  {
    int Tiles[2] = { 1, 1 };
    int Gap[2] = { 0, 0 };
  };

  /// The picture that the renderer is about to draw, with that of the other windows if it is one of several;
  /// `projection` is filled with its projection.
  static rt::FrameRequest ToRequest(
    vtkRenderer* renderer, const TileDisplay& display, vtkMatrix4x4* projection);
  /// One of another size, for which the renderer needs no window.
  static rt::FrameRequest ToRequest(
    vtkRenderer* renderer, int width, int height, vtkMatrix4x4* projection);
};

#endif
