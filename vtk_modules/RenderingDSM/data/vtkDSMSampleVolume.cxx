// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMSampleVolume.h"

#include "vtkDSMErrorGuard.h"
#include "vtkDSMScalarType.h"

#include "DSMBricks/sample/SampleVolume.h"

#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>
#include <vector>

vtkStandardNewMacro(vtkDSMSampleVolume);

namespace
{

bricks::SampleVolume CreateVolume(int kind, const int dimensions[3])
{
  return bricks::SampleVolume(kind == vtkDSMSampleVolume::SPHERE
      ? bricks::SampleVolume::Kind::Sphere
      : bricks::SampleVolume::Kind::MixingLayer,
    bricks::Index3(dimensions[0], dimensions[1], dimensions[2]));
}

const char* GetArrayName(int kind)
{
  return kind == vtkDSMSampleVolume::SPHERE ? "f" : "entropy";
}

} // namespace

vtkDSMSampleVolume::vtkDSMSampleVolume()
  : ScalarType(VTK_FLOAT)
{
  this->SetNumberOfInputPorts(0);
}

vtkDSMSampleVolume::~vtkDSMSampleVolume() = default;

int vtkDSMSampleVolume::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  for (const int points : this->Dimensions)
  {
    if (points < 2)
    {
      vtkErrorMacro("Dimensions of " << this->Dimensions[0] << " x " << this->Dimensions[1] << " x "
                                     << this->Dimensions[2]
                                     << " are invalid; use at least 2 samples along each axis.");
      return 0;
    }
  }
  return vtkDSMErrorGuard::Run(this, "making", GetArrayName(this->Kind),
    [&]
    {
      this->TellOfVolume(output->GetInformationObject(0));
      return 1;
    });
}

void vtkDSMSampleVolume::TellOfVolume(vtkInformation* information) const
{
  const int extent[6] = { 0, this->Dimensions[0] - 1, 0, this->Dimensions[1] - 1, 0,
    this->Dimensions[2] - 1 };
  const bricks::SampleVolume volume = CreateVolume(this->Kind, this->Dimensions);
  const glm::dvec3 origin = volume.GetOrigin();
  const double spacing = volume.GetSpacing();
  information->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent, 6);
  information->Set(vtkDataObject::ORIGIN(), origin.x, origin.y, origin.z);
  information->Set(vtkDataObject::SPACING(), spacing, spacing, spacing);
  information->Set(vtkAlgorithm::CAN_PRODUCE_SUB_EXTENT(), 1);
  vtkDataObject::SetPointDataActiveScalarInfo(information, this->ScalarType, 1);
}

int vtkDSMSampleVolume::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  return vtkDSMErrorGuard::Run(this, "making", GetArrayName(this->Kind),
    [&]
    {
      this->FillImage(vtkImageData::GetData(output), output->GetInformationObject(0));
      return 1;
    });
}

void vtkDSMSampleVolume::FillImage(vtkImageData* image, vtkInformation* information)
{
  int extent[6];
  information->Get(vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT(), extent);
  this->AllocateOutputData(image, information, extent);
  vtkDataArray* scalars = image->GetPointData()->GetScalars();
  if (!scalars || scalars->GetNumberOfTuples() == 0)
  {
    return;
  }
  scalars->SetName(GetArrayName(this->Kind));

  const bricks::SampleVolume volume = CreateVolume(this->Kind, this->Dimensions);
  const bricks::ScalarType type = vtkDSMScalarType::FromArray(scalars);
  const int rows = extent[3] - extent[2] + 1;
  const int slices = extent[5] - extent[4] + 1;
  const std::size_t rowBytes = (extent[1] - extent[0] + 1) * bricks::GetBytes(type);
  auto* const first = static_cast<std::byte*>(scalars->GetVoidPointer(0));
  std::atomic<int> nextSlice{ 0 };
  std::atomic<int> slicesDone{ 0 };
  const auto fill = [&](const auto& report)
  {
    for (int slice = nextSlice++; slice < slices && !this->AbortExecute; slice = nextSlice++)
    {
      const bricks::Box points{ { extent[0], extent[2], extent[4] + slice },
        { extent[1] + 1, extent[3] + 1, extent[4] + slice + 1 } };
      volume.Fill(points, type, first + slice * rows * rowBytes);
      report(++slicesDone);
    }
  };
  std::vector<std::thread> helpers;
  const unsigned int cores = std::max(std::thread::hardware_concurrency(), 1u);
  helpers.reserve(cores);
  try
  {
    for (unsigned int helper = 1; helper < cores; ++helper)
    {
      helpers.emplace_back([&] { fill([](int) {}); });
    }
  }
  catch (const std::exception&) // the system has no more threads; those that there are do the work
  {
  }
  // Only the calling thread may tell the application how far it is.
  fill([&](int done) { this->UpdateProgress(static_cast<double>(done) / slices); });
  for (std::thread& helper : helpers)
  {
    helper.join();
  }
}

void vtkDSMSampleVolume::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Kind: " << this->Kind << "\n";
  os << indent << "Dimensions: " << this->Dimensions[0] << " " << this->Dimensions[1] << " "
     << this->Dimensions[2] << "\n";
  os << indent << "ScalarType: " << this->ScalarType << "\n";
}
