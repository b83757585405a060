// SPDX-License-Identifier: BSD-3-Clause
#ifndef PolyDataMapperTest_h
#define PolyDataMapperTest_h

#include "vtkDSMMemoryOptions.h"
#include "vtkDSMPolyDataMapper.h"
#include "vtkDSMScene.h"

#include "vtkActor.h"
#include "vtkCallbackCommand.h"
#include "vtkCamera.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkElevationFilter.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSmartPointer.h"
#include "vtkSphereSource.h"
#include "vtkWindowToImageFilter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <initializer_list>
#include <vector>

/// Of the window.
constexpr int Size = 200;

/// Colors of the pixels, from the lower left one, three channels each.
using Picture = std::vector<int>;

/// A fine ball, whose point array grows along z.
inline vtkSmartPointer<vtkPolyData> MakeBall()
{
  vtkNew<vtkSphereSource> sphere;
  sphere->SetThetaResolution(60);
  sphere->SetPhiResolution(40);
  vtkNew<vtkElevationFilter> elevation;
  elevation->SetInputConnection(sphere->GetOutputPort());
  elevation->SetLowPoint(0.0, 0.0, -0.5);
  elevation->SetHighPoint(0.0, 0.0, 0.5);
  elevation->Update();
  auto ball = vtkSmartPointer<vtkPolyData>::New();
  ball->ShallowCopy(elevation->GetOutput());
  return ball;
}

inline vtkSmartPointer<vtkPolyData> MakeCells(const std::vector<std::array<double, 2>>& corners)
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  for (const auto& corner : corners)
  {
    points->InsertNextPoint(corner[0], corner[1], 0.0);
  }
  data->SetPoints(points);
  return data;
}

inline void Connect(vtkCellArray* cells, std::initializer_list<vtkIdType> points)
{
  cells->InsertNextCell(points);
}

/// An actor with our mapper in a window of its own, and what VTK's mapper draws of it.
class PolyDataMapper : public testing::Test
{
protected:
  PolyDataMapper()
    : Scene(vtkDSMScene::ForRenderer(this->Renderer))
  {
    this->Window->SetOffScreenRendering(1);
    this->Window->SetMultiSamples(0);
    this->Window->SetSize(Size, Size);
    this->Window->AddRenderer(this->Renderer);
    this->Mapper->GetMemoryOptions()->SetNumberOfThreads(2);
    this->Actor->SetMapper(this->Mapper);
    this->Renderer->AddActor(this->Actor);
    this->Renderer->GetActiveCamera()->SetPosition(0.3, 0.4, 3.0);
    this->Renderer->GetActiveCamera()->SetFocalPoint(0.0, 0.0, 0.0);
    this->Renderer->ResetCameraClippingRange(-1.0, 1.0, -1.0, 1.0, -1.0, 1.0);
    vtkNew<vtkCallbackCommand> progress;
    progress->SetClientData(this);
    progress->SetCallback([](vtkObject*, unsigned long, void* self, void*)
      { static_cast<PolyDataMapper*>(self)->Building = true; });
    this->Mapper->AddObserver(vtkCommand::ProgressEvent, progress);
  }

  Picture Render()
  {
    this->Building = false;
    vtkNew<vtkWindowToImageFilter> shot;
    shot->SetInput(this->Window);
    shot->ReadFrontBufferOff();
    shot->Update();
    vtkDataArray* colors = shot->GetOutput()->GetPointData()->GetScalars();
    Picture picture;
    for (vtkIdType pixel = 0; pixel < colors->GetNumberOfTuples(); ++pixel)
    {
      for (int channel = 0; channel < 3; ++channel)
      {
        picture.push_back(static_cast<int>(colors->GetComponent(pixel, channel)));
      }
    }
    return picture;
  }

  /// What VTK's own mapper draws with the same settings.
  Picture RenderWithTriangles(vtkPolyData* data)
  {
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->ShallowCopy(this->Mapper);
    mapper->SetInputData(data);
    this->Actor->SetMapper(mapper);
    Picture picture = this->Render();
    this->Actor->SetMapper(this->Mapper);
    return picture;
  }

  /// All but a part of the pixels must be alike.
  static void ExpectAlike(const Picture& a, const Picture& b, double share = 0.005)
  {
    ASSERT_EQ(a.size(), b.size());
    int covered = 0;
    int different = 0;
    for (std::size_t pixel = 0; pixel < a.size(); pixel += 3)
    {
      int largest = 0;
      for (int channel = 0; channel < 3; ++channel)
      {
        largest = std::max(largest, std::abs(a[pixel + channel] - b[pixel + channel]));
      }
      different += largest > 8;
      covered += b[pixel] + b[pixel + 1] + b[pixel + 2] > 0;
    }
    EXPECT_GT(covered, Size * Size / 50);
    EXPECT_LE(different, share * Size * Size);
  }

  static int CountCovered(const Picture& picture)
  {
    int covered = 0;
    for (std::size_t pixel = 0; pixel < picture.size(); pixel += 3)
    {
      covered += picture[pixel] + picture[pixel + 1] + picture[pixel + 2] > 0;
    }
    return covered;
  }

  vtkNew<vtkRenderer> Renderer;
  vtkNew<vtkRenderWindow> Window;
  vtkSmartPointer<vtkDSMScene> Scene;
  vtkNew<vtkDSMPolyDataMapper> Mapper;
  vtkNew<vtkActor> Actor;
  bool Building = false; ///< since Render began, bricks have been made
};

#endif
