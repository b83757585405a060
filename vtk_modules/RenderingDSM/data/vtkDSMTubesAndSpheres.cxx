// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMTubesAndSpheres.h"

#include "DSMCore/base/Error.h"

#include "vtkDataArray.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

bool vtkDSMTubesAndSpheres::HasTubes(vtkPolyData* data) const
{
  return this->LineRadius > 0.0 && data->GetNumberOfLines() > 0;
}

bool vtkDSMTubesAndSpheres::HasSpheres(vtkPolyData* data) const
{
  return this->PointRadius > 0.0 && data->GetNumberOfVerts() > 0;
}

vtkDataArray* vtkDSMTubesAndSpheres::FindFactors(vtkPolyData* data) const
{
  if (this->RadiusArray.empty())
  {
    return nullptr;
  }
  vtkDataArray* factors = data->GetPointData()->GetArray(this->RadiusArray.c_str());
  if (!factors || factors->GetNumberOfComponents() != 1 ||
    factors->GetNumberOfTuples() != data->GetNumberOfPoints())
  {
    throw dsm::Error("The radius array '" + this->RadiusArray +
      "' must be a point array with one number per point. Choose another array or none.");
  }
  return factors;
}
