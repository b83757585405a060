// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMProgress_h
#define vtkDSMProgress_h

class vtkAlgorithm;

/// Progress of a mapper: reports the building of its bricks, whose observers may abort it, and the tracing of
/// its data.
namespace vtkDSMProgress
{
/// Before the building: an earlier wish to stop is over.
void Begin(vtkAlgorithm* mapper);

/// Invokes the mapper's ProgressEvent with `part`, 0 to 1. Throws dsm::Error when AbortExecute is set
/// then; where bricks are built, that ends the building on all ranks.
void Tell(vtkAlgorithm* mapper, double part);

/// Reports the progress of a frame's tiles; the mapper's ProgressText describes it until the call returns. It
/// cannot be aborted.
void TellOfTracing(vtkAlgorithm* mapper, double part);
}

#endif
