// SPDX-License-Identifier: BSD-3-Clause
// A volume that is spread over MPI ranks: each makes (or reads) its own piece, all trace the picture
// together, and rank 0 writes it to a PNG file. The picture does not depend on the number of ranks.
// usage: mpirun -np N ranks PICTURE [SAMPLES]
//   SAMPLES  of the volume along each axis; 128
#include <vtkCamera.h>
#include <vtkDSMLightOptions.h>
#include <vtkDSMSampleVolume.h>
#include <vtkDSMScene.h>
#include <vtkDSMVolumeMapper.h>
#include <vtkMPIController.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkVolume.h>
#include <vtkWindowToImageFilter.h>

#include <cstdlib>

namespace
{

void Draw(vtkMPIController* controller, const char* picture, int samples)
{
  // Asked for piece r of n by the mapper; so would a parallel reader, such as vtkXMLPImageDataReader.
  vtkNew<vtkDSMSampleVolume> source;
  source->SetDimensions(samples, samples, samples);
  vtkNew<vtkDSMVolumeMapper> mapper;
  mapper->SetInputConnection(source->GetOutputPort());
  mapper->SetIsoValue(0, 0.5);
  mapper->GetSurfaceProperty()->SetColor(0.9, 0.7, 0.3);
  mapper->GetLightOptions()->ShadowsOn();
  vtkNew<vtkVolume> volume;
  volume->SetMapper(mapper);

  // Renderer, camera and props are the same on every rank.
  vtkNew<vtkRenderer> renderer;
  renderer->AddVolume(volume);
  renderer->GetActiveCamera()->SetPosition(2.5, 1.8, 3.2);
  renderer->GetActiveCamera()->SetFocalPoint(0.0, 0.0, 0.0);
  renderer->GetActiveCamera()->SetClippingRange(0.1, 20.0);
  vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(0);
  window->SetSize(400, 300);
  window->AddRenderer(renderer);

  // To be made on every rank before the first frame, and kept.
  vtkSmartPointer<vtkDSMScene> scene = vtkDSMScene::ForRenderer(renderer);
  scene->DeliverEverywhere(); // rank 0's window gets the whole picture; nothing need be composited
  window->Render();           // collective
  if (controller->GetLocalProcessId() == 0)
  {
    vtkNew<vtkWindowToImageFilter> image;
    image->SetInput(window);
    image->ShouldRerenderOff(); // the other ranks would not take part
    vtkNew<vtkPNGWriter> writer;
    writer->SetInputConnection(image->GetOutputPort());
    writer->SetFileName(picture);
    writer->Write();
  }
}

} // namespace

int main(int argc, char** argv)
{
  vtkNew<vtkMPIController> controller;
  controller->Initialize(&argc, &argv);
  vtkMultiProcessController::SetGlobalController(controller);
  if (argc > 1)
  {
    Draw(controller, argv[1], argc > 2 ? std::atoi(argv[2]) : 128);
  }
  vtkMultiProcessController::SetGlobalController(nullptr);
  controller->Finalize();
  return 0;
}
