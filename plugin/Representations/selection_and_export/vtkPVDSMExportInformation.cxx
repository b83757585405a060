// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMExportInformation.h"

#include "vtkPVDSMExportLook.h"
#include "vtkPVDSMExportSource.h"

#include "vtkCharArray.h"
#include "vtkClientServerStream.h"
#include "vtkCommunicator.h"
#include "vtkMultiProcessStream.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

vtkStandardNewMacro(vtkPVDSMExportInformation);

vtkPVDSMExportInformation::vtkPVDSMExportInformation() = default;
vtkPVDSMExportInformation::~vtkPVDSMExportInformation() = default;

std::vector<vtkSmartPointer<vtkPolyData>> vtkPVDSMExportInformation::GetTriangles() const
{
  vtkPVDSMExportParts all;
  for (const auto& part : this->Parts)
  {
    all.Add(part, vtkPVDSMExportLook::Get(part));
  }
  return all.Finish();
}

void vtkPVDSMExportInformation::CopyFromObject(vtkObject* representation)
{
  auto* source = dynamic_cast<vtkPVDSMExportSource*>(representation);
  const auto mine = source ? source->GetTriangles() : std::vector<vtkSmartPointer<vtkPolyData>>();
  this->Parts.clear();
  this->NumberOfPolygons = 0;
  for (const auto& part : mine)
  {
    this->NumberOfPolygons += part->GetNumberOfPolys() + part->GetNumberOfStrips();
  }
  if (this->WithTriangles)
  {
    this->Parts = mine;
  }
}

void vtkPVDSMExportInformation::AddInformation(vtkPVInformation* other)
{
  if (auto* theirs = vtkPVDSMExportInformation::SafeDownCast(other))
  {
    this->NumberOfPolygons += theirs->NumberOfPolygons;
    this->Parts.insert(this->Parts.end(), theirs->Parts.begin(), theirs->Parts.end());
  }
}

void vtkPVDSMExportInformation::CopyToStream(vtkClientServerStream* stream)
{
  stream->Reset();
  *stream << vtkClientServerStream::Reply << this->NumberOfPolygons
          << static_cast<int>(this->Parts.size());
  for (const auto& part : this->Parts)
  {
    vtkNew<vtkCharArray> bytes;
    vtkCommunicator::MarshalDataObject(part, bytes);
    *stream << vtkClientServerStream::InsertArray(
      bytes->GetPointer(0), static_cast<int>(bytes->GetNumberOfValues()));
  }
  *stream << vtkClientServerStream::End;
}

void vtkPVDSMExportInformation::CopyFromStream(const vtkClientServerStream* stream)
{
  int parts = 0;
  this->Parts.clear();
  stream->GetArgument(0, 0, &this->NumberOfPolygons);
  stream->GetArgument(0, 1, &parts);
  for (int part = 0; part < parts; ++part)
  {
    vtkTypeUInt32 size = 0;
    stream->GetArgumentLength(0, 2 + part, &size);
    vtkNew<vtkCharArray> bytes;
    bytes->SetNumberOfValues(size);
    const auto triangles = vtkSmartPointer<vtkPolyData>::New();
    if (stream->GetArgument(0, 2 + part, bytes->GetPointer(0), size) != 0 &&
      vtkCommunicator::UnMarshalDataObject(bytes, triangles) != 0)
    {
      this->Parts.push_back(triangles);
    }
  }
}

void vtkPVDSMExportInformation::CopyParametersToStream(vtkMultiProcessStream& stream)
{
  stream << (this->WithTriangles ? 1 : 0);
}

void vtkPVDSMExportInformation::CopyParametersFromStream(vtkMultiProcessStream& stream)
{
  int with = 0;
  stream >> with;
  this->WithTriangles = with != 0;
}

void vtkPVDSMExportInformation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "WithTriangles: " << this->WithTriangles << "\n";
  os << indent << "NumberOfPolygons: " << this->NumberOfPolygons << "\n";
}
