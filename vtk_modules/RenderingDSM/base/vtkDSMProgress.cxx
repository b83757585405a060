// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMProgress.h"

#include "DSMCore/base/Error.h"

#include "vtkAlgorithm.h"

void vtkDSMProgress::Begin(vtkAlgorithm* mapper)
{
  mapper->SetAbortExecute(0);
}

void vtkDSMProgress::Tell(vtkAlgorithm* mapper, double part)
{
  mapper->UpdateProgress(part);
  if (mapper->GetAbortExecute())
  {
    throw dsm::Error("The update was aborted. The dataset is not shown. Update it to try again.");
  }
}

void vtkDSMProgress::TellOfTracing(vtkAlgorithm* mapper, double part)
{
  mapper->SetProgressText("Ray tracing");
  mapper->UpdateProgress(part);
  mapper->SetProgressText(nullptr);
}
