// SPDX-License-Identifier: BSD-3-Clause
// Several MPI ranks; draws nothing. What they exchange for a frame. And: one rank runs out of memory, in turn at
// each of the larger allocations that it makes between the data and the frame: every rank reports it, none waits,
// and the next frame is as it should be.
#include "vtkDSMLightOptions.h"
#include "vtkDSMMemoryOptions.h"
#include "vtkDSMRankGroup.h"
#include "vtkDSMScene.h"
#include "vtkDSMStatistics.h"
#include "vtkDSMVolumeMapper.h"

#include "vtkAutoInit.h"
#include "vtkCallbackCommand.h"
#include "vtkCamera.h"
#include "vtkCellData.h"
#include "vtkCommand.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkHyperTreeGrid.h"
#include "vtkHyperTreeGridNonOrientedCursor.h"
#include "vtkImageData.h"
#include "vtkMPIController.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkPropCollection.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkTestErrorObserver.h"
#include "vtkVolume.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <stdexcept>
#include <string>

namespace
{

/// Smaller ones are left alone: messages of a few bytes must get through for ranks to agree, and a
/// file stream wants 8 KiB.
constexpr std::size_t Large = 9000;

/// How many more large allocations succeed; negative: all.
std::atomic<long> Left{ -1 };

void* Allocate(std::size_t bytes)
{
  if (bytes >= Large && Left.load() >= 0 && Left.fetch_sub(1) == 0)
  {
    throw std::bad_alloc();
  }
  void* memory = std::malloc(bytes > 0 ? bytes : 1);
  if (!memory)
  {
    throw std::bad_alloc();
  }
  return memory;
}

} // namespace

void* operator new(std::size_t bytes)
{
  return Allocate(bytes);
}

void* operator new[](std::size_t bytes)
{
  return Allocate(bytes);
}

void operator delete(void* memory) noexcept
{
  std::free(memory);
}

void operator delete[](void* memory) noexcept
{
  std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept
{
  std::free(memory);
}

void operator delete[](void* memory, std::size_t) noexcept
{
  std::free(memory);
}

namespace
{

constexpr int Edge = 60;

/// This rank's slab, along z, of the distance from the middle.
vtkSmartPointer<vtkImageData> MakeSlab(int rank, int ranks)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetExtent(0, Edge, 0, Edge, Edge * rank / ranks, Edge * (rank + 1) / ranks);
  vtkNew<vtkFloatArray> distance;
  distance->SetName("distance");
  distance->SetNumberOfTuples(image->GetNumberOfPoints());
  for (vtkIdType point = 0; point < image->GetNumberOfPoints(); ++point)
  {
    double x[3];
    image->GetPoint(point, x);
    double square = 0.0;
    for (const double coordinate : x)
    {
      square += (coordinate - 0.5 * Edge) * (coordinate - 0.5 * Edge);
    }
    distance->SetValue(point, static_cast<float>(std::sqrt(square)));
  }
  image->GetPointData()->SetScalars(distance);
  return image;
}

/// Roots only, from 2 to 3 edges along x, with the distance from the middle.
vtkSmartPointer<vtkHyperTreeGrid> MakeTrees()
{
  constexpr unsigned roots = 6;
  auto grid = vtkSmartPointer<vtkHyperTreeGrid>::New();
  const unsigned points[] = { roots + 1, roots + 1, roots + 1 };
  grid->SetDimensions(points);
  grid->SetBranchFactor(2);
  vtkNew<vtkDoubleArray> axes[3];
  for (unsigned point = 0; point <= roots; ++point)
  {
    const double place = static_cast<double>(Edge) * point / roots;
    axes[0]->InsertNextValue(2.0 * Edge + place);
    axes[1]->InsertNextValue(place);
    axes[2]->InsertNextValue(place);
  }
  grid->SetXCoordinates(axes[0]);
  grid->SetYCoordinates(axes[1]);
  grid->SetZCoordinates(axes[2]);
  vtkNew<vtkDoubleArray> distance;
  distance->SetName("distance");
  vtkNew<vtkHyperTreeGridNonOrientedCursor> cursor;
  for (vtkIdType tree = 0; tree < grid->GetMaxNumberOfTrees(); ++tree)
  {
    grid->InitializeNonOrientedCursor(cursor, tree, true);
    cursor->SetGlobalIndexStart(tree);
    unsigned at[3];
    grid->GetLevelZeroCoordinatesFromIndex(tree, at[0], at[1], at[2]);
    double square = 0.0;
    for (const unsigned root : at)
    {
      const double apart = Edge * ((root + 0.5) / roots - 0.5);
      square += apart * apart;
    }
    distance->InsertValue(tree, std::sqrt(square));
  }
  grid->GetCellData()->AddArray(distance);
  return grid;
}

class SeveralRanks : public testing::Test
{
protected:
  SeveralRanks()
    : Controller(vtkMultiProcessController::GetGlobalController())
    , Scene(vtkDSMScene::ForRenderer(this->Renderer))
  {
    this->Window->SetSize(100, 80);
    this->Window->AddRenderer(this->Renderer);
    this->Mapper->SetIsoArray("distance");
    this->Mapper->SetIsoValue(0, 20.0);
    this->Mapper->GetMemoryOptions()->SetNumberOfThreads(2);
    this->Mapper->GetMemoryOptions()->SetCacheSize(8);
    this->Volume->SetMapper(this->Mapper);
    this->Renderer->AddVolume(this->Volume);
    this->Renderer->GetActiveCamera()->SetPosition(60.0, 90.0, 200.0);
    this->Renderer->GetActiveCamera()->SetFocalPoint(30.0, 30.0, 30.0);
    this->Renderer->ResetCameraClippingRange(0.0, Edge, 0.0, Edge, 0.0, Edge);
    this->Scene->AddObserver(vtkCommand::ErrorEvent, this->Errors);
    this->Mapper->AddObserver(vtkCommand::ErrorEvent, this->Errors);
  }

  void GiveNewData()
  {
    const auto slab =
      MakeSlab(this->Controller->GetLocalProcessId(), this->Controller->GetNumberOfProcesses());
    // All of them: bricks of data that are the same would be kept.
    vtkDataArray* const values = slab->GetPointData()->GetScalars();
    ++this->TimesGiven;
    for (vtkIdType point = 0; point < values->GetNumberOfTuples(); ++point)
    {
      values->SetComponent(point, 0, values->GetComponent(point, 0) + 1e-3 * this->TimesGiven);
    }
    this->Mapper->SetInputData(slab);
  }

  /// Traces a frame; returns what was reported.
  std::string Trace()
  {
    this->Errors->Clear();
    this->Renderer->InvokeEvent(vtkCommand::StartEvent);
    return this->Errors->GetError() ? this->Errors->GetErrorMessage() : std::string();
  }

  /// Traces a frame; returns how many collective steps the ranks have taken for it.
  int CountSteps()
  {
    const auto group = vtkDSMRankGroup::Get(this->Controller);
    const std::uint32_t before = group->GetMessenger().GetSession();
    EXPECT_EQ(this->Trace(), "");
    return static_cast<int>(group->GetMessenger().GetSession() - before);
  }

  /// Whether all ranks have the statistics of rank 0.
  bool HaveSameStatistics()
  {
    const std::string mine = this->Scene->GetStatistics()->GetJson();
    auto size = static_cast<vtkIdType>(mine.size());
    this->Controller->Broadcast(&size, 1, 0);
    std::string first = mine;
    first.resize(static_cast<std::size_t>(size));
    this->Controller->Broadcast(first.data(), size, 0);
    return mine == first;
  }

  vtkMultiProcessController* Controller;
  vtkNew<vtkRenderer> Renderer;
  vtkNew<vtkRenderWindow> Window;
  vtkSmartPointer<vtkDSMScene> Scene;
  vtkNew<vtkDSMVolumeMapper> Mapper;
  vtkNew<vtkVolume> Volume;
  vtkNew<vtkTest::ErrorObserver> Errors;
  int TimesGiven = 0;
};

TEST_F(SeveralRanks, KindsThatOneRankHasAreShownByAll)
{
  const int rank = this->Controller->GetLocalProcessId();
  const int last = this->Controller->GetNumberOfProcesses() - 1;
  const auto trees = MakeTrees();
  vtkNew<vtkMultiBlockDataSet> blocks;
  if (rank == 0)
  {
    blocks->SetBlock(0, MakeSlab(0, 1));
  }
  if (rank == last)
  {
    blocks->SetBlock(1, trees);
  }
  this->Mapper->SetInputData(blocks);
  EXPECT_EQ(this->Trace(), "");
  ASSERT_TRUE(this->Mapper->GetBounds());
  EXPECT_EQ(this->Mapper->GetBounds()[0], 0.0);
  EXPECT_EQ(this->Mapper->GetBounds()[1], 3.0 * Edge);
  // Only one rank has anything that can be shown.
  vtkNew<vtkMultiBlockDataSet> others;
  others->SetBlock(0, vtkSmartPointer<vtkPolyData>::New());
  this->Mapper->SetInputData(rank > 0 ? others.Get() : blocks.Get());
  EXPECT_EQ(this->Trace(), "");
  // A failure of one is one of all.
  trees->GetXCoordinates()->SetTuple1(1, 1.3 * Edge);
  this->Mapper->SetInputData(blocks);
  EXPECT_NE(
    this->Trace().find("roots of the hyper tree grid are not equally spaced"), std::string::npos);
}

TEST_F(SeveralRanks, OutOfMemoryOfOneIsReportedByAllAndTheNextFrameIsDrawn)
{
  const int last = this->Controller->GetNumberOfProcesses() - 1;
  int failures = 0;
  for (long allocation = 0;; ++allocation)
  {
    this->GiveNewData();
    if (this->Controller->GetLocalProcessId() == last)
    {
      Left = allocation;
    }
    const std::string report = this->Trace();
    int reached = Left.exchange(-1) < 0;
    // Only the last rank knows whether its allocation came.
    this->Controller->Broadcast(&reached, 1, last);
    if (!reached)
    {
      EXPECT_EQ(report, "");
      break;
    }
    // Automatic memory organization may go on without the memory; else it is said.
    if (this->Scene->GetStatistics()->GetFrameSeconds() == 0.0)
    {
      ++failures;
      EXPECT_NE(report.find("out of memory"), std::string::npos) << allocation << ": " << report;
    }
    this->GiveNewData();
    EXPECT_EQ(this->Trace(), "") << "after allocation " << allocation;
    EXPECT_GT(this->Scene->GetStatistics()->GetFrameSeconds(), 0.0) << allocation;
  }
  EXPECT_GT(failures, 20) << "the sweep came by the places where memory is taken";
}

TEST_F(SeveralRanks, ExchangeTwoRecordsForAFrameWithNothingNew)
{
  using Options = vtkDSMMemoryOptions;
  vtkDSMMemoryOptions* const options = this->Mapper->GetMemoryOptions();
  for (const int organization : { Options::Replicated, Options::ObjectBased })
  {
    // Object based memory numbers the requests for bricks, too, but exchanges nothing for it.
    const int steps = organization == Options::Replicated ? 2 : 3;
    options->SetMemoryOrganization(organization);
    this->GiveNewData();
    EXPECT_GT(this->CountSteps(), steps);
    EXPECT_EQ(this->CountSteps(), steps) << "nothing has changed";
    EXPECT_TRUE(this->HaveSameStatistics());
    EXPECT_EQ(
      this->Scene->GetStatistics()->GetNumberOfRanks(), this->Controller->GetNumberOfProcesses());
    this->Renderer->GetActiveCamera()->Azimuth(10.0);
    EXPECT_EQ(this->CountSteps(), steps) << "another camera";
    this->Mapper->SetIsoValue(0, 21.0);
    EXPECT_EQ(this->CountSteps(), steps) << "another isovalue";
    if (this->Controller->GetLocalProcessId() == 1)
    {
      this->GiveNewData();
    }
    EXPECT_GT(this->CountSteps(), steps) << "one rank has new data";
    EXPECT_EQ(this->CountSteps(), steps);

    this->Mapper->GetLightOptions()->SetSamplesPerPixel(2);
    EXPECT_EQ(this->CountSteps(), steps + 1) << "with the pixels that surfaces cover in part";
    EXPECT_EQ(this->CountSteps(), 2) << "all samples are there: the view, and these pixels again";
    this->Mapper->GetLightOptions()->SetSamplesPerPixel(1);
    this->Mapper->SetIsoValue(0, 20.0);
  }
}

TEST_F(SeveralRanks, WhatFailsOnOneAfterTheFrameEndsTheNextOne)
{
  const int last = this->Controller->GetNumberOfProcesses() - 1;
  const bool fails = this->Controller->GetLocalProcessId() == last;
  this->GiveNewData();
  EXPECT_EQ(this->Trace(), "");
  vtkNew<vtkCallbackCommand> failure;
  failure->SetCallback([](vtkObject*, unsigned long, void*, void*)
    { throw std::runtime_error("the picture is lost"); });
  vtkObject* const picture = this->Renderer->GetViewProps()->GetItemAsObject(0);
  ASSERT_TRUE(picture->IsA("vtkDSMFrameProp"));
  if (fails)
  {
    picture->AddObserver(vtkCommand::ModifiedEvent, failure);
  }
  const auto isTold = [](const std::string& report)
  { return report.find("the picture is lost") != std::string::npos; };
  EXPECT_EQ(isTold(this->Trace()), fails);
  picture->RemoveObserver(failure);
  EXPECT_EQ(isTold(this->Trace()), !fails) << "it was told already where it was";
  EXPECT_EQ(this->Trace(), "");
  EXPECT_GT(this->Scene->GetStatistics()->GetFrameSeconds(), 0.0);
}

} // namespace

int main(int argc, char** argv)
{
  vtkNew<vtkMPIController> controller;
  controller->Initialize(&argc, &argv);
  vtkMultiProcessController::SetGlobalController(controller);
  testing::InitGoogleTest(&argc, argv);
  const int result = RUN_ALL_TESTS();
  vtkMultiProcessController::SetGlobalController(nullptr);
  controller->Finalize();
  return result;
}
