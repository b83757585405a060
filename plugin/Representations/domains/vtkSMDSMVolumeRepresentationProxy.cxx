// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMDSMVolumeRepresentationProxy.h"

#include "vtkPVDSMNoUndo.h"
#include "vtkSMDSMSliceIndexDomain.h"

#include "vtkDataObject.h"
#include "vtkObjectFactory.h"
#include "vtkPVXMLElement.h"
#include "vtkPVXMLParser.h"
#include "vtkSMArrayListDomain.h"
#include "vtkSMPVRepresentationProxy.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"

#include <string>

vtkStandardNewMacro(vtkSMDSMVolumeRepresentationProxy);

vtkSMDSMVolumeRepresentationProxy::vtkSMDSMVolumeRepresentationProxy() = default;
vtkSMDSMVolumeRepresentationProxy::~vtkSMDSMVolumeRepresentationProxy() = default;

namespace
{

constexpr const char* SliceIndices[] = { "DSMSliceXIndex", "DSMSliceYIndex", "DSMSliceZIndex" };
constexpr const char* MoreSlices[] = { "DSMSliceXIndices", "DSMSliceYIndices", "DSMSliceZIndices" };

/// ParaView's definition lets the panel show the property for Volume alone, by a hint that is the same for all datasets.
void ShowForVolumes(vtkSMProperty* property)
{
  vtkPVXMLElement* const hints = property ? property->GetHints() : nullptr;
  for (unsigned int number = 0; hints && number < hints->GetNumberOfNestedElements(); ++number)
  {
    vtkPVXMLElement* const hint = hints->GetNestedElement(number);
    if (hint->GetAttributeOrEmpty("property") == std::string("Representation") &&
      hint->GetAttributeOrEmpty("value") == std::string("Volume"))
    {
      const std::string one = "<PropertyWidgetDecorator type='GenericDecorator' mode='visibility' "
                              "property='Representation' value=";
      const auto both = vtkPVXMLParser::ParseXML(
        ("<PropertyWidgetDecorator type='CompositeDecorator'><Expression type='or'>" + one +
          "'Volume'/>" + one + "'DSM Volume'/></Expression></PropertyWidgetDecorator>")
          .c_str());
      hints->RemoveNestedElement(hint);
      hints->AddNestedElement(both);
      return;
    }
  }
}

} // namespace

/// Volume's definition lets the panel show these to advanced users only, or Shade for Volume, too, and a property can name only
/// one representation. Shade is in a group that is hidden for all others.
void vtkSMDSMVolumeRepresentationProxy::CreateVTKObjects()
{
  this->Superclass::CreateVTKObjects();
  vtkSMProxy* const display = this->GetParentProxy();
  if (!display)
  {
    return;
  }
  if (vtkSMProperty* const shade = display->GetProperty("Shade"))
  {
    shade->SetPanelVisibility("default");
  }
  ShowForVolumes(display->GetProperty("MultiComponentsMapping"));
  for (const char* name : { "ScalarOpacityUnitDistance", "VolumeAnisotropy" })
  {
    if (vtkSMProperty* const property = display->GetProperty(name))
    {
      property->SetPanelVisibilityDefaultForRepresentation("DSM Volume");
    }
  }
}

void vtkSMDSMVolumeRepresentationProxy::ViewUpdated(vtkSMProxy* view)
{
  this->Superclass::ViewUpdated(view);
  auto* const display = vtkSMPVRepresentationProxy::SafeDownCast(this->GetParentProxy());
  if (!this->IsShown(display))
  {
    return;
  }
  if (this->IsOfSlices())
  {
    this->ChooseSlices(display);
  }
  if (!this->HasChosen)
  {
    this->ChooseArray(display);
  }
}

bool vtkSMDSMVolumeRepresentationProxy::IsOfSlices()
{
  return this->GetXMLName() == std::string("DSMSliceRepresentation");
}

bool vtkSMDSMVolumeRepresentationProxy::IsShown(vtkSMProxy* display)
{
  const std::string type = this->IsOfSlices() ? "DSM Slices" : "DSM Volume";
  return display && vtkSMPropertyHelper(display, "Representation").GetAsString() == type;
}

void vtkSMDSMVolumeRepresentationProxy::ChooseSlices(vtkSMProxy* display)
{
  const vtkPVDSMNoUndo noUndo;
  for (const char* name : SliceIndices)
  {
    vtkSMProperty* const property = display->GetProperty(name);
    if (property->FindDomain<vtkSMDSMSliceIndexDomain>()->IsAutomatic() &&
      !property->ResetToDomainDefaults())
    {
      vtkSMPropertyHelper(property).Set(-1); // the middle, which the frame finds out
    }
  }
  display->UpdateVTKObjects();
}

void vtkSMDSMVolumeRepresentationProxy::TakeSlices()
{
  vtkSMProxy* const display = this->GetParentProxy();
  vtkSMProperty* const points = this->GetProperty("DSMSlicePoints");
  if (!this->IsOfSlices() || !this->IsShown(display))
  {
    return;
  }
  points->GetParent()->UpdatePropertyInformation(points);
  for (unsigned int axis = 0; axis < 3; ++axis)
  {
    const int count = vtkSMPropertyHelper(points).GetAsInt(axis);
    for (const char* name : { SliceIndices[axis], MoreSlices[axis] })
    {
      vtkSMProperty* const property = display->GetProperty(name);
      if (count > 0)
      {
        property->FindDomain<vtkSMDSMSliceIndexDomain>()->SetNumberOfSamples(count);
      }
    }
  }
  this->ChooseSlices(display);
}

/// The first one of points, or else of cells.
void vtkSMDSMVolumeRepresentationProxy::ChooseArray(vtkSMPVRepresentationProxy* display)
{
  vtkSMProperty* const property = display->GetProperty("ColorArrayName");
  auto* const arrays = property->FindDomain<vtkSMArrayListDomain>();
  const unsigned int count = arrays ? arrays->GetNumberOfStrings() : 0;
  this->HasChosen = count > 0;
  if (display->GetUsingScalarColoring())
  {
    return;
  }
  for (const int association : { vtkDataObject::POINT, vtkDataObject::CELL })
  {
    for (unsigned int index = 0; index < count; ++index)
    {
      if (arrays->GetFieldAssociation(index) == association)
      {
        const vtkPVDSMNoUndo noUndo;
        display->SetScalarColoring(arrays->GetString(index), association);
        display->RescaleTransferFunctionToDataRange(true);
        return;
      }
    }
  }
}
