// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMExportLook.h"

#include "vtkActor.h"
#include "vtkAppendPolyData.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkMapper.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkProperty.h"

namespace
{

/// Red, green, blue, opacity; less than 0 where the rest's counts.
constexpr const char* LookArray = "DSMBlockLook";

} // namespace

vtkPVDSMExportLook vtkPVDSMExportLook::Get(vtkPolyData* polygons)
{
  vtkPVDSMExportLook look;
  if (vtkDataArray* numbers = polygons->GetFieldData()->GetArray(LookArray))
  {
    const double* tuple = numbers->GetTuple(0);
    if (tuple[0] >= 0.0)
    {
      look.Color = { tuple[0], tuple[1], tuple[2] };
    }
    if (tuple[3] >= 0.0)
    {
      look.Opacity = tuple[3];
    }
  }
  return look;
}

void vtkPVDSMExportLook::GiveTo(vtkPolyData* polygons) const
{
  const std::array<double, 3> color =
    this->Color.value_or(std::array<double, 3>{ -1.0, -1.0, -1.0 });
  vtkNew<vtkDoubleArray> numbers;
  numbers->SetName(LookArray);
  numbers->SetNumberOfComponents(4);
  numbers->InsertNextTuple4(color[0], color[1], color[2], this->Opacity.value_or(-1.0));
  polygons->GetFieldData()->AddArray(numbers);
}

void vtkPVDSMExportLook::ApplyTo(vtkActor* actor) const
{
  if (!this->Color && !this->Opacity)
  {
    return;
  }
  vtkNew<vtkProperty> own;
  own->DeepCopy(actor->GetProperty());
  if (this->Color)
  {
    actor->GetMapper()->ScalarVisibilityOff();
    own->SetColor((*this->Color)[0], (*this->Color)[1], (*this->Color)[2]);
  }
  own->SetOpacity(this->Opacity.value_or(own->GetOpacity()));
  actor->SetProperty(own);
}

void vtkPVDSMExportParts::Add(vtkPolyData* polygons, const vtkPVDSMExportLook& look)
{
  vtkSmartPointer<vtkAppendPolyData>& part = this->Parts[look];
  if (!part)
  {
    part = vtkSmartPointer<vtkAppendPolyData>::New();
  }
  part->AddInputData(polygons);
}

std::vector<vtkSmartPointer<vtkPolyData>> vtkPVDSMExportParts::Finish() const
{
  std::vector<vtkSmartPointer<vtkPolyData>> finished;
  for (const auto& [look, part] : this->Parts)
  {
    part->Update();
    const vtkSmartPointer<vtkPolyData> polygons = part->GetOutput();
    if (polygons->GetNumberOfPolys() + polygons->GetNumberOfStrips() > 0)
    {
      look.GiveTo(polygons);
      finished.push_back(polygons);
    }
  }
  return finished;
}
