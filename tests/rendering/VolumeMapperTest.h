// SPDX-License-Identifier: BSD-3-Clause
#ifndef VolumeMapperTest_h
#define VolumeMapperTest_h

#include "vtkDSMMemoryOptions.h"
#include "vtkDSMScene.h"
#include "vtkDSMVolumeMapper.h"

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkFlyingEdges3D.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPlaneCollection.h"
#include "vtkPointData.h"
#include "vtkPolyDataMapper.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSmartPointer.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVolume.h"
#include "vtkVolumeMapper.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <vector>

/// Of the window.
constexpr int Size = 200;
/// Of the volume, in cells.
constexpr int Edge = 32;

/// The distance from the middle, over the edge; and the distance along x.
inline vtkSmartPointer<vtkImageData> MakeBall()
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetExtent(-Edge / 2, Edge / 2, -Edge / 2, Edge / 2, -Edge / 2, Edge / 2);
  image->SetSpacing(1.0, 1.0, 0.5);
  vtkNew<vtkDoubleArray> distance;
  distance->SetName("distance");
  for (int k = -Edge / 2; k <= Edge / 2; ++k)
  {
    for (int j = -Edge / 2; j <= Edge / 2; ++j)
    {
      for (int i = -Edge / 2; i <= Edge / 2; ++i)
      {
        distance->InsertNextValue(std::sqrt(double(i * i + j * j + k * k)) / Edge);
      }
    }
  }
  image->GetPointData()->SetScalars(distance);
  return image;
}

/// The mean difference of two pictures' channels, in 255ths.
inline double GetDifference(vtkUnsignedCharArray* one, vtkUnsignedCharArray* other)
{
  double sum = 0.0;
  for (vtkIdType value = 0; value < one->GetNumberOfValues(); ++value)
  {
    sum += std::abs(one->GetValue(value) - other->GetValue(value));
  }
  return sum / static_cast<double>(one->GetNumberOfValues());
}

/// A ball in a window of its own.
class VolumeMapper : public testing::Test
{
protected:
  VolumeMapper()
    : Scene(vtkDSMScene::ForRenderer(this->Renderer))
  {
    this->Window->SetOffScreenRendering(1);
    this->Window->SetMultiSamples(0);
    this->Window->SetSize(Size, Size);
    this->Window->AddRenderer(this->Renderer);
    this->Mapper->SetInputData(MakeBall());
    this->Mapper->SetIsoArray("distance");
    this->Mapper->SetIsoValue(0, 0.4);
    this->Mapper->GetMemoryOptions()->SetNumberOfThreads(2);
    this->Volume->SetMapper(this->Mapper);
    this->Renderer->GetActiveCamera()->SetPosition(20.0, 30.0, 60.0);
    this->Renderer->GetActiveCamera()->SetFocalPoint(0.0, 0.0, 0.0);
    this->Renderer->ResetCameraClippingRange(-16.0, 16.0, -16.0, 16.0, -16.0, 16.0);
  }

  /// Advances the scene for a few milliseconds.
  bool AdvanceShortly()
  {
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(3);
    return this->Scene->Advance([=] { return std::chrono::steady_clock::now() < end; });
  }

  /// Draws the ball with another mapper of the volume; returns the colors of the window's pixels.
  vtkSmartPointer<vtkUnsignedCharArray> Draw(vtkVolumeMapper* mapper)
  {
    return this->Draw(mapper, MakeBall());
  }
  vtkSmartPointer<vtkUnsignedCharArray> Draw(vtkVolumeMapper* mapper, vtkDataObject* data)
  {
    mapper->SetInputDataObject(data);
    this->Volume->SetMapper(mapper);
    this->Window->Render();
    auto pixels = vtkSmartPointer<vtkUnsignedCharArray>::New();
    this->Window->GetPixelData(0, 0, Size - 1, Size - 1, 0, pixels);
    return pixels;
  }

  /// Distances from the eye along the view direction; infinite where nothing was drawn.
  std::vector<double> RenderDistances()
  {
    this->Window->Render();
    vtkNew<vtkFloatArray> depths;
    this->Window->GetZbufferData(0, 0, Size - 1, Size - 1, depths);
    double nearest;
    double farthest;
    this->Renderer->GetActiveCamera()->GetClippingRange(nearest, farthest);
    std::vector<double> distances;
    for (vtkIdType pixel = 0; pixel < depths->GetNumberOfTuples(); ++pixel)
    {
      const double depth = depths->GetValue(pixel);
      distances.push_back(
        depth < 1.0 ? nearest * farthest / (farthest - depth * (farthest - nearest)) : INFINITY);
    }
    return distances;
  }

  /// The depth in [0, 1] of what is so far away.
  double GetDepth(double distance)
  {
    double nearest;
    double farthest;
    this->Renderer->GetActiveCamera()->GetClippingRange(nearest, farthest);
    return (farthest - nearest * farthest / distance) / (farthest - nearest);
  }

  void Place()
  {
    this->Volume->SetPosition(1.0, 2.0, 3.0);
    this->Volume->RotateY(30.0);
  }

  std::vector<double> RenderTraced()
  {
    this->Renderer->AddVolume(this->Volume);
    std::vector<double> distances = this->RenderDistances();
    this->Renderer->RemoveVolume(this->Volume);
    return distances;
  }

  /// The same surface as triangles that VTK draws, where the volume is.
  std::vector<double> RenderTriangles(vtkPlaneCollection* clippingPlanes = nullptr)
  {
    vtkNew<vtkFlyingEdges3D> edges;
    edges->SetInputData(MakeBall());
    edges->SetValue(0, 0.4);
    vtkNew<vtkPolyDataMapper> triangleMapper;
    triangleMapper->SetInputConnection(edges->GetOutputPort());
    triangleMapper->ScalarVisibilityOff();
    triangleMapper->SetClippingPlanes(clippingPlanes);
    vtkNew<vtkActor> actor;
    actor->SetMapper(triangleMapper);
    actor->SetPosition(this->Volume->GetPosition());
    actor->SetOrientation(this->Volume->GetOrientation());
    this->Renderer->AddActor(actor);
    std::vector<double> distances = this->RenderDistances();
    this->Renderer->RemoveActor(actor);
    return distances;
  }

  vtkNew<vtkRenderer> Renderer;
  vtkNew<vtkRenderWindow> Window;
  vtkSmartPointer<vtkDSMScene> Scene;
  vtkNew<vtkDSMVolumeMapper> Mapper;
  vtkNew<vtkVolume> Volume;
};

inline int CountCovered(const std::vector<double>& distances)
{
  return static_cast<int>(std::count_if(
    distances.begin(), distances.end(), [](double distance) { return std::isfinite(distance); }));
}

#endif
