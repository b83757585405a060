// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMVolumeWriter.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkPVDSMVolumeWriter);

vtkPVDSMVolumeWriter::vtkPVDSMVolumeWriter() = default;
vtkPVDSMVolumeWriter::~vtkPVDSMVolumeWriter() = default;

void vtkPVDSMVolumeWriter::SetFileName(const char* name)
{
  this->Superclass::SetFileName(name);
}

void vtkPVDSMVolumeWriter::SetCompression(int compression)
{
  this->Superclass::SetCompression(compression);
}

void vtkPVDSMVolumeWriter::SetCoarserLevels(bool coarser)
{
  this->Superclass::SetCoarserLevels(coarser);
}

int vtkPVDSMVolumeWriter::Write()
{
  return this->Superclass::Write();
}

void vtkPVDSMVolumeWriter::SetInputConnection(vtkAlgorithmOutput* input)
{
  this->Superclass::SetInputConnection(input);
}

void vtkPVDSMVolumeWriter::SetInputConnection(int port, vtkAlgorithmOutput* input)
{
  this->Superclass::SetInputConnection(port, input);
}
