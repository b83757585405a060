// SPDX-License-Identifier: BSD-3-Clause
// What VTK applications do with their renderers, assemblies, pipelines and cameras.
#include "VolumeMapperTest.h"
#include "vtkDSMLightOptions.h"
#include "vtkDSMStatistics.h"

#include "vtkAssembly.h"
#include "vtkCallbackCommand.h"
#include "vtkCameraPass.h"
#include "vtkCommand.h"
#include "vtkContourValues.h"
#include "vtkObjectFactory.h"
#include "vtkPropAssembly.h"
#include "vtkProperty.h"
#include "vtkRTAnalyticSource.h"
#include "vtkRenderPass.h"
#include "vtkTestErrorObserver.h"
#include "vtkValuePass.h"
#include "vtkVolumeProperty.h"
#include "vtkWeakPointer.h"

#include <array>
#include <string>
#include <tuple>

namespace
{

std::array<double, 6> GetBounds(vtkVolume* volume)
{
  std::array<double, 6> bounds{};
  volume->GetBounds(bounds.data());
  return bounds;
}

TEST_F(VolumeMapper, IsDrawnAgainAfterAllPropsWereRemoved)
{
  const std::vector<double> first = this->RenderTraced();
  this->Renderer->RemoveAllViewProps();
  EXPECT_EQ(CountCovered(this->RenderDistances()), 0);
  EXPECT_GT(CountCovered(first), 1000);
  EXPECT_EQ(this->RenderTraced(), first);
}

TEST_F(VolumeMapper, PartsOfAssembliesAreDrawnWhereTheyAre)
{
  vtkNew<vtkVolume> placed;
  placed->SetMapper(this->Mapper);
  placed->SetPosition(4.0, 1.0, 2.0);
  this->Renderer->AddVolume(placed);
  const std::vector<double> alone = this->RenderDistances();
  this->Renderer->RemoveVolume(placed);

  vtkNew<vtkAssembly> inner;
  this->Volume->SetPosition(3.0, 0.0, 0.0);
  inner->AddPart(this->Volume);
  vtkNew<vtkAssembly> outer;
  outer->SetPosition(1.0, 1.0, 2.0);
  outer->AddPart(inner);
  this->Renderer->AddViewProp(outer);
  EXPECT_EQ(this->RenderDistances(), alone);
  outer->VisibilityOff();
  EXPECT_EQ(CountCovered(this->RenderDistances()), 0);
  outer->VisibilityOn();
  this->Volume->VisibilityOff();
  EXPECT_EQ(CountCovered(this->RenderDistances()), 0);
  this->Volume->VisibilityOn();
  outer->SetPosition(1.0, 1.0, -2.0);
  EXPECT_NE(this->RenderDistances(), alone);
  this->Renderer->RemoveViewProp(outer);

  vtkNew<vtkPropAssembly> group;
  group->AddPart(placed);
  this->Renderer->AddViewProp(group);
  EXPECT_EQ(this->RenderDistances(), alone);
}

TEST_F(VolumeMapper, BoundsAreThoseOfNewDataBeforeTheyAreDrawn)
{
  vtkNew<vtkRTAnalyticSource> source;
  source->SetWholeExtent(-8, 8, -8, 8, -8, 8);
  this->Mapper->SetIsoArray("");
  this->Mapper->SetInputConnection(source->GetOutputPort());
  this->Renderer->AddVolume(this->Volume);
  this->Window->Render();
  EXPECT_EQ(GetBounds(this->Volume), (std::array<double, 6>{ -8, 8, -8, 8, -8, 8 }));
  source->SetWholeExtent(0, 32, 0, 30, 0, 28);
  EXPECT_EQ(GetBounds(this->Volume), (std::array<double, 6>{ 0, 32, 0, 30, 0, 28 }));
  this->Renderer->ResetCamera();
  const double* focus = this->Renderer->GetActiveCamera()->GetFocalPoint();
  EXPECT_EQ(
    (std::array<double, 3>{ focus[0], focus[1], focus[2] }), (std::array<double, 3>{ 16, 15, 14 }));
  this->Window->Render();
  EXPECT_EQ(GetBounds(this->Volume), (std::array<double, 6>{ 0, 32, 0, 30, 0, 28 }));

  vtkNew<vtkRTAnalyticSource> other;
  other->SetWholeExtent(0, 4, 0, 4, 0, 4);
  this->Mapper->SetInputConnection(other->GetOutputPort());
  EXPECT_EQ(GetBounds(this->Volume), (std::array<double, 6>{ 0, 4, 0, 4, 0, 4 }));
  const auto ball = MakeBall();
  this->Mapper->SetInputData(ball);
  EXPECT_EQ(GetBounds(this->Volume), (std::array<double, 6>{ -16, 16, -16, 16, -8, 8 }));
}

TEST_F(VolumeMapper, SaysThatItHasNoIsovalue)
{
  vtkNew<vtkTest::ErrorObserver> observer;
  this->Mapper->AddObserver(vtkCommand::ErrorEvent, observer);
  this->Mapper->SetNumberOfIsoValues(0);
  this->Mapper->SurfacesOnlyOn();
  this->Renderer->AddVolume(this->Volume);
  EXPECT_EQ(CountCovered(this->RenderDistances()), 0);
  ASSERT_TRUE(observer->GetError());
  const std::string message = observer->GetErrorMessage();
  EXPECT_NE(message.find("SetIsoValue"), std::string::npos) << message;
  observer->Clear();
  this->Window->Render();
  EXPECT_FALSE(observer->GetError()) << "once is enough";

  this->Mapper->SetBlendMode(vtkVolumeMapper::ISOSURFACE_BLEND);
  this->Volume->GetProperty()->GetIsoSurfaceValues()->SetNumberOfContours(0);
  this->Window->Render();
  ASSERT_TRUE(observer->GetError());
  EXPECT_NE(observer->GetErrorMessage().find("GetIsoSurfaceValues"), std::string::npos)
    << observer->GetErrorMessage();
}

TEST_F(VolumeMapper, ACopyDrawsTheSame)
{
  this->Mapper->SetCropping(1);
  this->Mapper->SetCroppingRegionPlanes(-16.0, 4.0, -16.0, 16.0, -16.0, 16.0);
  this->Mapper->GetSurfaceProperty()->SetColor(0.2, 0.9, 0.3);
  const std::vector<double> original = this->RenderTraced();
  vtkNew<vtkDSMVolumeMapper> copy;
  copy->ShallowCopy(this->Mapper);
  EXPECT_EQ(copy->GetSurfaceProperty(), this->Mapper->GetSurfaceProperty());
  EXPECT_EQ(copy->GetMemoryOptions(), this->Mapper->GetMemoryOptions());
  EXPECT_EQ(copy->GetLightOptions(), this->Mapper->GetLightOptions());
  this->Volume->SetMapper(copy);
  EXPECT_EQ(this->RenderTraced(), original);
  EXPECT_GT(CountCovered(original), 1000);
  copy->SetIsoValue(0, 0.2);
  EXPECT_EQ(this->Mapper->GetIsoValue(0), 0.4) << "isovalues are the copy's own";
}

/// Beside a ball in another window.
class VolumeMapperAndAnother : public VolumeMapper
{
protected:
  VolumeMapperAndAnother()
  {
    this->Renderer->AddViewProp(this->Volume);
    this->OtherWindow->SetOffScreenRendering(1);
    this->OtherWindow->AddRenderer(this->OtherRenderer);
    this->OtherMapper->ShallowCopy(this->Mapper); // with its options
    this->OtherVolume->SetMapper(this->OtherMapper);
    this->OtherRenderer->AddViewProp(this->OtherVolume);
  }
  void RenderBoth()
  {
    this->Window->Render();
    this->OtherWindow->Render();
  }
  /// Of the next frame of the first window.
  bool HasThreads(int number)
  {
    this->Window->Render();
    const std::string text = "\"Threads\": " + std::to_string(number) + ",";
    return this->Scene->GetStatistics()->GetJson().find(text) != std::string::npos;
  }

  vtkNew<vtkDSMVolumeMapper> OtherMapper;
  vtkNew<vtkVolume> OtherVolume;
  vtkNew<vtkRenderer> OtherRenderer;
  vtkNew<vtkRenderWindow> OtherWindow;
};

TEST_F(VolumeMapperAndAnother, SharedOptionsCountAsTheyAreNow)
{
  this->RenderBoth();
  EXPECT_TRUE(this->HasThreads(2));
  this->Mapper->GetMemoryOptions()->SetNumberOfThreads(1);
  EXPECT_TRUE(this->HasThreads(1)) << this->Scene->GetStatistics()->GetJson();
}

TEST_F(VolumeMapperAndAnother, MostRecentMemoryOptionsApply)
{
  vtkNew<vtkDSMMemoryOptions> options;
  this->OtherMapper->SetMemoryOptions(options);
  this->RenderBoth();
  EXPECT_TRUE(this->HasThreads(2)) << "options that nobody has set change nothing";
  options->SetNumberOfThreads(3);
  EXPECT_TRUE(this->HasThreads(3));
  this->OtherVolume->VisibilityOff();
  EXPECT_TRUE(this->HasThreads(3)) << "the ranks keep them";
  this->Mapper->GetMemoryOptions()->SetNumberOfThreads(2);
  EXPECT_TRUE(this->HasThreads(2)) << "also where the mapper's own have not changed";
  options->SetNumberOfThreads(-1);
  EXPECT_EQ(options->GetNumberOfThreads(), 0);
}

TEST_F(VolumeMapperAndAnother, SceneHasTheLightOfItsMappers)
{
  vtkNew<vtkDSMLightOptions> options;
  options->ShadowsOn();
  options->SetReflectivity(0.5);
  this->OtherMapper->SetLightOptions(options);
  this->Mapper->GetLightOptions()->SetSamplesPerPixel(2);
  this->RenderBoth();
  vtkDSMLightOptions* light = this->Scene->GetLightOptions();
  vtkSmartPointer<vtkDSMScene> otherScene = vtkDSMScene::ForRenderer(this->OtherRenderer);
  vtkDSMLightOptions* otherLight = otherScene->GetLightOptions();
  EXPECT_EQ(light->GetSamplesPerPixel(), 2);
  EXPECT_FALSE(light->GetShadows());
  EXPECT_TRUE(otherLight->GetShadows());
  EXPECT_EQ(otherLight->GetReflectivity(), 0.0) << "it is the mapper's own";
  otherLight->ShadowsOff();
  this->RenderBoth();
  EXPECT_FALSE(otherLight->GetShadows()) << "the most recent value applies";
  options->ShadowsOn();
  EXPECT_TRUE(otherLight->GetShadows()) << "also where the mapper's own has not changed";
  this->Renderer->AddVolume(this->OtherVolume);
  this->RenderBoth();
  options->SetMaxBounces(3);
  EXPECT_EQ(light->GetMaxBounces(), 3) << "in all scenes that have drawn the mapper";
  EXPECT_EQ(otherLight->GetMaxBounces(), 3);
}

/// While tiles are traced, another scene cannot be: its picture comes with the next render.
TEST_F(VolumeMapperAndAnother, TellsOfTheTracingOfAFrameThatTakesLong)
{
  struct Watch
  {
    vtkDSMVolumeMapper* Mapper;
    vtkRenderWindow* Window;
    vtkRenderWindow* OtherWindow;
    vtkSmartPointer<vtkDSMScene> OtherScene;
    std::vector<double> Parts;
    bool OtherIsRefined = true;
  } watch{ this->Mapper, this->Window, this->OtherWindow,
    vtkDSMScene::ForRenderer(this->OtherRenderer), {} };
  this->RenderBoth();
  ASSERT_TRUE(watch.OtherScene->IsRefined());
  vtkNew<vtkCallbackCommand> progress;
  progress->SetClientData(&watch);
  progress->SetCallback(
    [](vtkObject*, unsigned long, void* data, void*)
    {
      auto* self = static_cast<Watch*>(data);
      if (const char* text = self->Mapper->GetProgressText())
      {
        EXPECT_STREQ(text, "Ray tracing");
        self->Parts.push_back(self->Mapper->GetProgress());
        self->OtherWindow->Render();
        self->OtherIsRefined = self->OtherScene->IsRefined();
      }
    });
  vtkNew<vtkCallbackCommand> abort;
  abort->SetClientData(&watch);
  abort->SetCallback(
    [](vtkObject*, unsigned long, void* data, void*)
    {
      auto* self = static_cast<Watch*>(data);
      self->Window->SetAbortRender(self->Parts.size() > 1 ? 1 : 0);
    });
  this->Mapper->AddObserver(vtkCommand::ProgressEvent, progress);
  this->Window->AddObserver(vtkCommand::AbortCheckEvent, abort);
  this->Mapper->GetLightOptions()->SetSampleTolerance(0.0); // smooth pixels take as long as others
  this->Mapper->GetLightOptions()->SetSamplesPerPixel(3000);
  this->Window->Render();
  ASSERT_EQ(watch.Parts.size(), 2u);
  EXPECT_GT(watch.Parts[0], 0.0);
  EXPECT_GT(watch.Parts[1], watch.Parts[0]);
  EXPECT_LT(watch.Parts[1], 1.0);
  EXPECT_FALSE(watch.OtherIsRefined);
  this->OtherMapper->GetLightOptions()->SetSamplesPerPixel(1);
  this->OtherWindow->Render();
  EXPECT_TRUE(watch.OtherScene->IsRefined());
}

/// Until a render ends, its scene does not, whoever gives up the last reference meanwhile.
TEST_F(VolumeMapper, SceneMayBeGivenUpInARender)
{
  this->Renderer->AddVolume(this->Volume);
  this->Mapper->MakesSceneOff();
  const std::vector<double> drawn = this->RenderDistances();
  vtkNew<vtkCallbackCommand> giveUp;
  giveUp->SetClientData(&this->Scene);
  giveUp->SetCallback([](vtkObject*, unsigned long, void* scene, void*)
    { *static_cast<vtkSmartPointer<vtkDSMScene>*>(scene) = nullptr; });
  // Before the scene hears of the start, after it does, while it takes in data, and before it hears of the end.
  const std::tuple<vtkObject*, unsigned long, float> events[] = {
    { this->Renderer, vtkCommand::StartEvent, 10.0f },
    { this->Renderer, vtkCommand::StartEvent, -10.0f },
    { this->Mapper, vtkCommand::ProgressEvent, 0.0f },
    { this->Renderer, vtkCommand::EndEvent, 10.0f },
  };
  bool isDrawn = false; // by a scene that is there when the render begins
  for (const auto& [object, event, priority] : events)
  {
    this->Scene = vtkDSMScene::ForRenderer(this->Renderer);
    this->Mapper->SetInputData(MakeBall()); // to be taken in
    const unsigned long observer = object->AddObserver(event, giveUp, priority);
    const vtkWeakPointer<vtkDSMScene> scene = this->Scene.Get();
    const std::vector<double> distances = this->RenderDistances();
    EXPECT_EQ(distances == drawn, isDrawn) << vtkCommand::GetStringFromEventId(event);
    EXPECT_EQ(scene, nullptr);
    object->RemoveObserver(observer);
    isDrawn = true;
  }
  this->Scene = vtkDSMScene::ForRenderer(this->Renderer);
  const unsigned long observer = this->Mapper->AddObserver(vtkCommand::ProgressEvent, giveUp);
  vtkNew<vtkImageData> image;
  EXPECT_TRUE(this->Scene->TraceImage(20, 10, image));
  EXPECT_EQ(image->GetNumberOfPoints(), 200);
  EXPECT_EQ(this->Scene, nullptr);
  this->Mapper->RemoveObserver(observer);
}

/// In place of OSPRay's, which few builds of VTK have: draws nothing.
class vtkOSPRayPass : public vtkRenderPass
{
public:
  static vtkOSPRayPass* New();
  vtkTypeMacro(vtkOSPRayPass, vtkRenderPass);
  void Render(const vtkRenderState*) override {}
};
vtkStandardNewMacro(vtkOSPRayPass);

class VolumeMapperAndPass : public VolumeMapper
{
protected:
  /// That the pass leaves the volume out is said, once; without it, the volume is there.
  void ExpectToldOnce(vtkRenderPass* pass, const std::string& words)
  {
    vtkNew<vtkTest::ErrorObserver> observer;
    this->Scene->AddObserver(vtkCommand::ErrorEvent, observer);
    this->Renderer->AddVolume(this->Volume);
    this->Renderer->SetPass(pass);
    this->Window->Render();
    ASSERT_TRUE(observer->GetError());
    EXPECT_NE(observer->GetErrorMessage().find(words), std::string::npos)
      << observer->GetErrorMessage();
    observer->Clear();
    this->Window->Render();
    EXPECT_FALSE(observer->GetError()) << "once is enough";
    this->Renderer->SetPass(nullptr);
    EXPECT_GT(CountCovered(this->RenderDistances()), 1000);
    EXPECT_FALSE(observer->GetError());
  }
};

TEST_F(VolumeMapperAndPass, OSPRaysIsTold)
{
  vtkNew<vtkOSPRayPass> pass;
  this->ExpectToldOnce(pass, "Enable Ray Tracing");
}

/// As ParaView's extractor Recolorable Image asks for them.
TEST_F(VolumeMapperAndPass, ThatOfValuesIsTold)
{
  vtkNew<vtkValuePass> values;
  vtkNew<vtkCameraPass> pass;
  pass->SetDelegatePass(values);
  this->ExpectToldOnce(pass, "Recolorable Image");
}

} // namespace
