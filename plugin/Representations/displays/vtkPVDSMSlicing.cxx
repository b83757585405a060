// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMSlicing.h"

#include "vtkDSMVolumeMapper.h"

#include "vtkNew.h"
#include "vtkPlane.h"

void vtkPVDSMSlicing::ApplyTo(vtkDSMVolumeMapper* mapper) const
{
  mapper->RemoveAllSlices();
  for (int axis = 0; axis < 3; ++axis)
  {
    const Axis& slices = this->Axes[axis];
    if (slices.IsShown)
    {
      mapper->AddSlice(axis, slices.Index);
    }
    for (const int index : slices.Further)
    {
      mapper->AddSlice(axis, index);
    }
  }
  mapper->RemoveAllSlicePlanes();
  if (this->HasPlane)
  {
    vtkNew<vtkPlane> plane;
    plane->SetOrigin(this->Origin.data());
    plane->SetNormal(this->Normal.data());
    mapper->AddSlicePlane(plane);
  }
}
