// SPDX-License-Identifier: BSD-3-Clause
// The scene of a volume mapper's renderer: when it is traced again, adds samples, and is aborted.
#include "VolumeMapperTest.h"

#include "vtkDSMLightOptions.h"
#include "vtkDSMStatistics.h"

#include "vtkCallbackCommand.h"
#include "vtkNew.h"
#include "vtkPlane.h"
#include "vtkRenderWindow.h"
#include "vtkTable.h"
#include "vtkTestErrorObserver.h"
#include "vtkUnsignedCharArray.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <thread>
#include <vector>

namespace
{

int CountTiles(vtkDSMScene* scene)
{
  vtkNew<vtkTable> table;
  scene->GetStatistics()->GetTable(table);
  return table->GetValueByName(0, "Tiles").ToInt();
}

} // namespace

TEST_F(VolumeMapper, TheSceneIsTheRenderersAndEndsWithItsLastHolder)
{
  EXPECT_EQ(vtkDSMScene::ForRenderer(this->Renderer), this->Scene);
  this->Mapper->MakesSceneOff();
  this->Renderer->AddVolume(this->Volume);
  EXPECT_GT(CountCovered(this->RenderDistances()), 0);
  this->Scene = nullptr;
  EXPECT_EQ(CountCovered(this->RenderDistances()), 0);
  this->Scene = vtkDSMScene::ForRenderer(this->Renderer);
  EXPECT_GT(CountCovered(this->RenderDistances()), 0);
}

TEST_F(VolumeMapper, WhatWasDeletedWhileTheSceneWasHiddenIsNotTouched)
{
  auto volume = vtkSmartPointer<vtkVolume>::New();
  volume->SetMapper(this->Mapper);
  this->Renderer->AddVolume(volume);
  ASSERT_GT(CountCovered(this->RenderDistances()), 0);
  this->Scene->SetHidden(true);
  this->Renderer->RemoveVolume(volume);
  ASSERT_EQ(volume->GetReferenceCount(), 1);
  volume = nullptr;
  EXPECT_EQ(CountCovered(this->RenderDistances()), 0);
  this->Scene->SetHidden(false);
  EXPECT_EQ(CountCovered(this->RenderDistances()), 0);
}

TEST_F(VolumeMapper, ReportsWhatItDid)
{
  this->Renderer->AddVolume(this->Volume);
  this->Window->Render();
  vtkDSMStatistics* statistics = this->Scene->GetStatistics();
  EXPECT_GT(statistics->GetFrameSeconds(), 0.0);
  vtkNew<vtkTable> table;
  statistics->GetTable(table);
  ASSERT_EQ(table->GetNumberOfRows(), 1);
  EXPECT_EQ(table->GetValueByName(0, "Tiles").ToInt(), 13 * 13);
  EXPECT_EQ(table->GetValueByName(0, "Threads").ToInt(), 2);
  EXPECT_GT(table->GetValueByName(0, "BytesResident").ToDouble(), 8.0 * 33 * 33 * 33);
  EXPECT_GT(table->GetValueByName(0, "Accesses").ToDouble(), 0.0);
}

TEST_F(VolumeMapper, CollectsSamplesUntilSomethingChanges)
{
  this->Renderer->AddVolume(this->Volume);
  this->Mapper->GetLightOptions()->SetSamplesPerPixel(3);
  const auto countFrames = [this]
  {
    int frames = 0;
    do
    {
      this->Window->Render();
      ++frames;
    } while (!this->Scene->IsRefined() && frames < 10);
    return frames;
  };
  EXPECT_EQ(countFrames(), 1) << "all samples at once";
  this->Scene->SetSamplesPerFrame(1);
  EXPECT_EQ(countFrames(), 1) << "there is nothing to add";
  this->Mapper->SetIsoValue(0, 0.3);
  EXPECT_EQ(countFrames(), 3);
  this->Renderer->GetActiveCamera()->Azimuth(3.0);
  EXPECT_EQ(countFrames(), 3);
  this->Mapper->GetLightOptions()->SetSamplesPerPixel(5);
  EXPECT_EQ(countFrames(), 2) << "the three that are there count";
  constexpr double manySeconds = 1e6;
  this->Scene->SetSecondsPerFrame(manySeconds);
  this->Mapper->SetIsoValue(0, 0.32);
  EXPECT_EQ(countFrames(), 1) << "as many as there is time for";
  EXPECT_EQ(this->Scene->GetNumberOfSamples(), 5);
  EXPECT_EQ(this->Scene->GetNumberOfSamplesWanted(), 5);
  this->Scene->SetSamplesPerFrame(0);
  this->Window->SetDesiredUpdateRate(15.0);
  this->Mapper->SetIsoValue(0, 0.35);
  EXPECT_EQ(countFrames(), 5) << "one each while the camera moves";
}

TEST_F(VolumeMapper, KeepsTheLastPictureWhenTheWindowAborts)
{
  this->Renderer->AddVolume(this->Volume);
  const std::vector<double> shown = this->RenderDistances();
  const int covered = CountCovered(shown);
  vtkNew<vtkCallbackCommand> abort;
  abort->SetCallback([](vtkObject* window, unsigned long, void*, void*)
    { static_cast<vtkRenderWindow*>(window)->SetAbortRender(1); });
  this->Mapper->SetIsoValue(0, 0.2);
  // VTK asks five times a second at most.
  std::this_thread::sleep_for(std::chrono::milliseconds(250));
  const unsigned long observer = this->Window->AddObserver(vtkCommand::AbortCheckEvent, abort);
  EXPECT_EQ(CountCovered(this->RenderDistances()), covered);
  EXPECT_FALSE(this->Scene->IsRefined());
  EXPECT_EQ(this->Scene->GetNumberOfSamples(), 0);
  this->Window->RemoveObserver(observer);
  EXPECT_LT(CountCovered(this->RenderDistances()), covered);
  EXPECT_TRUE(this->Scene->IsRefined());

  // Samples that are added.
  this->Mapper->GetLightOptions()->SetSamplesPerPixel(3);
  this->Scene->SetSamplesPerFrame(1);
  this->Window->Render();
  std::this_thread::sleep_for(std::chrono::milliseconds(250));
  this->Window->AddObserver(vtkCommand::AbortCheckEvent, abort);
  this->Window->Render();
  EXPECT_EQ(this->Scene->GetNumberOfSamples(), 2) << "those that were there";
  EXPECT_FALSE(this->Scene->IsRefined());
  this->Window->RemoveObserver(abort);
  this->Scene->SetSamplesPerFrame(0);
  this->Window->Render();
  EXPECT_EQ(this->Scene->GetNumberOfSamples(), 3) << "what was begun, and the rest";
  EXPECT_TRUE(this->Scene->IsRefined());
}

TEST_F(VolumeMapper, LowersTheResolutionAtInteractiveRates)
{
  this->Renderer->AddVolume(this->Volume);
  const int covered = CountCovered(this->RenderDistances());
  constexpr int edge = 8; // of pixels, the largest
  this->Scene->SetInteractiveReduction(edge);
  EXPECT_EQ(CountCovered(this->RenderDistances()), covered);
  EXPECT_EQ(CountTiles(this->Scene), 13 * 13) << "a still picture is whole";
  this->Window->SetDesiredUpdateRate(15.0);
  EXPECT_NEAR(CountCovered(this->RenderDistances()), covered, 0.1 * covered);
  EXPECT_EQ(CountTiles(this->Scene), 2 * 2);
  this->Window->SetDesiredUpdateRate(0.001);
  EXPECT_EQ(CountCovered(this->RenderDistances()), covered);
  EXPECT_EQ(CountTiles(this->Scene), 13 * 13);
}

TEST_F(VolumeMapper, ShowsADraftOfWhatIsNew)
{
  this->Renderer->AddVolume(this->Volume);
  this->Scene->SetSamplesPerFrame(1);
  this->Scene->SetShowsDrafts(true);
  const int draft = CountCovered(this->RenderDistances());
  EXPECT_EQ(CountTiles(this->Scene), 2 * 2) << "its time is unknown";
  EXPECT_EQ(this->Scene->GetNumberOfSamples(), 0);
  EXPECT_FALSE(this->Scene->IsRefined());
  const std::vector<double> whole = this->RenderDistances();
  EXPECT_EQ(CountTiles(this->Scene), 13 * 13);
  EXPECT_NEAR(CountCovered(whole), draft, 0.1 * draft);
  EXPECT_TRUE(this->Scene->IsRefined());
  this->Renderer->GetActiveCamera()->Azimuth(3.0);
  this->RenderDistances();
  EXPECT_EQ(CountTiles(this->Scene), 13 * 13) << "the last one was quick";
  this->Renderer->GetActiveCamera()->Azimuth(-3.0);
  this->Scene->SetSamplesPerFrame(0);
  EXPECT_EQ(this->RenderDistances(), whole);
}

TEST_F(VolumeMapper, RefinesThePicturesOfBothEyes)
{
  this->Renderer->AddVolume(this->Volume);
  this->Mapper->GetLightOptions()->SetSamplesPerPixel(2);
  this->Mapper->GetLightOptions()->SetAmbientOcclusionSamples(30); // takes long
  this->Window->SetStereoTypeToRedBlue();
  this->Window->StereoRenderOn();
  const auto whole = this->Draw(this->Mapper);
  bool isRedOnly = false;
  for (vtkIdType pixel = 0; pixel < whole->GetNumberOfTuples(); ++pixel)
  {
    isRedOnly = isRedOnly ||
      (whole->GetTypedComponent(pixel, 0) > 0 && whole->GetTypedComponent(pixel, 2) == 0);
  }
  EXPECT_TRUE(isRedOnly) << "the eyes see different pictures";
  this->Scene->SetSamplesPerFrame(1);
  constexpr double fewSeconds = 1e-6;
  this->Scene->SetSecondsPerFrame(fewSeconds);
  for (const double angle : { 4.0, -4.0 })
  {
    this->Renderer->GetActiveCamera()->Azimuth(angle);
    this->Window->Render();
  }
  EXPECT_FALSE(this->Scene->IsRefined());
  int advances = 0;
  while (!this->Scene->IsRefined() && advances < 1000)
  {
    EXPECT_TRUE(this->AdvanceShortly());
    ++advances;
  }
  EXPECT_GT(advances, 2) << "it was interrupted";
  EXPECT_EQ(this->Scene->GetNumberOfSamples(), 2);
  EXPECT_EQ(this->Scene->GetRefinedPart(), 1.0);
  this->Window->Render();
  vtkNew<vtkUnsignedCharArray> refined;
  this->Window->GetPixelData(0, 0, Size - 1, Size - 1, 0, refined);
  EXPECT_EQ(GetDifference(refined, whole), 0.0);
}

TEST_F(VolumeMapper, ContinuesWithDraftsThatWereInterrupted)
{
  this->Renderer->AddVolume(this->Volume);
  this->Window->Render();
  this->Mapper->GetLightOptions()->SetAmbientOcclusionSamples(1000); // takes long
  this->Scene->SetSamplesPerFrame(1);
  this->Scene->SetShowsDrafts(true);
  this->Scene->SetSecondsPerFrame(1e-6);
  this->Renderer->GetActiveCamera()->Azimuth(4.0);
  this->Window->Render();
  EXPECT_FALSE(this->Scene->IsRefined());
  int advances = 0;
  for (; !this->Scene->IsRefined() && advances < 1000; ++advances)
  {
    EXPECT_TRUE(this->AdvanceShortly());
  }
  EXPECT_TRUE(this->Scene->IsRefined());
  EXPECT_GT(advances, 2) << "they were interrupted";
}

TEST_F(VolumeMapper, EndsFramesInTimeWithoutHoles)
{
  this->Renderer->AddVolume(this->Volume);
  this->Mapper->GetLightOptions()->SetSamplesPerPixel(2);
  this->Mapper->GetLightOptions()->SetAmbientOcclusionSamples(30); // takes long
  const std::vector<double> first = this->RenderDistances();
  const int covered = CountCovered(first);
  this->Scene->SetSamplesPerFrame(1);
  constexpr double fewSeconds = 1e-6;
  this->Scene->SetSecondsPerFrame(fewSeconds);
  this->Renderer->GetActiveCamera()->Azimuth(4.0);
  EXPECT_NEAR(CountCovered(this->RenderDistances()), covered, 0.1 * covered) << "the last picture";
  EXPECT_FALSE(this->Scene->IsRefined());
  EXPECT_TRUE(this->Scene->HasBegun());

  // Between frames, as often as there is time.
  int advances = 0;
  double part = 0.0;
  while (!this->Scene->IsRefined() && advances < 1000)
  {
    EXPECT_TRUE(this->AdvanceShortly());
    EXPECT_GE(this->Scene->GetRefinedPart(), part);
    part = this->Scene->GetRefinedPart();
    EXPECT_EQ(part == 1.0, this->Scene->IsRefined());
    ++advances;
    if (advances % 7 == 0)
    {
      EXPECT_NEAR(CountCovered(this->RenderDistances()), covered, 0.1 * covered);
      EXPECT_FALSE(this->Scene->HasBegun());
    }
  }
  EXPECT_GT(advances, 2) << "it was interrupted";
  EXPECT_EQ(part, 1.0);
  EXPECT_FALSE(this->Scene->Advance([] { return true; })) << "there is nothing left";
  const std::vector<double> whole = this->RenderDistances();
  this->Scene->SetSamplesPerFrame(0);
  this->Renderer->GetActiveCamera()->Azimuth(1.0);
  this->RenderDistances();
  this->Renderer->GetActiveCamera()->Azimuth(-1.0);
  EXPECT_EQ(this->RenderDistances(), whole) << "as without interruption";

  // While the camera moves, on and on.
  this->Window->SetDesiredUpdateRate(15.0);
  this->Scene->SetInteractiveReduction(1);
  for (int frame = 0; frame < 5; ++frame)
  {
    this->Renderer->GetActiveCamera()->Azimuth(3.0);
    EXPECT_NEAR(CountCovered(this->RenderDistances()), covered, 0.2 * covered) << frame;
  }
}

TEST_F(VolumeMapper, FiltersTheLightOfOcclusionAtInteractiveRates)
{
  this->Renderer->AddVolume(this->Volume);
  vtkNew<vtkPlane> middle; // lays the hollow open, of which a single ray sees all or nothing
  middle->SetOrigin(this->Volume->GetCenter());
  middle->SetNormal(this->Renderer->GetActiveCamera()->GetDirectionOfProjection());
  this->Mapper->AddClippingPlane(middle);
  this->Mapper->GetLightOptions()->SetAmbientOcclusionSamples(1);
  const auto grab = [this](double rate)
  {
    this->Window->SetDesiredUpdateRate(rate);
    this->Window->Render();
    vtkNew<vtkUnsignedCharArray> pixels;
    this->Window->GetPixelData(0, 0, Size - 1, Size - 1, 0, pixels);
    return std::vector<unsigned char>(pixels->Begin(), pixels->End());
  };
  const std::vector<unsigned char> still = grab(0.001);
  const std::vector<unsigned char> moving = grab(15.0);
  const auto sumSteps = [](const std::vector<unsigned char>& pixels)
  {
    double sum = 0.0;
    for (std::size_t value = 3; value < pixels.size(); ++value)
    {
      sum += std::abs(pixels[value] - pixels[value - 3]);
    }
    return sum;
  };
  EXPECT_LT(sumSteps(moving), 0.5 * sumSteps(still)) << "no black dots";
  EXPECT_EQ(grab(0.001), still);
  this->Mapper->GetLightOptions()->SetDenoise(vtkDSMLightOptions::DenoiseAlways);
  EXPECT_EQ(grab(0.001), moving);
  this->Mapper->GetLightOptions()->SetDenoise(vtkDSMLightOptions::DenoiseNever);
  EXPECT_EQ(grab(15.0), still);

  // A picture that gets its samples one by one is filtered until it has all.
  this->Mapper->GetLightOptions()->SetSamplesPerPixel(3);
  const std::vector<unsigned char> exact = grab(0.001);
  this->Mapper->GetLightOptions()->SetDenoise(vtkDSMLightOptions::DenoiseIncomplete);
  this->Scene->SetSamplesPerFrame(1);
  for (int samples = 1; samples < 3; ++samples)
  {
    EXPECT_LT(sumSteps(grab(0.001)), 0.7 * sumSteps(exact)) << samples;
    EXPECT_EQ(this->Scene->GetNumberOfSamples(), samples);
  }
  EXPECT_EQ(grab(0.001), exact);
}

TEST_F(VolumeMapper, TellsTheProgressAndCanBeAborted)
{
  struct Watch
  {
    vtkDSMScene* Scene;
    vtkDSMVolumeMapper* Mapper;
    std::vector<double> Parts;
    bool Aborts;
  } watch{ this->Scene, this->Mapper, {}, true };
  vtkNew<vtkCallbackCommand> progress;
  progress->SetClientData(&watch);
  progress->SetCallback(
    [](vtkObject*, unsigned long, void* data, void*)
    {
      auto* self = static_cast<Watch*>(data);
      // VTK executes the mapper once more when it draws.
      if (self->Scene->IsTracing())
      {
        self->Parts.push_back(self->Mapper->GetProgress());
        self->Mapper->SetAbortExecute(self->Aborts ? 1 : 0);
      }
    });
  this->Mapper->AddObserver(vtkCommand::ProgressEvent, progress);
  vtkNew<vtkTest::ErrorObserver> errors;
  this->Mapper->AddObserver(vtkCommand::ErrorEvent, errors);
  this->Renderer->AddVolume(this->Volume);

  EXPECT_EQ(CountCovered(this->RenderDistances()), 0);
  EXPECT_NE(errors->GetErrorMessage().find("aborted"), std::string::npos);
  EXPECT_EQ(watch.Parts.size(), 1u);

  watch = { this->Scene, this->Mapper, {}, false };
  errors->Clear();
  this->Mapper->SetInputData(MakeBall());
  EXPECT_GT(CountCovered(this->RenderDistances()), 1000);
  EXPECT_FALSE(errors->GetError());
  EXPECT_GT(watch.Parts.size(), 2u);
  EXPECT_TRUE(std::is_sorted(watch.Parts.begin(), watch.Parts.end()));
  EXPECT_EQ(watch.Parts.back(), 1.0);
}
