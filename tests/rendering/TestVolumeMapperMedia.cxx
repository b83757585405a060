// SPDX-License-Identifier: BSD-3-Clause
// Volumes as media, beside those of VTK's mappers.
#include "VolumeMapperTest.h"

#include "vtkDSMLightOptions.h"

#include "vtkCellData.h"
#include "vtkColorTransferFunction.h"
#include "vtkCommand.h"
#include "vtkFixedPointVolumeRayCastMapper.h"
#include "vtkGPUVolumeRayCastMapper.h"
#include "vtkLight.h"
#include "vtkMatrix4x4.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPlane.h"
#include "vtkTestErrorObserver.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVolumeProperty.h"

#include <cmath>
#include <string>

namespace
{

/// The ball with several components: values in [0, `most`] that have their largest at other places, and small ones
/// between.
template <class Array>
vtkSmartPointer<vtkImageData> MakeComponents(int count, double most = 1.0)
{
  const auto image = MakeBall();
  vtkNew<Array> values;
  values->SetName("distance");
  values->SetNumberOfComponents(count);
  values->SetNumberOfTuples(image->GetNumberOfPoints());
  for (vtkIdType point = 0; point < image->GetNumberOfPoints(); ++point)
  {
    const double* const place = image->GetPoint(point);
    for (int component = 0; component < count; ++component)
    {
      const double angle = 2.0 * component;
      const double x = place[0] - 5.0 * std::cos(angle);
      const double y = place[1] - 5.0 * std::sin(angle);
      const double z = 2.0 * place[2];
      values->SetComponent(
        point, component, most * std::max(0.0, 1.0 - std::sqrt(x * x + y * y + z * z) / 12.0));
    }
  }
  image->GetPointData()->SetScalars(values);
  return image;
}

/// A ball that can be lit. Nothing is at the volume's border, where VTK's gradients are half as large across.
vtkSmartPointer<vtkVolumeProperty> MakeBallProperty()
{
  vtkNew<vtkColorTransferFunction> colors;
  colors->AddRGBPoint(0.0, 0.9, 0.2, 0.1);
  colors->AddRGBPoint(0.5, 0.2, 0.9, 0.3);
  vtkNew<vtkPiecewiseFunction> opacity;
  opacity->AddPoint(0.0, 0.8);
  opacity->AddPoint(0.3, 0.4);
  opacity->AddPoint(0.44, 0.0);
  auto property = vtkSmartPointer<vtkVolumeProperty>::New();
  property->SetInterpolationTypeToLinear();
  property->SetColor(colors);
  property->SetScalarOpacity(opacity);
  property->SetScalarOpacityUnitDistance(4.0);
  return property;
}

/// The face of a cut hides what is behind it in any blend mode. Rounding leaves slivers of the medium in front of it,
/// which must not show.
TEST_F(VolumeMapper, FacesOfCutsHideProjections)
{
  vtkNew<vtkPlane> plane;
  plane->SetNormal(-0.3, -0.31, -0.9);
  this->Mapper->SetNumberOfIsoValues(0);
  this->Mapper->AddClippingPlane(plane);
  this->Mapper->CappingOn();
  this->Mapper->CapOpacityOff();
  this->Place();
  this->Renderer->AddVolume(this->Volume);
  this->Volume->SetProperty(MakeBallProperty());
  const auto draw = [this](int mode)
  {
    this->Mapper->SetBlendMode(mode);
    this->Window->Render();
    auto pixels = vtkSmartPointer<vtkUnsignedCharArray>::New();
    const int middle = Size / 2;
    this->Window->GetPixelData(middle - 12, middle - 12, middle + 12, middle + 12, 0, pixels);
    return pixels;
  };
  const auto composite = draw(vtkVolumeMapper::COMPOSITE_BLEND);
  EXPECT_GT(composite->GetValue(0), 20);
  for (const int mode : { vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND,
         vtkVolumeMapper::AVERAGE_INTENSITY_BLEND, vtkVolumeMapper::ADDITIVE_BLEND })
  {
    EXPECT_EQ(GetDifference(draw(mode), composite), 0.0) << "blend mode " << mode;
  }
}

/// A function that is trilinear in a box of few, long cells.
class VolumeMapperIntegral : public VolumeMapper
{
protected:
  static constexpr int Width = 40;
  static constexpr int Height = 30;
  static constexpr double Box[6] = { -4.0, 4.0, -3.0, 3.0, -5.0, 5.0 };

  static double Evaluate(const double* p)
  {
    return 2.0 + 0.3 * p[0] - 0.2 * p[1] * p[2] + 0.05 * p[0] * p[1] * p[2];
  }

  void SetUp() override
  {
    vtkNew<vtkImageData> image;
    image->SetDimensions(17, 4, 11);
    image->SetSpacing(0.5, 2.0, 1.0);
    image->SetOrigin(Box[0], Box[2], Box[4]);
    vtkNew<vtkDoubleArray> values;
    values->SetName("distance");
    for (vtkIdType point = 0; point < image->GetNumberOfPoints(); ++point)
    {
      values->InsertNextValue(Evaluate(image->GetPoint(point)));
    }
    image->GetPointData()->SetScalars(values);
    this->Range[0] = values->GetRange()[0];
    this->Range[1] = values->GetRange()[1];
    this->Mapper->SetInputData(image);
    this->Mapper->SetNumberOfIsoValues(0);
    this->Mapper->SetBlendModeToIntegral();
    vtkNew<vtkColorTransferFunction> colors;
    colors->AddRGBPoint(this->Range[0], 0.0, 1.0, 0.0);
    colors->AddRGBPoint(this->Range[1], 1.0, 0.0, 0.0);
    vtkNew<vtkVolumeProperty> property;
    property->SetInterpolationTypeToLinear();
    property->SetColor(colors);
    this->Volume->SetProperty(property);
    this->Volume->SetScale(Scale);
    this->Place();
    this->Renderer->AddVolume(this->Volume);
  }

  /// The integral along the ray through the middle of a pixel, in world space; 0 where it misses the box.
  double Integrate(int x, int y)
  {
    vtkNew<vtkMatrix4x4> toWorld;
    toWorld->DeepCopy(this->Renderer->GetActiveCamera()->GetCompositeProjectionTransformMatrix(
      static_cast<double>(Width) / Height, -1.0, 1.0));
    toWorld->Invert();
    vtkNew<vtkMatrix4x4> toData;
    toData->DeepCopy(this->Volume->GetMatrix());
    toData->Invert();
    double ends[2][4];
    for (int end = 0; end < 2; ++end)
    {
      const double clip[4] = { 2.0 * (x + 0.5) / Width - 1.0, 2.0 * (y + 0.5) / Height - 1.0,
        2.0 * end - 1.0, 1.0 };
      toWorld->MultiplyPoint(clip, ends[end]);
      toData->MultiplyPoint(ends[end], ends[end]);
      for (double& coordinate : ends[end])
      {
        coordinate /= ends[end][3];
      }
    }
    double first = 0.0;
    double last = 1.0;
    double length = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double way = ends[1][axis] - ends[0][axis];
      const double low = (Box[2 * axis] - ends[0][axis]) / way;
      const double high = (Box[2 * axis + 1] - ends[0][axis]) / way;
      first = std::max(first, std::min(low, high));
      last = std::min(last, std::max(low, high));
      length += way * way;
    }
    if (first >= last)
    {
      return 0.0;
    }
    // Simpson's rule, which is exact.
    double sum = 0.0;
    for (int place = 0; place < 3; ++place)
    {
      double point[3];
      for (int axis = 0; axis < 3; ++axis)
      {
        const double t = first + 0.5 * place * (last - first);
        point[axis] = (1.0 - t) * ends[0][axis] + t * ends[1][axis];
      }
      sum += (place == 1 ? 4.0 : 1.0) * Evaluate(point);
    }
    return sum / 6.0 * (last - first) * std::sqrt(length) * Scale;
  }

  static constexpr double Scale = 2.0;
  double Range[2];
};

TEST_F(VolumeMapperIntegral, GivesTheNumbersAndColors)
{
  vtkNew<vtkImageData> image;
  ASSERT_TRUE(this->Scene->TraceImage(Width, Height, image));
  vtkDataArray* const integrals = image->GetPointData()->GetArray("integral");
  ASSERT_NE(integrals, nullptr);
  const double diagonal = Scale * std::sqrt(64.0 + 36.0 + 100.0);
  const double least = std::min(this->Range[0], 0.0) * diagonal;
  const double most = this->Range[1] * diagonal;
  int met = 0;
  for (int y = 0; y < Height; ++y)
  {
    for (int x = 0; x < Width; ++x)
    {
      const double expected = this->Integrate(x, y);
      const vtkIdType pixel = y * Width + x;
      EXPECT_NEAR(integrals->GetComponent(pixel, 0), expected, 1e-6 * most) << x << ", " << y;
      if (std::abs(expected) > 1e-3 * most)
      {
        ++met;
        const double red = 255.0 * (expected - least) / (most - least);
        vtkDataArray* const colors = image->GetPointData()->GetScalars();
        EXPECT_NEAR(colors->GetComponent(pixel, 0), red, 1.0) << x << ", " << y;
        EXPECT_NEAR(colors->GetComponent(pixel, 1), 255.0 - red, 1.0) << x << ", " << y;
      }
    }
  }
  EXPECT_GT(met, 50);
  EXPECT_LT(met, Width * Height - 50);
}

TEST_F(VolumeMapperIntegral, IsOfWhatIsKept)
{
  vtkNew<vtkPlane> plane;
  plane->SetOrigin(this->Volume->GetCenter());
  plane->SetNormal(0.3, 0.8, -0.2);
  vtkNew<vtkImageData> image;
  const auto trace = [&]
  {
    EXPECT_TRUE(this->Scene->TraceImage(Width, Height, image));
    const vtkSmartPointer<vtkDataArray> integrals = image->GetPointData()->GetArray("integral");
    return integrals;
  };
  const auto whole = trace();
  this->Mapper->AddClippingPlane(plane);
  const auto one = trace();
  plane->SetNormal(-0.3, -0.8, 0.2);
  const auto other = trace();
  int divided = 0;
  for (vtkIdType pixel = 0; pixel < whole->GetNumberOfTuples(); ++pixel)
  {
    const double parts[2] = { one->GetComponent(pixel, 0), other->GetComponent(pixel, 0) };
    EXPECT_NEAR(parts[0] + parts[1], whole->GetComponent(pixel, 0), 1e-3);
    divided += parts[0] != 0.0 && parts[1] != 0.0;
  }
  EXPECT_GT(divided, 50);
}

TEST_F(VolumeMapperIntegral, NumbersAreThereForThisBlendModeOnly)
{
  this->Mapper->SetBlendModeToComposite();
  vtkNew<vtkImageData> image;
  ASSERT_TRUE(this->Scene->TraceImage(Width, Height, image));
  EXPECT_EQ(image->GetPointData()->GetArray("integral"), nullptr);
}

TEST_F(VolumeMapper, StandsInForTheRayCastMapper)
{
  vtkNew<vtkColorTransferFunction> colors;
  colors->AddRGBPoint(0.0, 0.9, 0.2, 0.1);
  colors->AddRGBPoint(0.5, 0.2, 0.9, 0.3);
  colors->AddRGBPoint(1.0, 0.1, 0.3, 0.9);
  vtkNew<vtkPiecewiseFunction> gray;
  gray->AddPoint(0.0, 0.2);
  gray->AddPoint(1.0, 1.0);
  vtkNew<vtkPiecewiseFunction> opacity;
  opacity->AddPoint(0.0, 0.3);
  opacity->AddPoint(0.4, 0.0);
  opacity->AddPoint(0.5, 0.1);
  opacity->AddPoint(0.9, 0.0);
  this->Place();
  this->Renderer->AddVolume(this->Volume);
  for (const bool isGray : { false, true })
  {
    vtkNew<vtkVolumeProperty> property;
    property->SetInterpolationTypeToLinear();
    property->SetScalarOpacity(opacity);
    property->SetScalarOpacityUnitDistance(1.5);
    if (isGray)
    {
      property->SetColor(gray);
    }
    else
    {
      property->SetColor(colors);
    }
    this->Volume->SetProperty(property);
    vtkNew<vtkFixedPointVolumeRayCastMapper> theirs;
    vtkNew<vtkDSMVolumeMapper> ours; // the class name, and nothing else
    const auto found = this->Draw(ours);
    EXPECT_EQ(property->GetColorChannels(), isGray ? 1 : 3);
    EXPECT_LT(GetDifference(found, this->Draw(theirs)), 1.5);
    property->SetScalarOpacityUnitDistance(1e6);
    EXPECT_GT(GetDifference(found, this->Draw(ours)), 5.0) << "little is seen";
    this->Volume->SetMapper(this->Mapper); // the others go
  }
}

TEST_F(VolumeMapper, BlendsAsTheRayCastMapper)
{
  vtkNew<vtkColorTransferFunction> colors;
  colors->AddRGBPoint(0.0, 0.9, 0.2, 0.1);
  colors->AddRGBPoint(0.5, 0.2, 0.9, 0.3);
  vtkNew<vtkPiecewiseFunction> opacity;
  opacity->AddPoint(0.0, 1.0);
  opacity->AddPoint(0.3, 0.1);
  opacity->AddPoint(0.6, 0.8);
  vtkNew<vtkVolumeProperty> property;
  property->SetInterpolationTypeToLinear();
  property->SetScalarOpacity(opacity);
  property->SetColor(colors);
  property->SetScalarOpacityUnitDistance(20.0);
  this->Volume->SetProperty(property);
  this->Place();
  this->Renderer->AddVolume(this->Volume);
  vtkNew<vtkGPUVolumeRayCastMapper> theirs;
  theirs->SetAutoAdjustSampleDistances(0);
  theirs->SetSampleDistance(0.25f);
  vtkNew<vtkDSMVolumeMapper> ours;
  const auto draw = [&](vtkVolumeMapper* mapper, int mode)
  {
    mapper->SetInputDataObject(MakeBall());
    mapper->SetBlendMode(mode);
    this->Volume->SetMapper(mapper);
    this->Window->Render();
    vtkNew<vtkUnsignedCharArray> pixels;
    this->Window->GetPixelData(0, 0, Size - 1, Size - 1, 0, pixels);
    return vtkSmartPointer<vtkUnsignedCharArray>(pixels);
  };
  auto before = draw(ours, vtkVolumeMapper::COMPOSITE_BLEND);
  for (const int mode :
    { vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND, vtkVolumeMapper::MINIMUM_INTENSITY_BLEND,
      vtkVolumeMapper::AVERAGE_INTENSITY_BLEND, vtkVolumeMapper::ADDITIVE_BLEND })
  {
    const auto found = draw(ours, mode);
    EXPECT_LT(GetDifference(found, draw(theirs, mode)), 1.5) << mode;
    EXPECT_GT(GetDifference(found, before), 5.0) << mode;
    before = found;
  }
  for (vtkVolumeMapper* const mapper :
    { static_cast<vtkVolumeMapper*>(theirs.Get()), static_cast<vtkVolumeMapper*>(ours.Get()) })
  {
    mapper->SetAverageIPScalarRange(0.2, 0.4);
  }
  const int average = vtkVolumeMapper::AVERAGE_INTENSITY_BLEND;
  EXPECT_LT(GetDifference(draw(ours, average), draw(theirs, average)), 1.5);
  this->Volume->SetMapper(this->Mapper); // the others go
}

TEST_F(VolumeMapper, IsShadedAsTheRayCastMapper)
{
  vtkNew<vtkPiecewiseFunction> gradientOpacity;
  gradientOpacity->AddPoint(0.0, 0.0);
  gradientOpacity->AddPoint(0.1, 0.5);
  const auto property = MakeBallProperty();
  property->SetAmbient(0.2);
  property->SetDiffuse(0.7);
  property->SetSpecular(0.4);
  property->SetSpecularPower(10.0);
  this->Volume->SetProperty(property);
  this->Place();
  this->Renderer->AddVolume(this->Volume);
  vtkNew<vtkGPUVolumeRayCastMapper> theirs;
  theirs->SetAutoAdjustSampleDistances(0);
  theirs->SetSampleDistance(0.25f);
  vtkNew<vtkDSMVolumeMapper> ours;
  const auto plain = this->Draw(ours);
  property->ShadeOn();
  const auto shaded = this->Draw(ours);
  EXPECT_GT(GetDifference(shaded, plain), 5.0);
  EXPECT_LT(GetDifference(shaded, this->Draw(theirs)), 3.0);
  property->SetGradientOpacity(gradientOpacity);
  const auto edges = this->Draw(ours);
  EXPECT_GT(GetDifference(edges, shaded), 2.0);
  EXPECT_LT(GetDifference(edges, this->Draw(theirs)), 3.0);
  this->Volume->SetMapper(this->Mapper); // the others go
}

/// Lamps that are no headlight, ambient light of lamps, and light from one side only.
TEST_F(VolumeMapper, IsLitAsTheRayCastMapper)
{
  const auto property = MakeBallProperty();
  property->ShadeOn();
  property->SetAmbient(0.5);
  property->SetDiffuse(0.7);
  this->Volume->SetProperty(property);
  this->Renderer->AddVolume(this->Volume);
  vtkNew<vtkLight> lamp;
  lamp->SetLightTypeToSceneLight();
  lamp->SetPosition(1.0, 0.3, 0.6);
  lamp->SetFocalPoint(0.0, 0.0, 0.0);
  this->Renderer->RemoveAllLights();
  this->Renderer->AddLight(lamp);
  vtkNew<vtkGPUVolumeRayCastMapper> theirs;
  theirs->SetAutoAdjustSampleDistances(0);
  theirs->SetSampleDistance(0.25f);
  vtkNew<vtkDSMVolumeMapper> ours;
  const auto compare = [&](const char* what)
  {
    auto found = this->Draw(ours);
    EXPECT_LT(GetDifference(found, this->Draw(theirs)), 2.0) << what;
    return found;
  };
  const auto twoSided = compare("ambient light is the lamp's, which is black");
  this->Renderer->TwoSidedLightingOff();
  const auto oneSided = compare("one side");
  EXPECT_GT(GetDifference(oneSided, twoSided), 3.0);
  lamp->SetAmbientColor(0.1, 0.5, 0.9);
  EXPECT_GT(GetDifference(compare("ambient light"), oneSided), 5.0);
  this->Volume->SetMapper(this->Mapper); // the others go
}

/// A medium as dense as a solid, in which gradients leave a step in the middle only.
TEST_F(VolumeMapper, GradientsThinADenseMedium)
{
  const auto image = MakeBall();
  vtkDataArray* const values = image->GetPointData()->GetScalars();
  for (vtkIdType point = 0; point < image->GetNumberOfPoints(); ++point)
  {
    values->SetComponent(point, 0, image->GetPoint(point)[2] < 0.0 ? 200.0 : 100.0);
  }
  vtkNew<vtkColorTransferFunction> colors;
  colors->AddRGBPoint(0.0, 1.0, 1.0, 1.0);
  vtkNew<vtkPiecewiseFunction> opacity;
  opacity->AddPoint(0.0, 0.9);
  vtkNew<vtkPiecewiseFunction> gradientOpacity;
  gradientOpacity->AddPoint(5.0, 0.0);
  gradientOpacity->AddPoint(20.0, 1.0);
  vtkNew<vtkVolumeProperty> property;
  property->SetColor(colors);
  property->SetScalarOpacity(opacity);
  property->SetGradientOpacity(gradientOpacity);
  property->SetInterpolationTypeToLinear();
  this->Volume->SetProperty(property);
  this->Mapper->SetNumberOfIsoValues(0);
  this->Mapper->SetInputData(image);
  this->Renderer->AddVolume(this->Volume);
  vtkCamera* const camera = this->Renderer->GetActiveCamera();
  camera->ParallelProjectionOn();
  camera->SetParallelScale(10.0);
  camera->SetViewUp(0.0, 0.0, 1.0);
  camera->SetPosition(0.0, 60.0, 0.0);
  for (const bool isLit : { false, true })
  {
    property->SetShade(isLit);
    this->Mapper->GetLightOptions()->SetShadows(isLit);
    this->Window->Render();
    vtkNew<vtkUnsignedCharArray> pixels;
    this->Window->GetPixelData(Size / 2, 0, Size / 2, Size - 1, 0, pixels);
    for (int row = 0; row < Size; ++row)
    {
      const double z = (row + 0.5 - Size / 2) * 20.0 / Size;
      const int gray = pixels->GetTypedComponent(row, 0);
      if (z < -1.5 || z > 1.0)
      {
        EXPECT_EQ(gray, 0) << "z " << z << ", where values do not grow";
      }
      else if (z > -0.5 && z < 0.0 && !isLit)
      {
        EXPECT_GE(gray, 254) << "z " << z << ", at the step";
      }
    }
  }
}

/// Whatever the volume's scale is. VTK's mappers do the same.
TEST_F(VolumeMapper, UnitDistanceIsOneOfTheData)
{
  const auto image = MakeBall();
  image->GetPointData()->GetScalars()->Fill(0.5);
  vtkNew<vtkColorTransferFunction> colors;
  colors->AddRGBPoint(0.0, 1.0, 1.0, 1.0);
  vtkNew<vtkPiecewiseFunction> opacity;
  opacity->AddPoint(0.0, 0.1);
  vtkNew<vtkVolumeProperty> property;
  property->SetColor(colors);
  property->SetScalarOpacity(opacity);
  property->SetScalarOpacityUnitDistance(4.0);
  property->SetInterpolationTypeToLinear();
  this->Volume->SetProperty(property);
  this->Mapper->SetNumberOfIsoValues(0);
  this->Mapper->SetInputData(image);
  this->Renderer->AddVolume(this->Volume);
  vtkCamera* const camera = this->Renderer->GetActiveCamera();
  camera->ParallelProjectionOn();
  camera->SetPosition(0.0, 0.0, 600.0);
  for (const double scale : { 0.1, 1.0, 8.0 })
  {
    this->Volume->SetScale(1.0, 1.0, scale);
    this->Renderer->ResetCameraClippingRange();
    this->Window->Render();
    vtkNew<vtkUnsignedCharArray> pixel;
    this->Window->GetPixelData(Size / 2, Size / 2, Size / 2, Size / 2, 0, pixel);
    const double length = 0.5 * Edge; // along z
    EXPECT_NEAR(pixel->GetTypedComponent(0, 0), 255.0 * (1.0 - std::pow(0.9, length / 4.0)), 1.0)
      << scale;
  }
}

TEST_F(VolumeMapper, SaysWhatMediaDoNotHave)
{
  this->Mapper->SetNumberOfIsoValues(0);
  this->Renderer->AddVolume(this->Volume);
  vtkNew<vtkTest::ErrorObserver> observer;
  this->Mapper->AddObserver(vtkCommand::ErrorEvent, observer);
  this->Mapper->AddObserver(vtkCommand::WarningEvent, observer);
  this->Window->Render();
  EXPECT_FALSE(observer->GetError() || observer->GetWarning())
    << "the nearest sample is VTK's default";
  // What cannot be the nearest sample.
  this->Mapper->SetBlendMode(vtkVolumeMapper::ADDITIVE_BLEND);
  this->Window->Render();
  EXPECT_NE(observer->GetWarningMessage().find("InterpolationTypeToLinear"), std::string::npos);
  observer->Clear();
  this->Mapper->SetInputData(MakeBall());
  this->Window->Render();
  EXPECT_FALSE(observer->GetError() || observer->GetWarning()) << "once, not for each dataset";
  vtkNew<vtkColorTransferFunction> categories;
  categories->AddRGBPoint(0.0, 1.0, 0.0, 0.0);
  categories->IndexedLookupOn();
  this->Volume->GetProperty()->SetInterpolationTypeToLinear();
  this->Volume->GetProperty()->SetColor(categories);
  this->Window->Render();
  EXPECT_NE(
    observer->GetWarningMessage().find("Interpret Values As Categories"), std::string::npos);
  observer->Clear();
  this->Mapper->SetBlendMode(vtkVolumeMapper::COMPOSITE_BLEND);
  this->Window->Render();
  EXPECT_FALSE(observer->GetError() || observer->GetWarning());
  const auto ofCells = MakeBall();
  vtkNew<vtkFloatArray> values;
  values->SetName("distance");
  values->SetNumberOfTuples(ofCells->GetNumberOfCells());
  values->Fill(0.5);
  ofCells->GetCellData()->AddArray(values);
  this->Mapper->SetInputData(ofCells);
  this->Mapper->SetIsoArrayOnCells(true);
  this->Window->Render();
  EXPECT_NE(observer->GetWarningMessage().find("Resample To Image"), std::string::npos);
  observer->Clear();
  this->Mapper->SetIsoArrayOnCells(false);
  categories->IndexedLookupOff();
  this->Window->Render();
  EXPECT_FALSE(observer->GetError() || observer->GetWarning());
  this->Volume->GetProperty()->ShadeOn();
  this->Window->Render();
  EXPECT_FALSE(observer->GetError() || observer->GetWarning());
  this->Mapper->ComputeNormalFromOpacityOn();
  this->Window->Render();
  EXPECT_NE(observer->GetWarningMessage().find("ComputeNormalFromOpacityOff"), std::string::npos);
  this->Mapper->ComputeNormalFromOpacityOff();
  this->Mapper->SetOpacityArray("distance");
  this->Mapper->SetBlendMode(vtkVolumeMapper::ADDITIVE_BLEND);
  observer->Clear();
  this->Window->Render();
  EXPECT_NE(observer->GetWarningMessage().find("Separate Opacity Array"), std::string::npos);
  this->Mapper->SetOpacityArray("");
  this->Mapper->SetInputData(MakeComponents<vtkFloatArray>(2));
  this->Mapper->SetBlendMode(vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND);
  observer->Clear();
  this->Window->Render();
  EXPECT_NE(observer->GetWarningMessage().find("all components"), std::string::npos);
  observer->Clear();
  this->Volume->GetProperty()->SetComponentWeight(1, 0.0);
  this->Window->Render();
  EXPECT_FALSE(observer->GetWarning()) << observer->GetWarningMessage();
  this->Volume->GetProperty()->IndependentComponentsOff();
  this->Window->Render();
  EXPECT_NE(observer->GetWarningMessage().find("IndependentComponentsOn"), std::string::npos);
  this->Mapper->SetBlendMode(vtkVolumeMapper::COMPOSITE_BLEND);
  this->Mapper->SetInputData(MakeComponents<vtkFloatArray>(3));
  this->Window->Render();
  EXPECT_NE(observer->GetErrorMessage().find("has 3"), std::string::npos);
  this->Mapper->SetInputData(MakeBall());
  this->Mapper->SetBlendMode(vtkVolumeMapper::SLICE_BLEND);
  this->Window->Render();
  EXPECT_NE(observer->GetErrorMessage().find("Slice"), std::string::npos);
  this->Mapper->AutomaticIsoValueOn();
  this->Window->Render();
  EXPECT_TRUE(std::isfinite(this->Mapper->GetSuggestedIsoValue()))
    << "a surface in place of the medium";
}

/// A volume of several components, and VTK's mapper beside ours.
class VolumeMapperOfComponents : public VolumeMapper
{
protected:
  VolumeMapperOfComponents()
  {
    const double colors[][3] = { { 1.0, 0.2, 0.1 }, { 0.1, 0.9, 0.2 }, { 0.2, 0.3, 1.0 },
      { 0.9, 0.8, 0.1 } };
    for (int component = 0; component < 4; ++component)
    {
      vtkNew<vtkColorTransferFunction> color;
      color->AddRGBPoint(0.0, 0.1, 0.1, 0.1);
      color->AddRGBPoint(1.0, colors[component][0], colors[component][1], colors[component][2]);
      vtkNew<vtkPiecewiseFunction> opacity;
      opacity->AddPoint(0.2, 0.0);
      opacity->AddPoint(1.0, 0.2 + 0.1 * component);
      this->Property->SetColor(component, color);
      this->Property->SetScalarOpacity(component, opacity);
      this->Property->SetScalarOpacityUnitDistance(component, 2.0);
    }
    this->Property->SetInterpolationTypeToLinear();
    this->Volume->SetProperty(this->Property);
    this->Place();
    this->Renderer->AddVolume(this->Volume);
    this->Mapper->SetNumberOfIsoValues(0);
    this->Mapper->SetIsoArray("");
  }
  ~VolumeMapperOfComponents() override { this->Volume->SetMapper(this->Mapper); }

  vtkSmartPointer<vtkUnsignedCharArray> Draw(vtkVolumeMapper* mapper, vtkImageData* image)
  {
    mapper->SetInputDataObject(image);
    this->Volume->SetMapper(mapper);
    this->Window->Render();
    vtkNew<vtkUnsignedCharArray> pixels;
    this->Window->GetPixelData(0, 0, Size - 1, Size - 1, 0, pixels);
    return pixels;
  }
  /// With VTK's; returns ours.
  vtkSmartPointer<vtkUnsignedCharArray> Compare(vtkImageData* image, double most, const char* what)
  {
    vtkNew<vtkGPUVolumeRayCastMapper> mapper; // it does not take other components later
    mapper->SetAutoAdjustSampleDistances(0);
    mapper->SetSampleDistance(0.1f);
    const auto theirs = this->Draw(mapper, image);
    auto ours = this->Draw(this->Mapper, image);
    EXPECT_LT(GetDifference(ours, theirs), most) << what;
    vtkNew<vtkUnsignedCharArray> nothing;
    nothing->DeepCopy(ours);
    nothing->Fill(0.0);
    EXPECT_GT(GetDifference(ours, nothing), 1.0) << what;
    return ours;
  }

  vtkNew<vtkVolumeProperty> Property;
};

TEST_F(VolumeMapperOfComponents, IndependentOnesAreShownAtOnce)
{
  this->Compare(MakeComponents<vtkFloatArray>(2), 0.1, "two");
  this->Compare(MakeComponents<vtkFloatArray>(3), 0.1, "three");
  const auto four = MakeComponents<vtkFloatArray>(4);
  const auto plain = this->Compare(four, 0.1, "four");
  this->Property->ShadeOn();
  this->Property->SetAmbient(0, 0.6);
  this->Property->SetDiffuse(1, 0.3);
  this->Property->SetSpecular(2, 0.5);
  EXPECT_GT(GetDifference(this->Compare(four, 1.0, "shaded"), plain), 1.0);
  this->Property->ShadeOff();
  EXPECT_EQ(GetDifference(this->Draw(this->Mapper, four), plain), 0.0);

  for (const double weight : { 0.0, 0.5 })
  {
    this->Property->SetComponentWeight(0, weight);
    this->Property->SetComponentWeight(2, weight);
    const auto weighted = this->Draw(this->Mapper, four);
    EXPECT_GT(GetDifference(weighted, plain), 1.0);
    // With a weight below 1, VTK's other mapper makes a component denser.
    vtkNew<vtkFixedPointVolumeRayCastMapper> theirs;
    theirs->SetAutoAdjustSampleDistances(0);
    theirs->SetSampleDistance(0.5f);
    EXPECT_LT(GetDifference(weighted, this->Draw(theirs, four)), 1.0);
  }
  this->Mapper->SetIsoComponent(1);
  const auto second = this->Draw(this->Mapper, four);
  EXPECT_GT(GetDifference(second, plain), 1.0) << "one that is chosen is shown alone";
}

TEST_F(VolumeMapperOfComponents, DependentOnesAreColorsAndOpacities)
{
  this->Property->IndependentComponentsOff();
  this->Compare(MakeComponents<vtkFloatArray>(2), 0.1, "a value and an opacity");
  this->Compare(MakeComponents<vtkFloatArray>(4), 0.5, "a color and an opacity");
  this->Property->GetScalarOpacity(0)->RemoveAllPoints();
  this->Property->GetScalarOpacity(0)->AddPoint(50.0, 0.0);
  this->Property->GetScalarOpacity(0)->AddPoint(255.0, 0.4);
  this->Compare(MakeComponents<vtkUnsignedCharArray>(4, 255.0), 0.5, "bytes");
}

} // namespace
