// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMKnownBounds.h"

#include "vtkAlgorithm.h"
#include "vtkDataObject.h"
#include "vtkDemandDrivenPipeline.h"
#include "vtkMath.h"
#include "vtkTrivialProducer.h"

#include <algorithm>

namespace
{

vtkDataObject* GetData(vtkAlgorithm* mapper)
{
  return mapper->GetNumberOfInputConnections(0) > 0 ? mapper->GetInputDataObject(0, 0) : nullptr;
}

/// Returns the time of the last change to anything in the pipeline in front of a mapper.
vtkMTimeType GetPipelineTime(vtkAlgorithm* mapper)
{
  if (mapper->GetNumberOfInputConnections(0) == 0)
  {
    return 0;
  }
  vtkAlgorithm* producer = mapper->GetInputAlgorithm(0, 0);
  producer->UpdateInformation();
  auto* pipeline = vtkDemandDrivenPipeline::SafeDownCast(producer->GetExecutive());
  return pipeline ? pipeline->GetPipelineMTime() : 0;
}

vtkMTimeType GetTime(vtkAlgorithm* mapper)
{
  vtkDataObject* data = GetData(mapper);
  return std::max(GetPipelineTime(mapper), data ? data->GetMTime() : 0);
}

} // namespace

vtkDSMKnownBounds::vtkDSMKnownBounds()
{
  this->Clear();
}

void vtkDSMKnownBounds::Set(vtkAlgorithm* mapper, const double bounds[6])
{
  std::copy_n(bounds, 6, this->Bounds);
  this->Data = GetData(mapper);
  this->Time = GetTime(mapper);
}

const double* vtkDSMKnownBounds::Get(vtkAlgorithm* mapper, int pieces) const
{
  if (!vtkMath::AreBoundsInitialized(this->Bounds))
  {
    return nullptr;
  }
  const bool isSame = GetData(mapper) == this->Data && GetTime(mapper) <= this->Time;
  return isSame || pieces > 1 ? this->Bounds : nullptr;
}

void vtkDSMKnownBounds::Clear()
{
  vtkMath::UninitializeBounds(this->Bounds);
}

bool vtkDSMKnownBounds::IsOutOfDate(vtkAlgorithm* mapper)
{
  vtkDataObject* data = GetData(mapper);
  // A producer that passes on other objects' data is newer than the data, and never out of date.
  return data && !vtkTrivialProducer::SafeDownCast(mapper->GetInputAlgorithm(0, 0)) &&
    GetPipelineTime(mapper) > std::max(data->GetUpdateTime(), data->GetMTime());
}
