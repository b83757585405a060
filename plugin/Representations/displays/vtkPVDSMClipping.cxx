// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMClipping.h"

#include "vtkAbstractMapper.h"
#include "vtkBoundingBox.h"
#include "vtkClipPolyData.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkPlane.h"
#include "vtkPlaneCollection.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkTransform.h"

#include <algorithm>

namespace
{

void AddPlane(vtkAbstractMapper* mapper, const double origin[3], const double normal[3])
{
  vtkNew<vtkPlane> plane;
  plane->SetOrigin(origin);
  plane->SetNormal(normal);
  mapper->AddClippingPlane(plane);
}

} // namespace

void vtkPVDSMClipping::ApplyTo(vtkAbstractMapper* mapper, vtkMatrix4x4* dataToWorld) const
{
  mapper->RemoveAllClippingPlanes();
  if (this->Clips)
  {
    AddPlane(mapper, this->Origin.data(), this->Normal.data());
  }
  vtkNew<vtkTransform> transform;
  transform->SetMatrix(dataToWorld);
  transform->Translate(this->BoxPosition.data());
  transform->RotateZ(this->BoxRotation[2]);
  transform->RotateX(this->BoxRotation[0]);
  transform->RotateY(this->BoxRotation[1]);
  transform->Scale(this->BoxScale.data());
  const std::array<double, 6> box =
    this->UsesBox ? this->Box : std::array<double, 6>{ 0.0, 1.0, 0.0, 1.0, 0.0, 1.0 };
  for (int side = 0; side < 6 && this->Crops; ++side)
  {
    const int axis = side / 2;
    const bool isLower = side % 2 == 0;
    const double* limits = box.data() + 2 * axis;
    double origin[3] = { 0.0, 0.0, 0.0 };
    double normal[3] = { 0.0, 0.0, 0.0 };
    origin[axis] = isLower ? std::min(limits[0], limits[1]) : std::max(limits[0], limits[1]);
    normal[axis] = isLower ? 1.0 : -1.0;
    transform->TransformPoint(origin, origin);
    transform->TransformNormal(normal, normal);
    AddPlane(mapper, origin, normal);
  }
}

const char* vtkPVDSMClipping::FindWhatHides(
  vtkAbstractMapper* mapper, const vtkBoundingBox& box) const
{
  vtkPlaneCollection* const planes = mapper->GetClippingPlanes();
  for (int number = 0; planes && number < planes->GetNumberOfItems(); ++number)
  {
    bool isVisible = false;
    for (int corner = 0; corner < 8; ++corner)
    {
      double point[3];
      box.GetCorner(corner, point);
      isVisible = isVisible || planes->GetItem(number)->EvaluateFunction(point) >= 0.0;
    }
    if (!isVisible)
    {
      return this->Clips && number == 0 ? "clipping plane" : "cropping box";
    }
  }
  return nullptr;
}

vtkSmartPointer<vtkPolyData> vtkPVDSMClipping::Clip(
  vtkPolyData* polygons, vtkMatrix4x4* dataToWorld) const
{
  vtkNew<vtkPolyDataMapper> mapper;
  this->ApplyTo(mapper, dataToWorld);
  vtkSmartPointer<vtkPolyData> shown = polygons;
  vtkPlaneCollection* planes = mapper->GetClippingPlanes();
  for (int number = 0; planes && number < planes->GetNumberOfItems(); ++number)
  {
    vtkNew<vtkTransform> transform;
    transform->SetMatrix(dataToWorld);
    planes->GetItem(number)->SetTransform(transform);
    vtkNew<vtkClipPolyData> clip;
    clip->SetInputData(shown);
    clip->SetClipFunction(planes->GetItem(number));
    clip->Update();
    shown = clip->GetOutput();
  }
  return shown;
}
