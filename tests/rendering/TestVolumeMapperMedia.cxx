// SPDX-License-Identifier: BSD-3-Clause
// Volumes as media, beside those of VTK's mappers.
#include "VolumeMapperTest.h"

#include "vtkColorTransferFunction.h"
#include "vtkCommand.h"
#include "vtkDiscretizableColorTransferFunction.h"
#include "vtkFixedPointVolumeRayCastMapper.h"
#include "vtkGPUVolumeRayCastMapper.h"
#include "vtkPiecewiseFunction.h"
#include "vtkTestErrorObserver.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVolumeProperty.h"

#include <cmath>
#include <cstdlib>
#include <string>

namespace
{

/// The mean difference of two pictures' channels, in 255ths.
double GetDifference(vtkUnsignedCharArray* one, vtkUnsignedCharArray* other)
{
  double sum = 0.0;
  for (vtkIdType value = 0; value < one->GetNumberOfValues(); ++value)
  {
    sum += std::abs(one->GetValue(value) - other->GetValue(value));
  }
  return sum / static_cast<double>(one->GetNumberOfValues());
}

/// The ball with several components: values in [0, `most`] that have their largest at other places, and small ones between.
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
  vtkNew<vtkColorTransferFunction> colors;
  colors->AddRGBPoint(0.0, 0.9, 0.2, 0.1);
  colors->AddRGBPoint(0.5, 0.2, 0.9, 0.3);
  vtkNew<vtkPiecewiseFunction> opacity;
  // Nothing at the volume's border, where VTK's gradients are half as large across.
  opacity->AddPoint(0.0, 0.8);
  opacity->AddPoint(0.3, 0.4);
  opacity->AddPoint(0.44, 0.0);
  vtkNew<vtkPiecewiseFunction> gradientOpacity;
  gradientOpacity->AddPoint(0.0, 0.0);
  gradientOpacity->AddPoint(0.1, 0.5);
  vtkNew<vtkVolumeProperty> property;
  property->SetInterpolationTypeToLinear();
  property->SetColor(colors);
  property->SetScalarOpacity(opacity);
  property->SetScalarOpacityUnitDistance(4.0);
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

/// Beside the logarithms of the values with functions that are linear in these.
TEST_F(VolumeMapper, LowDecadesOfALogarithmicMapAreSeen)
{
  const double nodes[][3] = { { 0.0, 0.9, 0.0 }, { 0.3, 0.2, 0.0 }, { 0.5, 0.2, 0.9 },
    { 0.7, 0.4, 0.0 }, { 2.5, 0.6, 0.0 }, { 3.0, 0.9, 0.5 }, { 3.5, 0.5, 0.0 }, { 5.0, 0.3, 0.0 } };
  this->Place();
  this->Renderer->AddVolume(this->Volume);
  vtkNew<vtkDSMVolumeMapper> mapper;
  vtkSmartPointer<vtkUnsignedCharArray> pictures[2];
  for (const bool isLogarithmic : { false, true })
  {
    const auto image = MakeBall();
    vtkDataArray* const values = image->GetPointData()->GetScalars();
    vtkNew<vtkDiscretizableColorTransferFunction> colors;
    colors->DiscretizeOff();
    vtkNew<vtkPiecewiseFunction> opacity;
    const auto get = [=](double exponent)
    { return isLogarithmic ? std::pow(10.0, exponent) : exponent; };
    for (vtkIdType point = 0; point < values->GetNumberOfTuples(); ++point)
    {
      values->SetTuple1(point, get(std::min(6.0 * values->GetTuple1(point), 5.0)));
    }
    for (const auto& node : nodes)
    {
      colors->AddRGBPoint(get(node[0]), node[1], 1.0 - node[1], 0.3);
      opacity->AddPoint(get(node[0]), node[2]);
    }
    colors->SetUseLogScale(isLogarithmic);
    opacity->SetUseLogScale(isLogarithmic);
    vtkNew<vtkVolumeProperty> property;
    property->SetColor(colors);
    property->SetScalarOpacity(opacity);
    this->Volume->SetProperty(property);
    mapper->SetInputDataObject(image);
    this->Volume->SetMapper(mapper);
    this->Window->Render();
    vtkNew<vtkUnsignedCharArray> pixels;
    this->Window->GetPixelData(0, 0, Size - 1, Size - 1, 0, pixels);
    pictures[isLogarithmic ? 1 : 0] = pixels;
  }
  EXPECT_LT(GetDifference(pictures[0], pictures[1]), 0.8);
  this->Volume->SetMapper(this->Mapper); // the other one goes
}

TEST_F(VolumeMapper, SaysWhatMediaDoNotHave)
{
  this->Mapper->SetNumberOfIsoValues(0);
  this->Renderer->AddVolume(this->Volume);
  vtkNew<vtkTest::ErrorObserver> observer;
  this->Mapper->AddObserver(vtkCommand::ErrorEvent, observer);
  this->Mapper->AddObserver(vtkCommand::WarningEvent, observer);
  this->Window->Render();
  EXPECT_NE(observer->GetWarningMessage().find("InterpolationTypeToLinear"), std::string::npos)
    << "VTK's default is the nearest sample";
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
  categories->IndexedLookupOff();
  this->Window->Render();
  EXPECT_FALSE(observer->GetError() || observer->GetWarning());
  this->Volume->GetProperty()->ShadeOn();
  this->Window->Render();
  EXPECT_FALSE(observer->GetError() || observer->GetWarning());
  this->Volume->GetProperty()->SetTransferFunctionModeTo2D();
  this->Window->Render();
  EXPECT_NE(observer->GetWarningMessage().find("two-dimensional"), std::string::npos);
  this->Volume->GetProperty()->SetTransferFunctionModeTo1D();
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
