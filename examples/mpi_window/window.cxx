// SPDX-License-Identifier: BSD-3-Clause
// Rank 0 shows a window, and turns the camera; the others follow. Every rank draws the tiles that it
// traced, and OpenGL geometry of its own; VTK composites by depth.
// usage: mpirun -np N window            rank 0 shows it
//        mpirun -np N window PICTURE    rank 0 writes it to a PNG file
#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCompositedSynchronizedRenderers.h>
#include <vtkDSMSampleVolume.h>
#include <vtkDSMScene.h>
#include <vtkDSMVolumeMapper.h>
#include <vtkMPIController.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>
#include <vtkSphereSource.h>
#include <vtkSynchronizedRenderWindows.h>
#include <vtkVolume.h>
#include <vtkWindowToImageFilter.h>

namespace
{

void Draw(vtkMPIController* controller, const char* picture)
{
  const int rank = controller->GetLocalProcessId();
  vtkNew<vtkDSMSampleVolume> source;
  source->SetDimensions(128, 128, 128);
  vtkNew<vtkDSMVolumeMapper> mapper;
  mapper->SetInputConnection(source->GetOutputPort());
  mapper->SetIsoValue(0, 0.5);
  mapper->GetSurfaceProperty()->SetColor(0.9, 0.7, 0.3);
  vtkNew<vtkVolume> volume;
  volume->SetMapper(mapper);

  // OpenGL geometry; here only the last rank has some.
  vtkNew<vtkSphereSource> ball;
  ball->SetCenter(0.8, 0.4, 0.3);
  ball->SetRadius(0.3);
  vtkNew<vtkPolyDataMapper> triangles;
  triangles->SetInputConnection(ball->GetOutputPort());
  vtkNew<vtkActor> actor;
  actor->SetMapper(triangles);
  actor->SetVisibility(rank == controller->GetNumberOfProcesses() - 1);

  vtkNew<vtkRenderer> renderer;
  renderer->AddVolume(volume);
  renderer->AddActor(actor);
  renderer->GetActiveCamera()->SetPosition(2.5, 1.8, 3.2);
  renderer->GetActiveCamera()->SetFocalPoint(0.0, 0.0, 0.0);
  renderer->GetActiveCamera()->SetClippingRange(0.1, 20.0);
  vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(picture || rank > 0);
  window->SetMultiSamples(0);
  window->SetSize(400, 300);
  window->AddRenderer(renderer);

  vtkNew<vtkSynchronizedRenderWindows> windows; // the others render when rank 0 does
  windows->SetRenderWindow(window);
  windows->SetParallelController(controller);
  windows->SetIdentifier(1);
  vtkNew<vtkCompositedSynchronizedRenderers> compositing;
  compositing->SetRenderer(renderer);
  compositing->SetParallelController(controller);
  const vtkSmartPointer<vtkDSMScene> scene = vtkDSMScene::ForRenderer(renderer);

  if (rank > 0)
  {
    controller->ProcessRMIs();
    return;
  }
  vtkNew<vtkRenderWindowInteractor> interactor;
  interactor->SetRenderWindow(window);
  window->Render();
  if (picture)
  {
    vtkNew<vtkWindowToImageFilter> image;
    image->SetInput(window);
    image->ShouldRerenderOff();
    vtkNew<vtkPNGWriter> writer;
    writer->SetInputConnection(image->GetOutputPort());
    writer->SetFileName(picture);
    writer->Write();
  }
  else
  {
    interactor->Start();
  }
  controller->TriggerBreakRMIs();
}

} // namespace

int main(int argc, char** argv)
{
  vtkNew<vtkMPIController> controller;
  controller->Initialize(&argc, &argv);
  vtkMultiProcessController::SetGlobalController(controller);
  Draw(controller, argc > 1 ? argv[1] : nullptr);
  vtkMultiProcessController::SetGlobalController(nullptr);
  controller->Finalize();
  return 0;
}
