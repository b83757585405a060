// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMDSMShowDomain.h"

#include "vtkSMDSMImageRepresentationProxy.h"

#include "vtkObjectFactory.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"

vtkStandardNewMacro(vtkSMDSMShowDomain);

vtkSMDSMShowDomain::vtkSMDSMShowDomain() = default;
vtkSMDSMShowDomain::~vtkSMDSMShowDomain() = default;

int vtkSMDSMShowDomain::SetDefaultValues(vtkSMProperty* property, bool useUncheckedValues)
{
  auto* const display = vtkSMDSMImageRepresentationProxy::SafeDownCast(property->GetParent());
  if (!display)
  {
    return this->Superclass::SetDefaultValues(property, useUncheckedValues);
  }
  const int part = this->GetEntryValue(display->CanHaveIsosurfaces() ? 0 : 1);
  if (useUncheckedValues)
  {
    vtkSMPropertyHelper unchecked(property);
    unchecked.SetUseUnchecked(true);
    unchecked.Set(part);
    return 1;
  }
  vtkSMDSMImageRepresentationProxy::SetAutomatic(
    property, [&] { vtkSMPropertyHelper(property).Set(part); });
  return 1;
}
