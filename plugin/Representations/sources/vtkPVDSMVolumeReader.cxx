// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMVolumeReader.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkPVDSMVolumeReader);

vtkPVDSMVolumeReader::vtkPVDSMVolumeReader() = default;
vtkPVDSMVolumeReader::~vtkPVDSMVolumeReader() = default;

void vtkPVDSMVolumeReader::SetFileName(const char* name)
{
  this->Superclass::SetFileName(name);
}

void vtkPVDSMVolumeReader::AddFileName(const char* name)
{
  this->Superclass::AddFileName(name);
}

void vtkPVDSMVolumeReader::RemoveAllFileNames()
{
  this->Superclass::RemoveAllFileNames();
}

int vtkPVDSMVolumeReader::CanReadFile(const char* name)
{
  return this->Superclass::CanReadFile(name);
}

vtkDataArraySelection* vtkPVDSMVolumeReader::GetPointDataArraySelection()
{
  return this->Superclass::GetPointDataArraySelection();
}

vtkDataArraySelection* vtkPVDSMVolumeReader::GetCellDataArraySelection()
{
  return this->Superclass::GetCellDataArraySelection();
}

void vtkPVDSMVolumeReader::SetLevel(int level)
{
  this->Superclass::SetLevel(level);
}

const char* vtkPVDSMVolumeReader::GetLevelNames()
{
  return this->Superclass::GetLevelNames();
}

void vtkPVDSMVolumeReader::SetDatasetName(const char* name)
{
  this->Superclass::SetDatasetName(name ? name : "");
}

void vtkPVDSMVolumeReader::SetSpacing(double x, double y, double z)
{
  this->Superclass::SetSpacing(x, y, z);
}

void vtkPVDSMVolumeReader::SetSpacing(const double spacing[3])
{
  this->Superclass::SetSpacing(spacing);
}

void vtkPVDSMVolumeReader::SetOrigin(double x, double y, double z)
{
  this->Superclass::SetOrigin(x, y, z);
}

void vtkPVDSMVolumeReader::SetOrigin(const double origin[3])
{
  this->Superclass::SetOrigin(origin);
}

void vtkPVDSMVolumeReader::SetOwnOrigin(bool isOwn)
{
  this->Superclass::SetOwnOrigin(isOwn);
}

bool vtkPVDSMVolumeReader::GetRawFile()
{
  return this->Superclass::GetRawFile();
}

void vtkPVDSMVolumeReader::SetRawDimensions(int i, int j, int k)
{
  this->Superclass::SetRawDimensions(i, j, k);
}

void vtkPVDSMVolumeReader::SetRawDimensions(const int dimensions[3])
{
  this->Superclass::SetRawDimensions(dimensions);
}

void vtkPVDSMVolumeReader::SetRawScalarType(int type)
{
  this->Superclass::SetRawScalarType(type);
}

void vtkPVDSMVolumeReader::SetRawComponents(int components)
{
  this->Superclass::SetRawComponents(components);
}

void vtkPVDSMVolumeReader::SetRawBigEndian(bool isBigEndian)
{
  this->Superclass::SetRawBigEndian(isBigEndian);
}

void vtkPVDSMVolumeReader::SetRawHeaderBytes(vtkIdType bytes)
{
  this->Superclass::SetRawHeaderBytes(bytes);
}

void vtkPVDSMVolumeReader::SetRawSpacing(double x, double y, double z)
{
  this->Superclass::SetRawSpacing(x, y, z);
}

void vtkPVDSMVolumeReader::SetRawSpacing(const double spacing[3])
{
  this->Superclass::SetRawSpacing(spacing);
}

void vtkPVDSMVolumeReader::SetValuesInMemory(bool areInMemory)
{
  this->Superclass::SetValuesInMemory(areInMemory);
}
