// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMFrameReport.h"

#include "vtkDSMScene.h"
#include "vtkDSMStatistics.h"
#include "vtkDSMVolumeMapper.h"
#include "vtkPVDSMClientWatch.h"
#include "vtkPVDSMImageCompressor.h"

#include "vtkMath.h"
#include "vtkObjectFactory.h"
#include "vtkPVRenderView.h"

#include <algorithm>
#include <chrono>

namespace
{
/// For which tracing goes on whatever the client sends, so that one that asks often does not stop it.
constexpr std::chrono::milliseconds LeastTime(50);
}

vtkStandardNewMacro(vtkPVDSMFrameReport);

vtkPVDSMFrameReport::vtkPVDSMFrameReport() = default;
vtkPVDSMFrameReport::~vtkPVDSMFrameReport() = default;

void vtkPVDSMFrameReport::SetView(vtkPVRenderView* view)
{
  this->View = view;
}

vtkDSMScene* vtkPVDSMFrameReport::FindScene() const
{
  return this->View ? vtkDSMScene::Find(this->View->GetRenderer()) : nullptr;
}

void vtkPVDSMFrameReport::SetVolume(vtkDSMVolumeMapper* volume)
{
  this->Volume = volume;
}

double vtkPVDSMFrameReport::GetSuggestedIsoValue()
{
  return this->Volume ? this->Volume->GetSuggestedIsoValue() : vtkMath::Nan();
}

double* vtkPVDSMFrameReport::GetSuggestedRange()
{
  const double* const range = this->Volume ? this->Volume->GetSuggestedRange() : nullptr;
  this->Range[0] = range ? range[0] : vtkMath::Nan();
  this->Range[1] = range ? range[1] : vtkMath::Nan();
  return this->Range;
}

int* vtkPVDSMFrameReport::GetSlicePoints()
{
  std::fill_n(this->SlicePoints, 3, 0);
  if (this->Volume)
  {
    this->Volume->GetSlicePoints(this->SlicePoints);
  }
  return this->SlicePoints;
}

double vtkPVDSMFrameReport::GetFrameTime()
{
  vtkDSMScene* const scene = this->FindScene();
  return scene ? scene->GetStatistics()->GetFrameSeconds() : 0.0;
}

const char* vtkPVDSMFrameReport::GetStatistics()
{
  vtkDSMScene* const scene = this->FindScene();
  this->Text = scene ? scene->GetStatistics()->GetJson() : "[]";
  return this->Text.c_str();
}

const char* vtkPVDSMFrameReport::GetSummary()
{
  vtkDSMScene* const scene = this->FindScene();
  this->Text = scene ? scene->GetStatistics()->GetSummary() : std::string();
  return this->Text.c_str();
}

int* vtkPVDSMFrameReport::GetSamples()
{
  vtkDSMScene* const scene = this->FindScene();
  this->Samples[0] = scene ? scene->GetNumberOfSamples() : 0;
  this->Samples[1] = scene ? scene->GetNumberOfSamplesWanted() : 0;
  return this->Samples;
}

double* vtkPVDSMFrameReport::GetRefinement()
{
  vtkDSMScene* const scene = this->FindScene();
  this->Refinement[0] = scene ? scene->GetNumberOfSamples() : 0.0;
  this->Refinement[1] = scene ? scene->GetNumberOfSamplesWanted() : 0.0;
  this->Refinement[2] = scene ? scene->GetRefinedPart() : 1.0;
  this->Refinement[3] = scene && scene->HasBegun() ? 1.0 : 0.0;
  return this->Refinement;
}

void vtkPVDSMFrameReport::Advance(double seconds)
{
  using Clock = std::chrono::steady_clock;
  const auto least = Clock::now() + LeastTime;
  const auto end = Clock::now() +
    std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  if (vtkDSMScene* const scene = this->FindScene())
  {
    scene->Advance([=, client = vtkPVDSMClientWatch()]
      { return Clock::now() < least || (Clock::now() < end && !client.HasSent()); });
  }
}

void vtkPVDSMFrameReport::SetProgressive(bool progressive)
{
  this->Progressive = progressive;
}

bool vtkPVDSMFrameReport::GetProgressive()
{
  return this->Progressive;
}

void vtkPVDSMFrameReport::SetInteracting(bool interacting)
{
  this->Interacting = interacting;
}

bool vtkPVDSMFrameReport::GetInteracting()
{
  return this->Interacting;
}

void vtkPVDSMFrameReport::CompressPictures(bool compress)
{
  if (compress)
  {
    vtkPVDSMImageCompressor::Use(this->View);
  }
}

void vtkPVDSMFrameReport::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "SuggestedIsoValue: " << this->GetSuggestedIsoValue() << "\n";
  os << indent << "FrameTime: " << this->GetFrameTime() << "\n";
  os << indent << "Statistics: " << this->GetStatistics() << "\n";
}
