// SPDX-License-Identifier: BSD-3-Clause
// An isosurface of a volume over a floor that it casts its shadow on, in one window.
// usage: isosurface            shows it
//        isosurface PICTURE    draws it off screen, and writes it to a PNG file
#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkDSMLightOptions.h>
#include <vtkDSMPolyDataMapper.h>
#include <vtkDSMVolumeMapper.h>
#include <vtkLight.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkPlaneSource.h>
#include <vtkProperty.h>
#include <vtkRTAnalyticSource.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>
#include <vtkVolume.h>
#include <vtkWindowToImageFilter.h>

int main(int argc, char** argv)
{
  vtkNew<vtkRTAnalyticSource> source; // or any reader of image data
  source->SetWholeExtent(-40, 40, -40, 40, -40, 40);
  vtkNew<vtkDSMVolumeMapper> isosurface;
  isosurface->SetInputConnection(source->GetOutputPort());
  isosurface->SetIsoArray("RTData");
  isosurface->SetIsoValue(0, 160.0);
  isosurface->GetSurfaceProperty()->SetColor(0.9, 0.7, 0.3);
  isosurface->GetLightOptions()->ShadowsOn();
  vtkNew<vtkVolume> volume;
  volume->SetMapper(isosurface);

  vtkNew<vtkPlaneSource> floor;
  floor->SetOrigin(-60.0, -30.0, 60.0);
  floor->SetPoint1(60.0, -30.0, 60.0);
  floor->SetPoint2(-60.0, -30.0, -60.0);
  vtkNew<vtkDSMPolyDataMapper> surface; // in the place of vtkPolyDataMapper
  surface->SetInputConnection(floor->GetOutputPort());
  vtkNew<vtkActor> actor;
  actor->SetMapper(surface);

  vtkNew<vtkLight> sun;
  sun->SetLightTypeToSceneLight();
  sun->SetPosition(60.0, 150.0, 90.0);

  vtkNew<vtkRenderer> renderer;
  renderer->AddLight(sun);
  renderer->AddVolume(volume);
  renderer->AddActor(actor);
  renderer->SetBackground(0.3, 0.35, 0.4);
  renderer->GetActiveCamera()->SetPosition(90.0, 70.0, 140.0);
  renderer->ResetCamera();
  vtkNew<vtkRenderWindow> window;
  window->SetMultiSamples(0); // they would only blur what OpenGL draws
  window->SetSize(600, 450);
  window->AddRenderer(renderer);
  if (argc > 1)
  {
    window->SetOffScreenRendering(1);
    window->Render();
    vtkNew<vtkWindowToImageFilter> image;
    image->SetInput(window);
    vtkNew<vtkPNGWriter> writer;
    writer->SetInputConnection(image->GetOutputPort());
    writer->SetFileName(argv[1]);
    writer->Write();
    return 0;
  }
  vtkNew<vtkRenderWindowInteractor> interactor;
  interactor->SetRenderWindow(window);
  interactor->Start();
  return 0;
}
