// SPDX-License-Identifier: BSD-3-Clause
// A VTK program that changes nothing but the class name of a mapper draws the same thing: for
// vtkGPUVolumeRayCastMapper with isosurface blending, and for vtkPolyDataMapper. Each program is
// written once, as a template over the mapper. Draws on the X server, off screen.
#include "vtkDSMPolyDataMapper.h"
#include "vtkDSMScene.h"
#include "vtkDSMVolumeMapper.h"

#include "vtkActor.h"
#include "vtkAssembly.h"
#include "vtkAutoInit.h"
#include "vtkCamera.h"
#include "vtkColorTransferFunction.h"
#include "vtkContourValues.h"
#include "vtkCubeSource.h"
#include "vtkElevationFilter.h"
#include "vtkGPUVolumeRayCastMapper.h"
#include "vtkNew.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRTAnalyticSource.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSphereSource.h"
#include "vtkTexture.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"
#include "vtkWeakPointer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

namespace
{

constexpr int Size = 200;
using Picture = vtkSmartPointer<vtkUnsignedCharArray>;

/// The background is black; what is drawn is not.
bool IsCovered(const Picture& picture, int pixel)
{
  return picture->GetComponent(pixel, 0) + picture->GetComponent(pixel, 1) +
    picture->GetComponent(pixel, 2) >
    0.0;
}

Picture Render(vtkRenderer* renderer)
{
  vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(0);
  window->SetSize(Size, Size);
  window->AddRenderer(renderer);
  window->Render();
  auto picture = Picture::New();
  window->GetPixelData(0, 0, Size - 1, Size - 1, 1, picture);
  return picture;
}

/// Both cover the same pixels but for the rim, and are of like color where both do.
void ExpectAlike(const Picture& ours, const Picture& theirs)
{
  int covered = 0;
  int different = 0;
  double difference = 0.0;
  for (int pixel = 0; pixel < Size * Size; ++pixel)
  {
    covered += IsCovered(theirs, pixel);
    different += IsCovered(ours, pixel) != IsCovered(theirs, pixel);
    for (int channel = 0; channel < 3; ++channel)
    {
      difference +=
        std::abs(ours->GetComponent(pixel, channel) - theirs->GetComponent(pixel, channel)) / 3.0;
    }
  }
  EXPECT_GT(covered, Size * Size / 10);
  EXPECT_LE(different, covered / 50);
  EXPECT_LE(difference / covered, 8.0) << "of 255, mean over the pixels that are covered";
}

template <typename Mapper>
Picture DrawIsosurfaces(bool shade, bool selectByName)
{
  vtkNew<vtkRTAnalyticSource> source;
  source->SetWholeExtent(-20, 20, -20, 20, -20, 20);
  source->SetXFreq(6.0);
  source->SetYFreq(3.0);
  source->SetZFreq(4.0);
  vtkNew<Mapper> mapper;
  mapper->SetInputConnection(source->GetOutputPort());
  mapper->SetBlendModeToIsoSurface();
  mapper->AutoAdjustSampleDistancesOff();
  mapper->SetSampleDistance(0.1);
  if (selectByName)
  {
    mapper->SetScalarModeToUsePointFieldData();
    mapper->SelectScalarArray("RTData");
  }
  vtkNew<vtkColorTransferFunction> colors;
  colors->AddRGBPoint(100.0, 0.2, 0.3, 0.9);
  colors->AddRGBPoint(160.0, 0.9, 0.4, 0.2);
  colors->AddRGBPoint(220.0, 0.9, 0.9, 0.3);
  vtkNew<vtkPiecewiseFunction> opacities;
  opacities->AddPoint(100.0, 0.3);
  opacities->AddPoint(160.0, 0.3);
  opacities->AddPoint(220.0, 1.0);
  vtkNew<vtkVolumeProperty> property;
  property->SetColor(colors);
  property->SetScalarOpacity(opacities);
  property->SetInterpolationTypeToLinear();
  property->SetShade(shade);
  property->GetIsoSurfaceValues()->SetValue(0, 220.0);
  property->GetIsoSurfaceValues()->SetValue(1, 150.0);
  vtkNew<vtkVolume> volume;
  volume->SetMapper(mapper);
  volume->SetProperty(property);
  volume->RotateX(20.0);
  vtkNew<vtkRenderer> renderer;
  renderer->AddVolume(volume);
  renderer->ResetCamera();
  renderer->GetActiveCamera()->Azimuth(30.0);
  renderer->ResetCameraClippingRange();
  return Render(renderer);
}

TEST(Replacement, OfTheRayCastMapperShowsItsIsosurfacesFlat)
{
  ExpectAlike(DrawIsosurfaces<vtkDSMVolumeMapper>(false, false),
    DrawIsosurfaces<vtkGPUVolumeRayCastMapper>(false, false));
}

TEST(Replacement, OfTheRayCastMapperShowsItsIsosurfacesShaded)
{
  ExpectAlike(DrawIsosurfaces<vtkDSMVolumeMapper>(true, true),
    DrawIsosurfaces<vtkGPUVolumeRayCastMapper>(true, true));
}

template <typename Mapper>
Picture DrawBall(bool colored)
{
  vtkNew<vtkSphereSource> source;
  source->SetThetaResolution(40);
  source->SetPhiResolution(40);
  vtkNew<vtkElevationFilter> elevation;
  elevation->SetInputConnection(source->GetOutputPort());
  elevation->SetLowPoint(0.0, -0.5, 0.0);
  elevation->SetHighPoint(0.0, 0.5, 0.0);
  vtkNew<Mapper> mapper;
  mapper->SetInputConnection(elevation->GetOutputPort());
  mapper->SetScalarVisibility(colored);
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(0.8, 0.6, 0.4);
  actor->GetProperty()->SetSpecular(0.4);
  actor->GetProperty()->SetSpecularPower(20.0);
  vtkNew<vtkRenderer> renderer;
  renderer->AddActor(actor);
  renderer->ResetCamera();
  return Render(renderer);
}

TEST(Replacement, OfThePolyDataMapperShowsItsSurface)
{
  ExpectAlike(DrawBall<vtkDSMPolyDataMapper>(false), DrawBall<vtkPolyDataMapper>(false));
  ExpectAlike(DrawBall<vtkDSMPolyDataMapper>(true), DrawBall<vtkPolyDataMapper>(true));
}

/// A cube with a picture of values that are no colors, lit from the camera.
template <typename Mapper>
vtkSmartPointer<vtkActor> MakeCube()
{
  vtkNew<vtkCubeSource> source;
  source->SetXLength(2.0);
  vtkNew<Mapper> mapper;
  mapper->SetInputConnection(source->GetOutputPort());
  vtkNew<vtkRTAnalyticSource> values;
  values->SetWholeExtent(0, 15, 0, 15, 0, 0);
  vtkNew<vtkTexture> texture;
  texture->SetInputConnection(values->GetOutputPort());
  vtkSmartPointer<vtkActor> actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->SetTexture(texture);
  actor->SetPosition(3.0, 0.0, 0.0);
  actor->RotateX(30.0);
  return actor;
}

/// In the first frame, whose scene the mapper makes.
template <typename Mapper>
Picture DrawAssembly()
{
  vtkNew<vtkAssembly> inner;
  inner->AddPart(MakeCube<Mapper>());
  inner->RotateZ(40.0);
  vtkNew<vtkAssembly> outer;
  outer->AddPart(inner);
  const vtkSmartPointer<vtkActor> other = MakeCube<Mapper>();
  outer->AddPart(other);
  outer->SetScale(1.0, 2.0, 1.0);
  vtkNew<vtkRenderer> renderer;
  renderer->AddViewProp(outer);
  renderer->ResetCamera();
  const Picture picture = Render(renderer);
  EXPECT_EQ(other->GetPosition()[0], 3.0);
  EXPECT_NEAR(other->GetOrientation()[0], 30.0, 1e-6);
  return picture;
}

TEST(Replacement, OfThePolyDataMapperStaysWhereAssembliesHaveIt)
{
  ExpectAlike(DrawAssembly<vtkDSMPolyDataMapper>(), DrawAssembly<vtkPolyDataMapper>());
}

/// A ball that is seen through, in a larger one that VTK draws, or alone; in the first frame.
template <typename Mapper>
Picture DrawGlass(bool isAlone)
{
  vtkNew<vtkSphereSource> source;
  source->SetThetaResolution(40);
  source->SetPhiResolution(40);
  vtkNew<Mapper> mapper;
  mapper->SetInputConnection(source->GetOutputPort());
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetOpacity(0.5);
  vtkNew<vtkPolyDataMapper> outerMapper;
  outerMapper->SetInputConnection(source->GetOutputPort());
  vtkNew<vtkActor> outer;
  outer->SetMapper(outerMapper);
  outer->SetScale(1.5);
  outer->GetProperty()->SetColor(0.9, 0.5, 0.3);
  outer->GetProperty()->SetOpacity(0.4);
  vtkNew<vtkRenderer> renderer;
  renderer->SetUseDepthPeeling(true);
  renderer->SetMaximumNumberOfPeels(8);
  renderer->AddActor(actor);
  if (!isAlone)
  {
    renderer->AddActor(outer);
  }
  renderer->ResetCamera();
  return Render(renderer);
}

TEST(Replacement, OfThePolyDataMapperIsSeenThroughAtOnce)
{
  for (const bool isAlone : { true, false })
  {
    ExpectAlike(DrawGlass<vtkDSMPolyDataMapper>(isAlone), DrawGlass<vtkPolyDataMapper>(isAlone));
  }
}

TEST(Replacement, WithoutARendererThereIsNoScene)
{
  vtkObject::GlobalWarningDisplayOff();
  EXPECT_EQ(vtkDSMScene::NewForRenderer(nullptr), nullptr);
  vtkObject::GlobalWarningDisplayOn();
}

TEST(Replacement, TheSceneThatAMapperMakesEndsWithTheRenderer)
{
  vtkWeakPointer<vtkDSMScene> scene;
  {
    vtkNew<vtkSphereSource> source;
    vtkNew<vtkDSMPolyDataMapper> mapper;
    mapper->SetInputConnection(source->GetOutputPort());
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    vtkNew<vtkRenderer> renderer;
    renderer->AddActor(actor);
    Render(renderer);
    scene = vtkDSMScene::ForRenderer(renderer);
    EXPECT_EQ(scene->GetReferenceCount(), 1) << "only the renderer has it";
    Render(renderer);
    EXPECT_EQ(vtkDSMScene::ForRenderer(renderer).Get(), scene.Get());
  }
  EXPECT_EQ(scene.Get(), nullptr);
}

} // namespace
