// SPDX-License-Identifier: BSD-3-Clause
// Translucent geometry of VTK inside a medium, against the analytic color.
#include "VolumeMapperTest.h"

#include "vtkCellData.h"
#include "vtkColorTransferFunction.h"
#include "vtkNonOverlappingAMR.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPlaneSource.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkUniformGrid.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVolumeProperty.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <limits>
#include <utility>

namespace
{

/// A translucent parallelogram without light.
struct Sheet
{
  glm::dvec3 Corner;
  glm::dvec3 Sides[2];
  glm::dvec3 Color;
  double Opacity;

  /// T where a ray meets it; infinite: nowhere.
  double Meet(const glm::dvec3& origin, const glm::dvec3& direction) const
  {
    const glm::dvec3 normal = glm::cross(this->Sides[0], this->Sides[1]);
    const double t = glm::dot(this->Corner - origin, normal) / glm::dot(direction, normal);
    const glm::dvec3 place = origin + t * direction - this->Corner;
    bool isInside = true;
    for (const glm::dvec3& side : this->Sides)
    {
      const double part = glm::dot(place, side) / glm::dot(side, side);
      isInside = isInside && part >= 0.0 && part <= 1.0;
    }
    return isInside ? t : std::numeric_limits<double>::infinity();
  }
};

} // namespace

/// The ball's box full of fog.
class VolumeMapperFog : public VolumeMapper
{
protected:
  VolumeMapperFog()
  {
    const vtkSmartPointer<vtkImageData> image = MakeBall();
    vtkDataArray* const values = image->GetPointData()->GetScalars();
    values->FillComponent(0, 0.5);
    image->GetBounds(this->Bounds);
    vtkNew<vtkColorTransferFunction> colors;
    colors->AddRGBPoint(0.0, FogColor.x, FogColor.y, FogColor.z);
    colors->AddRGBPoint(1.0, FogColor.x, FogColor.y, FogColor.z);
    vtkNew<vtkPiecewiseFunction> opacity;
    opacity->AddPoint(0.0, FogOpacity);
    opacity->AddPoint(1.0, FogOpacity);
    vtkNew<vtkVolumeProperty> property;
    property->SetScalarOpacity(opacity);
    property->SetColor(colors);
    this->Mapper->SetNumberOfIsoValues(0);
    this->Mapper->SetInputData(image);
    this->Volume->SetProperty(property);
    this->Renderer->AddVolume(this->Volume);
    this->Renderer->SetUseDepthPeeling(1);
    this->Renderer->SetBackground(0.1, 0.2, 0.3);
    this->Window->SetAlphaBitPlanes(1);
  }

  void Add(const Sheet& sheet)
  {
    vtkNew<vtkPlaneSource> plane;
    const glm::dvec3 ends[2] = { sheet.Corner + sheet.Sides[0], sheet.Corner + sheet.Sides[1] };
    plane->SetOrigin(sheet.Corner.x, sheet.Corner.y, sheet.Corner.z);
    plane->SetPoint1(ends[0].x, ends[0].y, ends[0].z);
    plane->SetPoint2(ends[1].x, ends[1].y, ends[1].z);
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputConnection(plane->GetOutputPort());
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    actor->GetProperty()->LightingOff();
    actor->GetProperty()->SetColor(sheet.Color.x, sheet.Color.y, sheet.Color.z);
    actor->GetProperty()->SetOpacity(sheet.Opacity);
    this->Renderer->AddActor(actor);
    this->Sheets.push_back(sheet);
  }

  /// In 255ths: the mean difference of the picture's channels from the analytic colors.
  double GetError()
  {
    this->Window->Render();
    vtkNew<vtkUnsignedCharArray> pixels;
    this->Window->GetPixelData(0, 0, Size - 1, Size - 1, 0, pixels);
    double sum = 0.0;
    for (int pixel = 0; pixel < Size * Size; ++pixel)
    {
      const glm::dvec3 color = 255.0 * this->GetColor(pixel % Size, pixel / Size);
      for (int channel = 0; channel < 3; ++channel)
      {
        sum += std::abs(color[channel] - pixels->GetValue(3 * pixel + channel));
      }
    }
    return sum / (3.0 * Size * Size);
  }

private:
  glm::dvec3 GetWorld(double x, double y, double depth)
  {
    this->Renderer->SetDisplayPoint(x, y, depth);
    this->Renderer->DisplayToWorld();
    double point[4];
    this->Renderer->GetWorldPoint(point);
    return glm::dvec3(point[0], point[1], point[2]) / point[3];
  }

  glm::dvec3 GetColor(int x, int y)
  {
    const glm::dvec3 origin = this->GetWorld(x + 0.5, y + 0.5, 0.0);
    const glm::dvec3 direction = this->GetWorld(x + 0.5, y + 0.5, 1.0) - origin;
    double begin = 0.0;
    double end = 1.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double first = (this->Bounds[2 * axis] - origin[axis]) / direction[axis];
      const double second = (this->Bounds[2 * axis + 1] - origin[axis]) / direction[axis];
      begin = std::max(begin, std::min(first, second));
      end = std::min(end, std::max(first, second));
    }
    std::vector<std::pair<double, const Sheet*>> met;
    for (const Sheet& sheet : this->Sheets)
    {
      const double t = sheet.Meet(origin, direction);
      if (std::isfinite(t))
      {
        met.emplace_back(t, &sheet);
      }
    }
    std::sort(met.begin(), met.end());
    glm::dvec3 color(0.0);
    double left = 1.0;
    const auto pass = [&](const glm::dvec3& through, double opacity)
    {
      color += left * opacity * through;
      left *= 1.0 - opacity;
    };
    double before = begin;
    const auto passFog = [&](double until)
    {
      const double length = (std::clamp(until, before, std::max(before, end)) - before);
      pass(FogColor, 1.0 - std::pow(1.0 - FogOpacity, length * glm::length(direction)));
      before += length;
    };
    for (const auto& [t, sheet] : met)
    {
      passFog(t);
      pass(sheet->Color, sheet->Opacity);
    }
    passFog(end);
    return color + left * glm::dvec3(0.1, 0.2, 0.3);
  }

protected:
  /// The same box as AMR, finer in the middle.
  static vtkSmartPointer<vtkNonOverlappingAMR> MakeLevels()
  {
    auto amr = vtkSmartPointer<vtkNonOverlappingAMR>::New();
    const int counts[] = { 1, 1 };
    amr->Initialize(2, counts);
    for (unsigned int level = 0; level < 2; ++level)
    {
      const double spacing = level == 0 ? 2.0 : 1.0;
      const double half = level == 0 ? 16.0 : 8.0;
      vtkNew<vtkUniformGrid> grid;
      grid->SetDimensions(17, 17, 17);
      grid->SetOrigin(-half, -half, -0.5 * half);
      grid->SetSpacing(spacing, spacing, 0.5 * spacing);
      vtkNew<vtkDoubleArray> values;
      values->SetName("distance");
      values->SetNumberOfTuples(grid->GetNumberOfCells());
      values->FillComponent(0, 0.5);
      grid->GetCellData()->AddArray(values);
      amr->SetDataSet(level, 0, grid);
    }
    return amr;
  }

private:
  inline static const glm::dvec3 FogColor{ 0.9, 0.5, 0.1 };
  static constexpr double FogOpacity = 0.05;
  double Bounds[6];
  std::vector<Sheet> Sheets;
};

TEST_F(VolumeMapperFog, TranslucentGeometryIsWhereItIsInAMedium)
{
  EXPECT_LT(this->GetError(), 0.6) << "fog alone";
  this->Add(
    { { -12.0, -12.0, 1.0 }, { { 24.0, 0.0, 0.0 }, { 0.0, 24.0, 0.0 } }, { 0.1, 0.9, 0.4 }, 0.5 });
  EXPECT_LT(this->GetError(), 1.0) << "a plane";
  this->Add(
    { { -9.0, -12.0, -6.0 }, { { 18.0, 0.0, 12.0 }, { 0.0, 24.0, 0.0 } }, { 0.2, 0.2, 1.0 }, 0.4 });
  EXPECT_LT(this->GetError(), 1.0) << "two that cross";
  for (const double z : { -3.0, 4.0, 6.0 })
  {
    this->Add(
      { { -5.0, -9.0, z }, { { 9.0, 0.0, 0.0 }, { 0.0, 18.0, 0.0 } }, { 1.0, 1.0, 1.0 }, 0.2 });
  }
  EXPECT_LT(this->GetError(), 1.5) << "more than are told apart";
  this->Mapper->SetInputDataObject(MakeLevels());
  EXPECT_LT(this->GetError(), 1.5) << "in AMR";
  this->Scene->SetInteractiveReduction(4);
  this->Window->SetDesiredUpdateRate(10.0);
  EXPECT_LT(this->GetError(), 4.0) << "while the camera moves";
}

TEST_F(VolumeMapperFog, OpaqueGeometryBehindKeepsTheWindowOpaque)
{
  this->Renderer->SetUseDepthPeeling(0);
  this->Renderer->SetBackgroundAlpha(0.0);
  const auto getAlpha = [&]
  {
    this->Window->Render();
    vtkNew<vtkUnsignedCharArray> pixel;
    this->Window->GetRGBACharPixelData(Size / 2, Size / 2, Size / 2, Size / 2, 0, pixel);
    return static_cast<int>(pixel->GetValue(3));
  };
  const int alone = getAlpha();
  EXPECT_GT(alone, 100);
  EXPECT_LT(alone, 200);
  this->Add({ { -24.0, -24.0, -12.0 }, { { 48.0, 0.0, 0.0 }, { 0.0, 48.0, 0.0 } },
    { 0.1, 0.9, 0.4 }, 1.0 });
  EXPECT_EQ(getAlpha(), 255);
  this->Renderer->SetUseDepthPeeling(1);
  EXPECT_LT(this->GetError(), 1.0) << "the colors";
}
