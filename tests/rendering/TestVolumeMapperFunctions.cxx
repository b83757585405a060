// SPDX-License-Identifier: BSD-3-Clause
// Color and opacity functions of media, beside VTK's mappers and in ranges of any size.
#include "VolumeMapperTest.h"

#include "vtkColorTransferFunction.h"
#include "vtkDiscretizableColorTransferFunction.h"
#include "vtkGPUVolumeRayCastMapper.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPlane.h"
#include "vtkTestErrorObserver.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVolumeProperty.h"

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace
{

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
    property->SetInterpolationTypeToLinear();
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

/// Shows each kind of picture that a volume's functions define.
class VolumeMapperOfFunctions : public VolumeMapper
{
protected:
  VolumeMapperOfFunctions()
  {
    this->Opacity->AllowDuplicateScalarsOn();
    this->Property->SetInterpolationTypeToLinear();
    this->Property->SetColor(this->Colors);
    this->Property->SetScalarOpacity(this->Opacity);
    this->Volume->SetProperty(this->Property);
    this->Place();
    this->Renderer->AddVolume(this->Volume);
    this->Mapper->SetNumberOfIsoValues(0);
    this->Mapper->SetIsoArray("");
    vtkNew<vtkPlane> plane;
    plane->SetNormal(1.0, 0.2, 0.1);
    this->Mapper->AddClippingPlane(plane);
  }

  /// Sets the functions' nodes: values; red, and the opacity there.
  void SetNodes(const std::vector<std::array<double, 3>>& nodes)
  {
    this->Colors->RemoveAllPoints();
    this->Opacity->RemoveAllPoints();
    for (const auto& [value, red, opacity] : nodes)
    {
      this->Colors->AddRGBPoint(value, red, 1.0 - red, 0.3);
      this->Opacity->AddPoint(value, opacity);
    }
  }

  /// The medium, its faces, the largest and the smallest values, and the sum.
  std::vector<vtkSmartPointer<vtkUnsignedCharArray>> DrawAll(vtkImageData* image)
  {
    std::vector<vtkSmartPointer<vtkUnsignedCharArray>> pictures;
    this->Mapper->SetInputData(image);
    for (int kind = 0; kind < 5; ++kind)
    {
      this->Mapper->SetCapping(kind == 1);
      this->Mapper->SetCapOpacity(kind == 1);
      this->Mapper->SetBlendMode(kind == 2 ? vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND
          : kind == 3                      ? vtkVolumeMapper::MINIMUM_INTENSITY_BLEND
          : kind == 4                      ? vtkVolumeMapper::ADDITIVE_BLEND
                                           : vtkVolumeMapper::COMPOSITE_BLEND);
      this->Window->Render();
      vtkNew<vtkUnsignedCharArray> pixels;
      this->Window->GetPixelData(0, 0, Size - 1, Size - 1, 0, pixels);
      pictures.emplace_back(pixels);
    }
    return pictures;
  }

  vtkNew<vtkVolumeProperty> Property;
  vtkNew<vtkColorTransferFunction> Colors;
  vtkNew<vtkPiecewiseFunction> Opacity;
};

TEST_F(VolumeMapperOfFunctions, NarrowPeaksAreTheSameInAnyRange)
{
  this->Property->SetScalarOpacityUnitDistance(1e-3);
  // A quarter of an even bin of the data's range, or a hundredth of the functions'.
  const double width = 5e-5;
  std::vector<vtkSmartPointer<vtkUnsignedCharArray>> pictures[2];
  for (const bool isWide : { false, true })
  {
    this->SetNodes({ { isWide ? 0.0 : 0.4 - 49.0 * width, 0.2, 0.0 }, { 0.4, 0.2, 0.0 },
      { 0.4 + 0.5 * width, 0.2, 1.0 }, { 0.4 + width, 0.9, 0.0 },
      { isWide ? 1.0 : 0.4 + 50.0 * width, 0.9, 0.0 } });
    pictures[isWide ? 1 : 0] = this->DrawAll(MakeBall());
  }
  for (const int kind : { 0, 1 })
  {
    EXPECT_LT(GetDifference(pictures[0][kind], pictures[1][kind]), 0.1) << kind;
  }
  this->SetNodes({ { 0.0, 0.2, 0.0 }, { 1.0, 0.9, 0.0 } });
  EXPECT_GT(GetDifference(pictures[1][0], this->DrawAll(MakeBall())[0]), 5.0);
}

/// Beside the same colors as many straight lines.
TEST_F(VolumeMapperOfFunctions, LogarithmicMapsOfValuesBelowZeroHaveTheColorsOfTheLegend)
{
  const auto image = MakeBall();
  vtkDataArray* const values = image->GetPointData()->GetScalars();
  for (vtkIdType point = 0; point < values->GetNumberOfTuples(); ++point)
  {
    values->SetTuple1(point, 400.0 * values->GetTuple1(point) - 60.0);
  }
  this->Property->SetScalarOpacityUnitDistance(2.0);
  constexpr double first = 0.1;
  constexpr double last = 200.0;
  std::vector<vtkSmartPointer<vtkUnsignedCharArray>> pictures[2];
  for (const bool isLogarithmic : { false, true })
  {
    this->Colors->RemoveAllPoints();
    this->Colors->SetScale(isLogarithmic ? VTK_CTF_LOG10 : VTK_CTF_LINEAR);
    const int count = isLogarithmic ? 1 : 400;
    for (int node = 0; node <= count; ++node)
    {
      const double red = static_cast<double>(node) / count;
      this->Colors->AddRGBPoint(first * std::pow(last / first, red), red, 1.0 - red, 0.3);
    }
    this->Opacity->RemoveAllPoints();
    this->Opacity->AddPoint(-30.0, 0.3);
    this->Opacity->AddPoint(last, 0.1);
    pictures[isLogarithmic ? 1 : 0] = this->DrawAll(image);
  }
  for (int kind = 0; kind < 5; ++kind)
  {
    EXPECT_LT(GetDifference(pictures[0][kind], pictures[1][kind]), 0.3) << kind;
  }
  EXPECT_GT(GetDifference(pictures[1][0], pictures[1][2]), 5.0);
}

TEST_F(VolumeMapperOfFunctions, ColorsBelowAndAboveTheRangeAreThoseOfTheRayCastMapper)
{
  this->SetNodes({ { 0.2, 0.2, 0.3 }, { 0.4, 0.6, 0.3 } });
  const auto before = this->DrawAll(MakeBall());
  this->Colors->SetUseBelowRangeColor(true);
  this->Colors->SetBelowRangeColor(1.0, 0.0, 0.0);
  this->Colors->SetUseAboveRangeColor(true);
  this->Colors->SetAboveRangeColor(0.0, 0.1, 1.0);
  const auto after = this->DrawAll(MakeBall());
  for (int kind = 0; kind < 3; ++kind)
  {
    EXPECT_GT(GetDifference(before[kind], after[kind]), 5.0) << kind;
  }
  vtkNew<vtkGPUVolumeRayCastMapper> theirs;
  theirs->SetAutoAdjustSampleDistances(0);
  theirs->SetSampleDistance(0.1f);
  theirs->SetClippingPlanes(this->Mapper->GetClippingPlanes());
  EXPECT_LT(GetDifference(after[0], this->Draw(theirs)), 1.5);
  theirs->SetBlendModeToMaximumIntensity();
  EXPECT_LT(GetDifference(after[2], this->Draw(theirs)), 1.5);
  this->Volume->SetMapper(this->Mapper); // the other one goes
  // The ends of the range are in it.
  const auto image = MakeBall();
  for (const double end : { 0.2, 0.4 })
  {
    image->GetPointData()->GetScalars()->Fill(end);
    const auto inside = this->DrawAll(image);
    this->Colors->SetUseBelowRangeColor(false);
    this->Colors->SetUseAboveRangeColor(false);
    const auto plain = this->DrawAll(image);
    this->Colors->SetUseBelowRangeColor(true);
    this->Colors->SetUseAboveRangeColor(true);
    for (int kind = 0; kind < 3; ++kind)
    {
      EXPECT_LT(GetDifference(inside[kind], plain[kind]), 0.1) << kind << ", " << end;
    }
  }
}

TEST_F(VolumeMapperOfFunctions, TheMeanOfASingleValueIsThatOfTheRayCastMapper)
{
  this->SetNodes({ { 0.0, 0.2, 1.0 }, { 300.0, 0.9, 1.0 } });
  const auto image = MakeBall();
  image->GetPointData()->GetScalars()->Fill(255.0);
  this->Renderer->SetBackground(0.2, 0.5, 0.3);
  vtkNew<vtkGPUVolumeRayCastMapper> theirs;
  theirs->SetClippingPlanes(this->Mapper->GetClippingPlanes());
  vtkNew<vtkUnsignedCharArray> pictures[2];
  for (vtkVolumeMapper* const mapper :
    { static_cast<vtkVolumeMapper*>(theirs.Get()), static_cast<vtkVolumeMapper*>(this->Mapper) })
  {
    mapper->SetInputDataObject(image);
    mapper->SetBlendMode(vtkVolumeMapper::AVERAGE_INTENSITY_BLEND);
    this->Volume->SetMapper(mapper);
    this->Window->Render();
    this->Window->GetPixelData(
      0, 0, Size - 1, Size - 1, 0, pictures[mapper == theirs.Get() ? 0 : 1]);
  }
  EXPECT_LT(GetDifference(pictures[0], pictures[1]), 1.5);
}

TEST_F(VolumeMapperOfFunctions, WhereOnlyTheColorIsNotANumberItIsTheMapsColorForThat)
{
  this->SetNodes({ { 0.0, 1.0, 0.3 }, { 0.5, 1.0, 0.3 }, { 1.0, 0.0, 0.3 } });
  this->Colors->SetNanColor(0.0, 1.0, 0.3);
  this->Property->SetScalarOpacityUnitDistance(4.0);
  this->Mapper->SetOpacityArray("density");
  std::vector<vtkSmartPointer<vtkUnsignedCharArray>> pictures;
  for (const double value : { 1.0, std::nan("") })
  {
    const auto image = MakeBall();
    vtkDataArray* const values = image->GetPointData()->GetScalars();
    vtkNew<vtkDoubleArray> density;
    density->SetName("density");
    for (vtkIdType point = 0; point < values->GetNumberOfTuples(); ++point)
    {
      values->SetTuple1(point, image->GetPoint(point)[1] > 0.0 ? value : 0.5);
      density->InsertNextValue(0.5);
    }
    image->GetPointData()->AddArray(density);
    pictures.push_back(this->DrawAll(image)[0]);
  }
  this->Mapper->SetOpacityArray("");
  EXPECT_LT(GetDifference(pictures[0], pictures[1]), 2.0);
  EXPECT_GT(pictures[1]->GetRange(1)[1], 100.0) << "green is seen";
}

/// Labels 9 and 1 in shells, and 0 outside, with functions that have a color for 5, too.
class VolumeMapperOfLabels : public VolumeMapper
{
protected:
  VolumeMapperOfLabels()
  {
    vtkDataArray* const values = this->Image->GetPointData()->GetScalars();
    for (vtkIdType point = 0; point < values->GetNumberOfTuples(); ++point)
    {
      const double distance = values->GetTuple1(point);
      values->SetTuple1(point, distance < 0.2 ? 9.0 : distance < 0.35 ? 1.0 : 0.0);
    }
    this->SetColor(0, 0.0, { 0.0, 0.0, 0.0, 1.0 });
    this->SetColor(1, 1.0, { 1.0, 0.0, 0.0, 1.0 });
    this->SetColor(2, 5.0, { 0.0, 1.0, 0.0, 1.0 });
    this->SetColor(3, 9.0, { 0.0, 0.0, 1.0, 1.0 });
    this->Opacity->AddPoint(0.0, 0.0);
    // Level at the label: VTK's table of opacities is not exact where they rise.
    this->Opacity->AddPoint(0.4, 0.0);
    this->Opacity->AddPoint(0.6, 0.1);
    this->Opacity->AddPoint(1.4, 0.1);
    this->Opacity->AddPoint(9.0, 0.3);
    this->Property->SetColor(this->Colors);
    this->Property->SetScalarOpacity(this->Opacity);
    this->Volume->SetProperty(this->Property);
    this->Place();
    this->Renderer->AddVolume(this->Volume);
    this->Mapper->SetNumberOfIsoValues(0);
  }

  void SetColor(unsigned int index, double label, const std::array<double, 4>& color)
  {
    this->Colors->AddRGBPoint(label, color[0], color[1], color[2]);
    this->Colors->SetAnnotation(label, "label " + std::to_string(index));
    this->Colors->SetIndexedColorRGBA(index, color.data());
  }

  /// The largest of a channel.
  static double FindMost(vtkUnsignedCharArray* pixels, int channel)
  {
    return pixels->GetRange(channel)[1];
  }

  vtkSmartPointer<vtkImageData> Image = MakeBall();
  vtkNew<vtkVolumeProperty> Property;
  vtkNew<vtkDiscretizableColorTransferFunction> Colors;
  vtkNew<vtkPiecewiseFunction> Opacity;
};

TEST_F(VolumeMapperOfLabels, AreThoseOfTheRayCastMapper)
{
  vtkNew<vtkGPUVolumeRayCastMapper> theirs;
  theirs->SetAutoAdjustSampleDistances(0);
  theirs->SetSampleDistance(0.03f);
  const auto expected = this->Draw(theirs, this->Image);
  EXPECT_GT(FindMost(expected, 0), 100.0);
  EXPECT_GT(FindMost(expected, 2), 50.0);
  const auto nearest = this->Draw(this->Mapper, this->Image);
  EXPECT_LT(GetDifference(nearest, expected), 0.5);
  EXPECT_EQ(FindMost(nearest, 1), 0.0) << "no sample has the green label";
  this->Property->SetInterpolationTypeToLinear();
  EXPECT_GT(FindMost(this->Draw(this->Mapper, this->Image), 1), 5.0);
  // Categories are never interpolated.
  this->Colors->IndexedLookupOn();
  const auto categories = this->Draw(this->Mapper, this->Image);
  EXPECT_LT(GetDifference(categories, nearest), 0.01);
  EXPECT_EQ(FindMost(categories, 1), 0.0);
}

TEST_F(VolumeMapperOfLabels, EachHasAColorAndAnOpacity)
{
  this->Colors->IndexedLookupOn();
  this->SetColor(1, 1.0, { 1.0, 0.0, 0.0, 0.0 });
  const auto without = this->Draw(this->Mapper, this->Image);
  EXPECT_EQ(FindMost(without, 0), 0.0) << "the red label is hidden";
  EXPECT_GT(FindMost(without, 2), 100.0);
  // The same by the opacity function.
  this->SetColor(1, 1.0, { 1.0, 0.0, 0.0, 1.0 });
  this->Opacity->AddPoint(1.0, 0.0);
  EXPECT_LT(GetDifference(this->Draw(this->Mapper, this->Image), without), 0.01);
  // A label without an annotation has the look of NaN.
  this->Colors->SetAnnotations(nullptr, nullptr);
  for (const double label : { 0.0, 1.0, 5.0 })
  {
    this->Colors->SetAnnotation(label, "known");
  }
  this->Colors->SetNanColor(0.0, 1.0, 0.0);
  EXPECT_LT(FindMost(this->Draw(this->Mapper, this->Image), 2), 1.0);
  EXPECT_NEAR(FindMost(this->Draw(this->Mapper, this->Image), 1), FindMost(without, 2), 1.0);
  this->Colors->SetNanOpacity(0.0);
  EXPECT_EQ(FindMost(this->Draw(this->Mapper, this->Image), 1), 0.0);
}

TEST_F(VolumeMapperOfLabels, FacesOfCutsShowThem)
{
  this->Colors->IndexedLookupOn();
  vtkNew<vtkPlane> plane;
  plane->SetNormal(-0.3, -0.31, -0.9);
  this->Mapper->AddClippingPlane(plane);
  this->Mapper->CappingOn();
  this->Mapper->CapOpacityOff();
  const auto pixels = this->Draw(this->Mapper, this->Image);
  for (vtkIdType pixel = 0; pixel < pixels->GetNumberOfTuples(); ++pixel)
  {
    ASSERT_EQ(pixels->GetTypedComponent(pixel, 1), 0) << pixel;
  }
  EXPECT_EQ(FindMost(pixels, 0), 255.0);
  EXPECT_EQ(FindMost(pixels, 2), 255.0);
}

/// A function of the value and of a second number, beside VTK's mapper, which applies an opacity to each sample.
class VolumeMapperOfFunctions2D : public VolumeMapper
{
protected:
  static constexpr double Step = 0.1;

  VolumeMapperOfFunctions2D()
  {
    vtkDataArray* const values = this->Image->GetPointData()->GetScalars();
    vtkNew<vtkFloatArray> seconds;
    seconds->SetName("second");
    for (vtkIdType point = 0; point < values->GetNumberOfTuples(); ++point)
    {
      const double* const p = this->Image->GetPoint(point);
      const double wave = 0.7 + 0.3 * std::sin(0.4 * p[0]) * std::cos(0.5 * p[1] + 0.3 * p[2]);
      const double inside = std::max(0.0, 1.0 - 2.1 * values->GetTuple1(point));
      values->SetTuple1(point, 200.0 * wave * inside - 30.0);
      seconds->InsertNextValue(
        static_cast<float>(3.0 + std::sin(0.3 * p[0] + 0.2 * p[1]) + 0.1 * p[2]));
    }
    this->Image->GetPointData()->AddArray(seconds);
    this->Function->SetDimensions(40, 24, 1);
    this->Function->AllocateScalars(VTK_FLOAT, 4);
    // No mapper looks at these.
    this->Function->SetOrigin(-7.0, 9.0, 0.0);
    this->Function->SetSpacing(11.0, 0.1, 1.0);
    this->Fill(0.03);
    this->Property->SetInterpolationTypeToLinear();
    this->Property->SetTransferFunction2D(this->Function);
    this->Property->SetTransferFunctionModeTo2D();
    this->Property->SetScalarOpacityUnitDistance(Step);
    this->Volume->SetProperty(this->Property);
    this->Place();
    this->Renderer->AddVolume(this->Volume);
    this->Mapper->SetNumberOfIsoValues(0);
    this->Mapper->SetIsoArray("");
  }
  ~VolumeMapperOfFunctions2D() override { this->Volume->SetMapper(this->Mapper); }

  /// A red box of a few texels, and green that grows with the second number.
  void Fill(double opacity)
  {
    for (int row = 0; row < 24; ++row)
    {
      for (int column = 0; column < 40; ++column)
      {
        const bool isBox = column > 10 && column < 18 && row > 2 && row < 12;
        const bool isRest = column > 21;
        const double look[4] = { isBox ? 1.0 : 0.0, isRest ? 0.9 : 0.0, isRest ? row / 30.0 : 0.2,
          isBox      ? opacity
            : isRest ? opacity * row / 24.0
                     : 0.0 };
        for (int channel = 0; channel < 4; ++channel)
        {
          this->Function->SetScalarComponentFromDouble(column, row, 0, channel, look[channel]);
        }
      }
    }
    this->Function->Modified();
  }

  vtkSmartPointer<vtkUnsignedCharArray> DrawTheirs(const char* second)
  {
    vtkNew<vtkGPUVolumeRayCastMapper> theirs;
    theirs->SetAutoAdjustSampleDistances(0);
    theirs->SetSampleDistance(Step);
    theirs->SetTransfer2DYAxisArray(second);
    return this->Draw(theirs, this->Image);
  }
  vtkSmartPointer<vtkUnsignedCharArray> DrawOurs(const char* second)
  {
    this->Mapper->SetTransfer2DYAxisArray(second);
    return this->Draw(this->Mapper, this->Image);
  }

  vtkSmartPointer<vtkImageData> Image = MakeBall();
  vtkNew<vtkImageData> Function;
  vtkNew<vtkVolumeProperty> Property;
};

TEST_F(VolumeMapperOfFunctions2D, AreThoseOfTheRayCastMapper)
{
  vtkSmartPointer<vtkUnsignedCharArray> before;
  for (const char* const second : { static_cast<const char*>(nullptr), "second" })
  {
    const auto ours = this->DrawOurs(second);
    EXPECT_GT(ours->GetRange(0)[1], 100.0) << "the red box is seen";
    EXPECT_GT(ours->GetRange(1)[1], 100.0) << "green is seen";
    // VTK takes differences over 33 / 32 of a cell for those over a cell.
    EXPECT_LT(GetDifference(ours, this->DrawTheirs(second)), second ? 1.0 : 2.0);
    this->Property->ShadeOn();
    const auto shaded = this->DrawOurs(second);
    EXPECT_GT(GetDifference(shaded, ours), 2.0);
    EXPECT_LT(GetDifference(shaded, this->DrawTheirs(second)), 1.5)
      << (second ? second : "gradient");
    this->Property->ShadeOff();
    EXPECT_TRUE(!before || GetDifference(before, ours) > 2.0);
    before = ours;
  }
  // The same image with other texels.
  this->Fill(0.1);
  const auto denser = this->DrawOurs("second");
  EXPECT_GT(GetDifference(denser, before), 5.0);
  EXPECT_LT(GetDifference(denser, this->DrawTheirs("second")), 1.0);
  // Samples that are not interpolated have texels that are not.
  this->Property->SetInterpolationTypeToNearest();
  EXPECT_LT(GetDifference(this->DrawOurs("second"), this->DrawTheirs("second")), 2.0);
}

TEST_F(VolumeMapperOfFunctions2D, GiveWayToOthersWithAWarning)
{
  vtkNew<vtkTest::ErrorObserver> observer;
  this->Mapper->AddObserver(vtkCommand::WarningEvent, observer);
  const auto expected = this->DrawOurs(nullptr);
  EXPECT_FALSE(observer->GetWarning()) << observer->GetWarningMessage();
  this->Mapper->SetOpacityArray("second");
  EXPECT_EQ(GetDifference(this->DrawOurs(nullptr), expected), 0.0);
  EXPECT_NE(observer->GetWarningMessage().find("opacities from another array"), std::string::npos);
  this->Mapper->SetOpacityArray("");
  // As VTK's mapper, which takes gradients where an array is missing.
  EXPECT_EQ(GetDifference(this->DrawOurs("none"), expected), 0.0);
  EXPECT_NE(observer->GetWarningMessage().find("none"), std::string::npos);
  observer->Clear();
  this->Mapper->SetBlendModeToMaximumIntensity();
  this->DrawOurs(nullptr);
  EXPECT_NE(observer->GetWarningMessage().find("two-dimensional"), std::string::npos);
  this->Mapper->SetBlendModeToComposite();
  this->Property->SetTransferFunction2D(nullptr);
  vtkNew<vtkVolumeProperty> other;
  other->SetTransferFunctionModeTo2D();
  this->Volume->SetProperty(other);
  observer->Clear();
  this->DrawOurs(nullptr);
  EXPECT_NE(observer->GetWarningMessage().find("SetTransferFunction2D"), std::string::npos);
}

} // namespace
