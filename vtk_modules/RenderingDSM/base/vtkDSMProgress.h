// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMProgress_h
#define vtkDSMProgress_h

class vtkAlgorithm;

/// How a mapper tells of the building of its bricks, and hears that nobody wants to wait for them; and of the tracing of
/// what it shows.
namespace vtkDSMProgress
{
/// Before the building: an earlier wish to stop is over.
void Begin(vtkAlgorithm* mapper);

/// Invokes the mapper's ProgressEvent with `part`, 0 to 1. Throws dsm::Error when AbortExecute is set
/// then; where bricks are built, that ends the building on all ranks.
void Tell(vtkAlgorithm* mapper, double part);

/// The same of a frame's tiles; until it returns, the mapper's ProgressText says so. Nothing is aborted.
void TellOfTracing(vtkAlgorithm* mapper, double part);
}

#endif
