// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMDSMVolumeRepresentationProxy.h"

#include "vtkPVDSMNoUndo.h"

#include "vtkDataObject.h"
#include "vtkObjectFactory.h"
#include "vtkSMArrayListDomain.h"
#include "vtkSMPVRepresentationProxy.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"

#include <string>

vtkStandardNewMacro(vtkSMDSMVolumeRepresentationProxy);

vtkSMDSMVolumeRepresentationProxy::vtkSMDSMVolumeRepresentationProxy() = default;
vtkSMDSMVolumeRepresentationProxy::~vtkSMDSMVolumeRepresentationProxy() = default;

void vtkSMDSMVolumeRepresentationProxy::ViewUpdated(vtkSMProxy* view)
{
  this->Superclass::ViewUpdated(view);
  auto* const display = vtkSMPVRepresentationProxy::SafeDownCast(this->GetParentProxy());
  if (this->HasChosen || !display ||
    vtkSMPropertyHelper(display, "Representation").GetAsString() != std::string("DSM Volume"))
  {
    return;
  }
  vtkSMProperty* const property = display->GetProperty("ColorArrayName");
  auto* const arrays = property->FindDomain<vtkSMArrayListDomain>();
  const unsigned int count = arrays ? arrays->GetNumberOfStrings() : 0;
  this->HasChosen = count > 0;
  if (display->GetUsingScalarColoring())
  {
    return;
  }
  for (unsigned int index = 0; index < count; ++index)
  {
    if (arrays->GetFieldAssociation(index) == vtkDataObject::POINT)
    {
      const vtkPVDSMNoUndo noUndo;
      display->SetScalarColoring(arrays->GetString(index), vtkDataObject::POINT);
      display->RescaleTransferFunctionToDataRange(true);
      return;
    }
  }
}
