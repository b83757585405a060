// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMSharedOptions.h"

#include "vtkPVDSMProxyFinder.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkNew.h"
#include "vtkPVRenderView.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyIterator.h"
#include "vtkSMProxy.h"
#include "vtkSMSession.h"
#include "vtkSMSessionProxyManager.h"

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

/// The options of each view and session, for as long as it lives.
struct vtkPVDSMSharedOptions::Registry
{
  using Owners = std::map<vtkObject*, std::unique_ptr<vtkPVDSMSharedOptions>>;

  static Owners& Get()
  {
    static Owners owners;
    return owners;
  }

  static vtkPVDSMSharedOptions* Find(vtkObject* owner)
  {
    const auto found = Get().find(owner);
    return found == Get().end() ? nullptr : found->second.get();
  }

  static vtkPVDSMSharedOptions* Make(
    vtkObject* owner, vtkSMProxy* values, std::vector<std::string> exceptions)
  {
    vtkNew<vtkCallbackCommand> forget;
    forget->SetCallback([](vtkObject* gone, unsigned long, void*, void*) { Get().erase(gone); });
    owner->AddObserver(vtkCommand::DeleteEvent, forget);
    auto& made = Get()[owner];
    made.reset(new vtkPVDSMSharedOptions(values, std::move(exceptions)));
    return made.get();
  }
};

namespace
{

/// A proxy that has properties, and never an object.
vtkSmartPointer<vtkSMProxy> CreateValues(vtkSMProxy* like)
{
  vtkSmartPointer<vtkSMProxy> values;
  values.TakeReference(
    like->GetSessionProxyManager()->NewProxy(like->GetXMLGroup(), like->GetXMLName()));
  values->SetLocation(0);
  return values;
}

} // namespace

void vtkPVDSMSharedOptions::Join(vtkPVRenderView* view, vtkObjectBase* light, vtkObjectBase* memory)
{
  vtkSMProxy* lightProxy = vtkPVDSMProxyFinder::Find(light);
  vtkSMProxy* memoryProxy = lightProxy ? vtkPVDSMProxyFinder::Find(memory) : nullptr;
  if (!memoryProxy)
  {
    return;
  }
  vtkPVDSMSharedOptions* shared = Registry::Find(view);
  if (!shared)
  {
    // What part of the light a surface mirrors is a matter of that surface.
    shared = Registry::Make(view, CreateValues(lightProxy), { "DSMReflectivity" });
  }
  vtkSMSessionProxyManager* manager = lightProxy->GetSessionProxyManager();
  shared->Add(lightProxy, manager->GetInLoadXMLState());

  vtkSMSession* session = memoryProxy->GetSession();
  shared = Registry::Find(session);
  vtkSMProxy* page = manager->GetProxy("settings", "DSMRayTracerSettings");
  if (!shared)
  {
    shared = Registry::Make(
      session, page ? vtkSmartPointer<vtkSMProxy>(page) : CreateValues(memoryProxy), {});
  }
  if (page)
  {
    shared->Add(page, false);
  }
  shared->Add(memoryProxy, false);
}

void vtkPVDSMSharedOptions::Leave(
  vtkPVRenderView* view, vtkObjectBase* light, vtkObjectBase* memory)
{
  for (const auto& entry : Registry::Get())
  {
    entry.second->Remove(entry.first == view ? light : memory);
  }
}

vtkPVDSMSharedOptions::vtkPVDSMSharedOptions(
  vtkSMProxy* values, std::vector<std::string> exceptions)
  : Proxies{ values }
{
  vtkSmartPointer<vtkSMPropertyIterator> property;
  property.TakeReference(values->NewPropertyIterator());
  for (property->Begin(); !property->IsAtEnd(); property->Next())
  {
    if (!property->GetProperty()->GetInformationOnly() &&
      std::find(exceptions.begin(), exceptions.end(), property->GetKey()) == exceptions.end())
    {
      this->Names.emplace_back(property->GetKey());
    }
  }
  vtkNew<vtkCallbackCommand> observer;
  observer->SetClientData(this);
  observer->SetCallback(
    [](vtkObject* proxy, unsigned long, void* shared, void* name)
    {
      static_cast<vtkPVDSMSharedOptions*>(shared)->OnChange(
        vtkSMProxy::SafeDownCast(proxy), static_cast<const char*>(name));
    });
  this->Observer = observer;
  values->AddObserver(vtkCommand::PropertyModifiedEvent, this->Observer);
}

vtkPVDSMSharedOptions::~vtkPVDSMSharedOptions()
{
  for (const auto& proxy : this->Proxies)
  {
    proxy->RemoveObserver(this->Observer);
  }
}

void vtkPVDSMSharedOptions::Add(vtkSMProxy* proxy, bool speaks)
{
  if (std::find(this->Proxies.begin(), this->Proxies.end(), proxy) != this->Proxies.end())
  {
    return;
  }
  vtkSMProxy* values = this->Proxies.front();
  this->IsSpreading = true;
  for (const std::string& name : this->Names)
  {
    vtkSMProperty* theirs = proxy->GetProperty(name.c_str());
    if (speaks || !theirs->IsValueDefault())
    {
      this->Spread(proxy, name);
    }
    else
    {
      theirs->Copy(values->GetProperty(name.c_str()));
    }
  }
  this->Proxies.emplace_back(proxy);
  proxy->AddObserver(vtkCommand::PropertyModifiedEvent, this->Observer);
  this->UpdateObjects();
  this->IsSpreading = false;
}

void vtkPVDSMSharedOptions::Remove(vtkObjectBase* object)
{
  const auto isIts = [=](const vtkSmartPointer<vtkSMProxy>& proxy)
  { return proxy->GetObjectsCreated() && proxy->GetClientSideObject() == object; };
  const auto left = std::find_if(this->Proxies.begin() + 1, this->Proxies.end(), isIts);
  if (left != this->Proxies.end())
  {
    (*left)->RemoveObserver(this->Observer);
    this->Proxies.erase(left);
  }
}

void vtkPVDSMSharedOptions::OnChange(vtkSMProxy* proxy, const char* name)
{
  if (this->IsSpreading ||
    std::find(this->Names.begin(), this->Names.end(), name) == this->Names.end())
  {
    return;
  }
  this->IsSpreading = true;
  this->Spread(proxy, name);
  this->UpdateObjects();
  this->IsSpreading = false;
}

void vtkPVDSMSharedOptions::Spread(vtkSMProxy* from, const std::string& name)
{
  for (const auto& proxy : this->Proxies)
  {
    if (proxy != from)
    {
      proxy->GetProperty(name.c_str())->Copy(from->GetProperty(name.c_str()));
    }
  }
}

void vtkPVDSMSharedOptions::UpdateObjects()
{
  for (const auto& proxy : this->Proxies)
  {
    if (proxy->GetObjectsCreated())
    {
      proxy->UpdateVTKObjects();
    }
  }
}
