// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMDSMVolumeRepresentationProxy.h"

#include "vtkPVDSMHints.h"
#include "vtkPVDSMNoUndo.h"
#include "vtkSMDSMRepresentationProxy.h"
#include "vtkSMDSMSliceIndexDomain.h"

#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkObjectFactory.h"
#include "vtkPVXMLElement.h"
#include "vtkPVXMLParser.h"
#include "vtkSMArrayListDomain.h"
#include "vtkSMEnumerationDomain.h"
#include "vtkSMPVRepresentationProxy.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSmartPointer.h"

#include <string>
#include <vector>

vtkStandardNewMacro(vtkSMDSMVolumeRepresentationProxy);

vtkSMDSMVolumeRepresentationProxy::vtkSMDSMVolumeRepresentationProxy() = default;
vtkSMDSMVolumeRepresentationProxy::~vtkSMDSMVolumeRepresentationProxy() = default;

namespace
{

const std::string Decorator = "<PropertyWidgetDecorator type='GenericDecorator' ";
const std::string WhenShown = Decorator + "mode='visibility' property='Representation' ";
const std::string ForVolume = WhenShown + "value='Volume'/>";
const std::string BesideVolumes = WhenShown + "value='DSM Volume' inverse='1'/>";

/// ParaView's properties of surfaces, which have no effect on a volume.
constexpr const char* OfSurfaces[] = { "Opacity", "PointSize", "LineWidth", "RenderLinesAsTubes",
  "RenderPointsAsSpheres", "Interpolation", "SelectTCoordArray", "SelectNormalArray",
  "SelectTangentArray", "Texture", "RepeatTextures", "InterpolateTextures", "SeamlessU",
  "SeamlessV", "UseMipmapTextures", "ShowTexturesOnBackface", "FlipTextures", "TextureTransform",
  "EdgeColor", "EdgeOpacity", "BackfaceRepresentation", "BackfaceAmbientColor",
  "BackfaceDiffuseColor", "BackfaceOpacity", "Triangulate", "NonlinearSubdivisionLevel" };

vtkSmartPointer<vtkPVXMLElement> MakeHint(const std::string& text)
{
  return vtkPVXMLParser::ParseXML(text.c_str());
}

/// A hint that holds where one of these does.
vtkSmartPointer<vtkPVXMLElement> MakeEither(const std::vector<std::string>& hints)
{
  std::string text = "<PropertyWidgetDecorator type='CompositeDecorator'><Expression type='or'>";
  for (const std::string& hint : hints)
  {
    text += hint;
  }
  return MakeHint(text + "</Expression></PropertyWidgetDecorator>");
}

constexpr const char* SliceIndices[] = { "DSMSliceXIndex", "DSMSliceYIndex", "DSMSliceZIndex" };
constexpr const char* MoreSlices[] = { "DSMSliceXIndices", "DSMSliceYIndices", "DSMSliceZIndices" };

/// By ParaView's definition the panel shows the property for Volume alone. The hint is the same for all datasets.
void ShowForVolumes(vtkSMProperty* property)
{
  vtkPVXMLElement* const hints = property ? property->GetHints() : nullptr;
  for (unsigned int number = 0; hints && number < hints->GetNumberOfNestedElements(); ++number)
  {
    vtkPVXMLElement* const hint = hints->GetNestedElement(number);
    if (hint->GetAttributeOrEmpty("property") == std::string("Representation") &&
      hint->GetAttributeOrEmpty("value") == std::string("Volume"))
    {
      vtkPVDSMHints::Change(
        property, MakeEither({ ForVolume, WhenShown + "value='DSM Volume'/>" }), hint);
      return;
    }
  }
}

/// ParaView offers three of the modes that its Volume has, and not those of DSM Volume alone.
void OfferBlendModes(vtkSMProperty* property, vtkSMProperty* own)
{
  auto* const offered = property ? property->FindDomain<vtkSMEnumerationDomain>() : nullptr;
  auto* const all = own ? own->FindDomain<vtkSMEnumerationDomain>() : nullptr;
  for (unsigned int number = 0; offered && all && number < all->GetNumberOfEntries(); ++number)
  {
    if (!offered->HasEntryText(all->GetEntryText(number)))
    {
      offered->AddEntry(all->GetEntryText(number), all->GetEntryValue(number));
    }
  }
}

} // namespace

/// Volume's definition hides these properties, or lets only advanced users see them, and it shows Shade for Volume
/// alone. A property can name only one representation. Shade is in a group that is hidden for all others.
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
  OfferBlendModes(display->GetProperty("BlendMode"), this->GetProperty("BlendMode"));
  for (const char* name : OfSurfaces)
  {
    if (vtkSMProperty* const property = display->GetProperty(name))
    {
      vtkPVDSMHints::Change(property, MakeHint(BesideVolumes), nullptr);
    }
  }
  if (vtkSMProperty* const interpolation = display->GetProperty("InterpolationType"))
  {
    interpolation->SetPanelVisibility("default");
    vtkPVDSMHints::Change(interpolation,
      MakeHint(Decorator + "mode='enabled_state' property='BlendMode' value='0'/>"), nullptr);
    vtkPVDSMHints::Change(interpolation, MakeHint(WhenShown + "value='DSM Volume'/>"), nullptr);
  }
  if (vtkSMProperty* const direction = display->GetProperty("VolumeAnisotropy"))
  {
    const std::string isShaded = Decorator + "mode='enabled_state' property='Shade' value='1'/>";
    const std::string isVolume =
      Decorator + "mode='enabled_state' property='Representation' value='Volume'/>";
    vtkPVDSMHints::Change(direction, MakeEither({ isShaded, isVolume }), nullptr);
  }
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
  // ParaView updates the proxy with the properties that the panel shows before this one.
  vtkSMProxy* const isosurfaces = display->GetProperty("DSMCroppingBox")->GetParent();
  if (auto* const shown = vtkSMDSMRepresentationProxy::SafeDownCast(isosurfaces))
  {
    shown->FollowData();
  }
  if (this->IsOfSlices())
  {
    this->ChooseSlices(display);
  }
  if (!this->HasChosen)
  {
    this->ChooseArray(display);
  }
  if (!this->IsOfSlices())
  {
    this->ReportIgnored(display);
  }
}

void vtkSMDSMVolumeRepresentationProxy::ReportIgnored(vtkSMPVRepresentationProxy* display)
{
  std::string text;
  if (!display->GetUsingScalarColoring())
  {
    text =
      "No array colors the DSM Volume, so nothing is drawn. Choose an array under Coloring, or "
      "the representation DSM Ray Traced, which shows solid colors.";
  }
  else if (vtkSMPropertyHelper(display, "UseTransfer2D", true).GetAsInt() != 0)
  {
    vtkSMProxy* const function =
      vtkSMPropertyHelper(display, "TransferFunction2D", true).GetAsProxy();
    if (!function || vtkSMPropertyHelper(function, "Boxes", true).GetNumberOfElements() == 0)
    {
      text = "The two-dimensional transfer function has no box, so nothing is drawn. Add a box in "
             "the Color Map Editor, or turn off Use 2D Transfer Function.";
    }
  }
  if (!text.empty() && text != this->Reported)
  {
    vtkWarningMacro(<< text);
  }
  this->Reported = text;
}

bool vtkSMDSMVolumeRepresentationProxy::IsOfSlices()
{
  const std::string name = this->GetXMLName();
  return name == "DSMSliceRepresentation" || name == "DSMCellSliceRepresentation";
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
    vtkSMProperty* const property = display->GetProperty(name); // grids of cells have none
    if (property && property->FindDomain<vtkSMDSMSliceIndexDomain>()->IsAutomatic() &&
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
      if (property && count > 0)
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
      const bool isGhosts =
        std::string(arrays->GetString(index)) == vtkDataSetAttributes::GhostArrayName();
      if (arrays->GetFieldAssociation(index) == association && !isGhosts)
      {
        const vtkPVDSMNoUndo noUndo;
        display->SetScalarColoring(arrays->GetString(index), association);
        display->RescaleTransferFunctionToDataRange(true);
        return;
      }
    }
  }
}
