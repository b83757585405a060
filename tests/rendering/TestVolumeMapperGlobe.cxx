// SPDX-License-Identifier: BSD-3-Clause
// A curvilinear grid that is closed: its first meridian is its last, and a row of its points is a pole.
#include "VolumeMapperCellsTest.h"

#include "vtkDSMLightOptions.h"
#include "vtkMath.h"
#include "vtkStructuredGrid.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace
{

using glm::dvec3;
using glm::ivec3;

/// Longitudes to 360 degrees, poles that are points, and more layers at the ground. The height is the value.
vtkSmartPointer<vtkStructuredGrid> MakeGlobe(int fineness)
{
  const ivec3 size(36 * fineness + 1, 18 * fineness + 1, 9);
  auto grid = vtkSmartPointer<vtkStructuredGrid>::New();
  grid->SetDimensions(size.x, size.y, size.z);
  vtkNew<vtkPoints> points;
  vtkNew<vtkDoubleArray> values;
  values->SetName("distance");
  for (int k = 0; k < size.z; ++k)
  {
    for (int j = 0; j < size.y; ++j)
    {
      for (int i = 0; i < size.x; ++i)
      {
        const double longitude = 2.0 * vtkMath::Pi() * (i % (size.x - 1)) / (size.x - 1);
        const double latitude = vtkMath::Pi() * (double(j) / (size.y - 1) - 0.5);
        const double wide = j == 0 || j == size.y - 1 ? 0.0 : std::cos(latitude);
        const double radius = 8.0 + 6.0 * std::pow(double(k) / (size.z - 1), 1.5);
        points->InsertNextPoint(radius * wide * std::cos(longitude),
          radius * wide * std::sin(longitude), radius * std::sin(latitude));
        values->InsertNextValue(radius / Edge);
      }
    }
  }
  grid->SetPoints(points);
  grid->GetPointData()->SetScalars(values);
  return grid;
}

} // namespace

TEST_F(VolumeMapperCells, AGlobeIsClosed)
{
  this->Mapper->SetIsoValue(0, 12.0 / Edge);
  const auto coarse = MakeGlobe(1);
  ExpectSame(this->Render(coarse), this->RenderContour(coarse));
  const auto globe = MakeGlobe(5);
  const std::vector<double> traced = this->Render(globe);
  ExpectSame(traced, this->RenderContour(globe));
  // No pixel is missing within its outline.
  for (int row = 0; row < Size; ++row)
  {
    int changes = 0;
    for (int column = 1; column < Size; ++column)
    {
      const auto pixel = static_cast<std::size_t>(row * Size + column);
      changes += std::isfinite(traced[pixel]) == std::isfinite(traced[pixel - 1]) ? 0 : 1;
    }
    EXPECT_LE(changes, 2) << "row " << row;
  }
}

TEST_F(VolumeMapperCells, AHeightOfAGlobeIsASphere)
{
  constexpr double radius = 12.0;
  constexpr double scale = 14.0;
  this->Mapper->SetIsoValue(0, radius / Edge);
  this->Mapper->GetLightOptions()->SetDebugView(vtkDSMLightOptions::Normal);
  this->Mapper->GetLightOptions()->SetShowLegend(false);
  vtkCamera* const camera = this->Renderer->GetActiveCamera();
  camera->ParallelProjectionOn();
  camera->SetParallelScale(scale);
  const auto globe = MakeGlobe(5);
  // At the first meridian, at a pole, and between.
  for (const dvec3& eye :
    { dvec3(60.0, 0.0, 0.0), dvec3(0.0, 0.0, 60.0), dvec3(25.0, -30.0, 45.0) })
  {
    SCOPED_TRACE(eye.z);
    const dvec3 front = glm::normalize(eye);
    const dvec3 right = glm::normalize(glm::cross(dvec3(0.2, 1.0, 0.3), front));
    const dvec3 up = glm::cross(front, right);
    camera->SetPosition(&eye.x);
    camera->SetViewUp(&up.x);
    const std::vector<double> traced = this->Render(globe);
    this->Renderer->AddVolume(this->Volume);
    const auto colors = this->Draw(this->Mapper, globe);
    this->Renderer->RemoveVolume(this->Volume);
    for (int pixel = 0; pixel < Size * Size; ++pixel)
    {
      const double x = scale * (2.0 * (pixel % Size + 0.5) / Size - 1.0);
      const double y = scale * (2.0 * (pixel / Size + 0.5) / Size - 1.0);
      const double away = std::hypot(x, y);
      if (std::abs(away - radius) > scale / Size) // half a pixel
      {
        ASSERT_EQ(std::isfinite(traced[static_cast<std::size_t>(pixel)]), away < radius)
          << "pixel " << pixel % Size << ", " << pixel / Size;
      }
      if (away < 0.9 * radius)
      {
        // The surface's normals are to lower values.
        const dvec3 outward =
          (x * right + y * up + std::sqrt(radius * radius - away * away) * front) / radius;
        for (int axis = 0; axis < 3; ++axis)
        {
          ASSERT_NEAR(colors->GetValue(3 * pixel + axis), 127.5 * (1.0 - outward[axis]), 1.5)
            << "pixel " << pixel % Size << ", " << pixel / Size << ", axis " << axis;
        }
      }
    }
  }
}
