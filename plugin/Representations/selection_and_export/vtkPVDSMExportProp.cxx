// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMExportProp.h"

#include "vtkPVDSMExportInformation.h"
#include "vtkPVDSMExportSource.h"

#include "vtkActor.h"
#include "vtkCollection.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPVDataRepresentation.h"
#include "vtkPVSession.h"
#include "vtkPolyData.h"
#include "vtkProcessModule.h"
#include "vtkPropCollection.h"
#include "vtkRenderer.h"
#include "vtkSMProperty.h"
#include "vtkSMProxy.h"
#include "vtkSMSession.h"
#include "vtkSessionIterator.h"

#include <string>
#include <utility>

namespace
{

vtkSMProxy* FindProxy(vtkSMSession* session, vtkObject* representation)
{
  vtkNew<vtkCollection> objects;
  session->GetAllRemoteObjects(objects);
  for (int index = 0; index < objects->GetNumberOfItems(); ++index)
  {
    auto* proxy = vtkSMProxy::SafeDownCast(objects->GetItemAsObject(index));
    // A part of what the view shows, which has its properties.
    for (const char* name : { "DSMIsoArray", "DSMLineRadius", "DSMScattering", "DSMSliceX" })
    {
      vtkSMProperty* property = proxy ? proxy->GetProperty(name) : nullptr;
      if (property && property->GetParent()->GetClientSideObject() == representation)
      {
        return property->GetParent();
      }
    }
  }
  return nullptr;
}

/// Null where this process has no proxies: then another one exports.
vtkSMProxy* FindProxy(vtkObject* representation)
{
  vtkSMProxy* found = nullptr;
  vtkSmartPointer<vtkSessionIterator> iterator;
  iterator.TakeReference(vtkProcessModule::GetProcessModule()->NewSessionIterator());
  for (iterator->InitTraversal(); !iterator->IsDoneWithTraversal(); iterator->GoToNextItem())
  {
    if (auto* session = vtkSMSession::SafeDownCast(iterator->GetCurrentSession()))
    {
      found = found ? found : FindProxy(session, representation);
    }
  }
  return found;
}

/// A selection asks for actors too, since VTK 9.6, and on all ranks while they render together.
bool IsSelecting(vtkProp* prop)
{
  for (int index = 0; index < prop->GetNumberOfConsumers(); ++index)
  {
    auto* renderer = vtkRenderer::SafeDownCast(prop->GetConsumer(index));
    if (renderer && renderer->GetSelector())
    {
      return true;
    }
  }
  return false;
}

} // namespace

vtkStandardNewMacro(vtkPVDSMExportProp);

vtkPVDSMExportProp::vtkPVDSMExportProp()
{
  this->PickableOff();
  this->UseBoundsOff();
}

vtkPVDSMExportProp::~vtkPVDSMExportProp() = default;

void vtkPVDSMExportProp::SetRepresentation(vtkPVDataRepresentation* representation, ActorMaker make)
{
  this->Representation = representation;
  this->Make = std::move(make);
}

void vtkPVDSMExportProp::GetActors(vtkPropCollection* actors)
{
  if (!this->Representation || !this->Representation->GetVisibility() || IsSelecting(this))
  {
    return;
  }
  // An exporter asks several times.
  if (!this->Actors)
  {
    this->Actors = this->MakeActors();
  }
  for (const auto& actor : *this->Actors)
  {
    actors->AddItem(actor);
  }
}

std::vector<vtkSmartPointer<vtkActor>> vtkPVDSMExportProp::MakeActors()
{
  vtkSMProxy* proxy = FindProxy(this->Representation);
  if (!proxy)
  {
    return {};
  }
  auto* const source = dynamic_cast<vtkPVDSMExportSource*>(this->Representation);
  const std::string obstacle = source ? source->GetExportObstacle() : "";
  if (!obstacle.empty())
  {
    vtkErrorMacro(<< obstacle);
    return {};
  }
  vtkNew<vtkPVDSMExportInformation> information;
  const auto gather = [&]
  {
    proxy->GetSession()->GatherInformation(
      vtkPVSession::DATA_SERVER, information, proxy->GetGlobalID());
  };
  gather();
  const vtkTypeInt64 count = information->GetNumberOfPolygons();
  if (count > MostPolygons)
  {
    vtkErrorMacro("A DSM Ray Traced surface has "
      << count << " polygons and is not exported; the maximum is " << MostPolygons
      << ". Use Contour, Decimate and Save Data, or apply Extract Subset first.");
  }
  if (count == 0 || count > MostPolygons)
  {
    return {};
  }
  if (count > ManyPolygons)
  {
    vtkWarningMacro("A DSM Ray Traced surface is exported as " << count << " polygons.");
  }
  information->SetWithTriangles(true);
  gather();
  std::vector<vtkSmartPointer<vtkActor>> actors;
  for (const auto& polygons : information->GetTriangles())
  {
    actors.push_back(this->Make(polygons));
  }
  return actors;
}
