// SPDX-License-Identifier: BSD-3-Clause
// Pictures without a window: what a window shows, and the same where there is no display.
// usage: TestTraceImage window FILE   draws in both ways, compares, and keeps the picture in FILE
//        TestTraceImage image FILE    draws without a window, on any number of ranks, and compares with FILE
#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkCommand.h"
#include "vtkCommunicator.h"
#include "vtkDSMLightOptions.h"
#include "vtkDSMMemoryOptions.h"
#include "vtkDSMPolyDataMapper.h"
#include "vtkDSMSampleVolume.h"
#include "vtkDSMScene.h"
#include "vtkDSMVolumeMapper.h"
#include "vtkFloatArray.h"
#include "vtkFlyingEdges3D.h"
#include "vtkImageData.h"
#include "vtkMPIController.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkProperty.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSphereSource.h"
#include "vtkTestErrorObserver.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVolume.h"
#include "vtkWindowToImageFilter.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>

namespace
{

constexpr int Width = 163;
constexpr int Height = 121;

bool Failed = false;

void Expect(bool holds, const char* what)
{
  std::cout << (holds ? "ok: " : "FAILED: ") << what << std::endl;
  Failed = Failed || !holds;
}

/// An isosurface, of which each rank has a part, a translucent ball, lit by the automatic headlight.
class Stage
{
public:
  Stage()
  {
    this->Source->SetDimensions(40, 40, 40);
    this->Mapper->SetInputConnection(this->Source->GetOutputPort());
    this->Mapper->SetIsoValue(0, 0.5);
    this->Mapper->GetSurfaceProperty()->SetColor(0.9, 0.7, 0.3);
    this->Mapper->GetLightOptions()->ShadowsOn();
    this->Volume->SetMapper(this->Mapper);
    this->Renderer->AddVolume(this->Volume);
    this->Renderer->SetBackground(0.2, 0.4, 0.6);
    vtkCamera* camera = this->Renderer->GetActiveCamera();
    camera->SetPosition(2.5, 1.8, 3.2);
    camera->SetClippingRange(0.5, 20.0);
    this->Scene = vtkDSMScene::ForRenderer(this->Renderer);
    this->Scene->DeliverEverywhere();
  }

  void AddBall(int rank)
  {
    // All of it on one rank.
    vtkNew<vtkSphereSource> ball;
    ball->SetRadius(0.6);
    ball->SetCenter(0.4, 0.5, 0.9);
    ball->Update();
    this->BallMapper->SetInputData(rank == 0 ? ball->GetOutput() : this->Empty.Get());
    this->Ball->SetMapper(this->BallMapper);
    this->Ball->GetProperty()->SetOpacity(0.5);
    this->Renderer->AddActor(this->Ball);
  }

  vtkNew<vtkDSMSampleVolume> Source;
  vtkNew<vtkDSMVolumeMapper> Mapper;
  vtkNew<vtkVolume> Volume;
  vtkNew<vtkPolyData> Empty;
  vtkNew<vtkDSMPolyDataMapper> BallMapper;
  vtkNew<vtkActor> Ball;
  vtkNew<vtkRenderer> Renderer;
  vtkSmartPointer<vtkDSMScene> Scene;
};

std::string GetColors(vtkImageData* image)
{
  auto* colors = vtkUnsignedCharArray::SafeDownCast(image->GetPointData()->GetScalars());
  return colors ? std::string(reinterpret_cast<const char*>(colors->GetPointer(0)),
                    static_cast<std::size_t>(colors->GetNumberOfValues()))
                : std::string();
}

/// RGBA of a window's picture, of which alpha means nothing.
std::string Draw(vtkRenderWindow* window)
{
  window->Render();
  vtkNew<vtkWindowToImageFilter> picture;
  picture->SetInput(window);
  picture->SetInputBufferTypeToRGBA();
  picture->ReadFrontBufferOff();
  picture->ShouldRerenderOff();
  picture->Update();
  return GetColors(picture->GetOutput());
}

int GetDifference(const std::string& a, const std::string& b)
{
  int largest = a.size() == b.size() ? 0 : 255;
  for (std::size_t byte = 0; byte < a.size() && byte < b.size(); ++byte)
  {
    const int difference =
      std::abs(static_cast<unsigned char>(a[byte]) - static_cast<unsigned char>(b[byte]));
    largest = byte % 4 == 3 ? largest : std::max(largest, difference);
  }
  return largest;
}

void CompareWithWindow(Stage& stage)
{
  vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(0);
  window->SetSize(Width, Height);
  window->AddRenderer(stage.Renderer);
  vtkNew<vtkImageData> image;
  const std::string opaque = Draw(window);
  Expect(stage.Scene->TraceImage(Width, Height, image), "there is a picture beside the window");
  Expect(GetDifference(GetColors(image), opaque) == 0, "it has the window's bits");
  stage.AddBall(0);
  const std::string translucent = Draw(window);
  stage.Scene->TraceImage(Width, Height, image);
  Expect(GetDifference(translucent, opaque) > 20, "the ball can be seen");
  Expect(GetDifference(GetColors(image), translucent) <= 1, "translucent, up to rounding");
  stage.Renderer->GradientBackgroundOn();
  stage.Renderer->SetBackground2(1.0, 0.0, 0.5);
  const std::string gradient = Draw(window);
  stage.Scene->TraceImage(Width, Height, image);
  Expect(GetDifference(gradient, translucent) > 50, "the gradient can be seen");
  Expect(GetDifference(GetColors(image), gradient) <= 2, "gradient, up to rounding");
  Expect(GetDifference(Draw(window), gradient) == 0, "the window is as it was");
  stage.Renderer->GradientBackgroundOff();
  window->RemoveRenderer(stage.Renderer);
}

/// Colors over the background, transparent ones, and depths, one after the other.
std::string TraceAll(Stage& stage, int rank)
{
  vtkNew<vtkImageData> image;
  Expect(stage.Scene->TraceImage(Width, Height, image), "a picture over the background");
  std::string bytes = GetColors(image);
  stage.AddBall(rank);
  Expect(stage.Scene->TraceImage(Width, Height, image, true), "a transparent picture");
  bytes += GetColors(image);
  auto* depths = vtkFloatArray::SafeDownCast(image->GetPointData()->GetArray("depth"));
  bytes.append(reinterpret_cast<const char*>(depths->GetPointer(0)),
    static_cast<std::size_t>(depths->GetNumberOfValues()) * sizeof(float));
  Expect(
    depths->GetRange()[0] > 0.5f && depths->GetRange()[0] < 1.0f && depths->GetRange()[1] == 1.0f,
    "depths are a window's");
  return bytes;
}

void ExpectTooLarge(Stage& stage, const char* what)
{
  vtkNew<vtkTest::ErrorObserver> errors;
  const unsigned long observer = stage.Scene->AddObserver(vtkCommand::ErrorEvent, errors);
  vtkNew<vtkImageData> image;
  Expect(!stage.Scene->TraceImage(1000000, 1000000, image), what);
  stage.Scene->RemoveObserver(observer);
  Expect(errors->GetErrorMessage().find("1000000 x 1000000 pixels takes") != std::string::npos,
    errors->GetErrorMessage().c_str());
}

/// All ranks' triangles together are those of the whole volume, whichever way bricks come to the ranks.
void ExtractTogether(Stage& stage, vtkMultiProcessController* ranks)
{
  vtkNew<vtkDSMSampleVolume> whole;
  whole->SetDimensions(40, 40, 40);
  vtkNew<vtkFlyingEdges3D> edges;
  edges->SetInputConnection(whole->GetOutputPort());
  edges->SetValue(0, 0.5);
  edges->Update();
  vtkDSMMemoryOptions* const options = stage.Mapper->GetMemoryOptions();
  options->HostSharingOff();
  options->SetNumberOfThreads(2);
  for (const int organization : { vtkDSMMemoryOptions::Replicated, vtkDSMMemoryOptions::ObjectBased,
         vtkDSMMemoryOptions::PageBased })
  {
    options->SetMemoryOrganization(organization);
    vtkNew<vtkMultiBlockDataSet> surfaces;
    Expect(stage.Scene->ExtractIsosurfaces(stage.Mapper, false, surfaces), "triangles");
    auto* const mine = vtkPolyData::SafeDownCast(surfaces->GetBlock(0));
    const vtkIdType count = mine ? mine->GetNumberOfPolys() : 0;
    vtkIdType all = 0;
    ranks->AllReduce(&count, &all, 1, vtkCommunicator::SUM_OP);
    Expect(all == edges->GetOutput()->GetNumberOfPolys(), "as many as of the whole volume");
    Expect(count < all || ranks->GetNumberOfProcesses() == 1, "each rank has its own");
  }
  vtkNew<vtkDSMVolumeMapper> other;
  vtkNew<vtkMultiBlockDataSet> nothing;
  Expect(
    stage.Scene->ExtractIsosurfaces(other, false, nothing) && nothing->GetNumberOfBlocks() == 0,
    "none of a mapper that the renderer does not show");
}

void Run(const std::string& mode, const char* file, int rank)
{
  Stage stage;
  const std::string bytes = TraceAll(stage, rank);
  stage.Renderer->RemoveActor(stage.Ball);
  if (mode == "window")
  {
    CompareWithWindow(stage);
    std::ofstream(file, std::ios::binary) << bytes;
  }
  else
  {
    std::ifstream input(file, std::ios::binary);
    const std::string expected{ std::istreambuf_iterator<char>(input), {} };
    Expect(expected == bytes, "the bits of the picture that has a display");
    ExpectTooLarge(stage, "a picture that fits no memory is refused");
    Expect(stage.Scene->TraceImage(Width, Height, nullptr), "a rank may leave the picture out");
    ExtractTogether(stage, vtkMultiProcessController::GetGlobalController());
    stage.Volume->VisibilityOff();
    vtkNew<vtkImageData> image;
    Expect(stage.Scene->TraceImage(2, 1, image) &&
        GetColors(image) == std::string("\x33\x66\x99\xff\x33\x66\x99\xff"),
      "nothing but background where nothing is shown");
    ExpectTooLarge(stage, "and so is that of nothing");
    Expect(!stage.Scene->TraceImage(0, 1, image), "no picture without pixels");
  }
}

} // namespace

int main(int argc, char** argv)
{
  vtkNew<vtkMPIController> controller;
  controller->Initialize(&argc, &argv);
  vtkMultiProcessController::SetGlobalController(controller);
  if (argc == 3)
  {
    Run(argv[1], argv[2], controller->GetLocalProcessId());
  }
  vtkMultiProcessController::SetGlobalController(nullptr);
  controller->Finalize();
  return Failed || argc != 3 ? 1 : 0;
}
