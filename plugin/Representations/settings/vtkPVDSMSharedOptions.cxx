// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMSharedOptions.h"

#include "vtkPVDSMNoUndo.h"
#include "vtkPVDSMProxyFinder.h"
#include "vtkPVDSMWrittenProperties.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkNew.h"
#include "vtkPVRenderView.h"
#include "vtkPVXMLElement.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMPropertyIterator.h"
#include "vtkSMProxy.h"
#include "vtkSMSession.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSettingsProxy.h"
#include "vtkSMTrace.h"
#include "vtkVariant.h"

#include <algorithm>
#include <map>
#include <memory>

/// The options of each view and session, by their part, for as long as it lives.
struct vtkPVDSMSharedOptions::Registry
{
  std::map<vtkObject*, std::map<Part, std::unique_ptr<vtkPVDSMSharedOptions>>> Owners;

  /// When a process ends by exit, as a script may, its sessions go after what is static here.
  static bool& IsOver()
  {
    static bool over = false;
    return over;
  }
  ~Registry() { IsOver() = true; }

  static Registry& Get()
  {
    static Registry registry;
    return registry;
  }

  /// An object that is destroyed with the options may be an owner, too.
  static void Forget(vtkObject* owner)
  {
    if (!IsOver())
    {
      const auto entry = Get().Owners.extract(owner);
    }
  }

  /// Returns the options of `values`; without these, of a copy of `like`.
  static vtkPVDSMSharedOptions* Get(
    vtkObject* owner, Part part, vtkSMProxy* like, vtkSMProxy* values = nullptr);
};

namespace
{

vtkSMProxy* FindPage(vtkSMProxy* proxy)
{
  return proxy->GetSessionProxyManager()->GetProxy("settings", "DSMRayTracerSettings");
}

constexpr const char* LookName = "DSMLook";

/// A proxy that begins with the other's values, and never has an object.
vtkSmartPointer<vtkSMProxy> CreateValues(vtkSMProxy* like)
{
  vtkSmartPointer<vtkSMProxy> values;
  values.TakeReference(
    like->GetSessionProxyManager()->NewProxy(like->GetXMLGroup(), like->GetXMLName()));
  values->SetLocation(0);
  values->Copy(like);
  return values;
}

/// Returns whether a display, or the settings page, has a value of its own: not its default, and of a display not the
/// page's.
bool IsGiven(vtkSMProxy* proxy, const char* name)
{
  vtkSMProxy* page = FindPage(proxy);
  return !proxy->GetProperty(name)->IsValueDefault() &&
    !(page && page != proxy && page->GetProperty(name) &&
      vtkSMPropertyHelper(page, name).GetAsVariant(0).ToString() ==
        vtkSMPropertyHelper(proxy, name).GetAsVariant(0).ToString());
}

/// The look with which a display begins is its own from then on: what is linked to settings, ParaView writes into no
/// Python state and no trace, which would bring back another picture.
void KeepLook(vtkSMProxy* light)
{
  auto* page = vtkSMSettingsProxy::SafeDownCast(FindPage(light));
  if (page && page->GetSourcePropertyName(light, LookName))
  {
    page->RemoveLink(LookName, light, LookName);
    SM_SCOPED_TRACE(PropertiesModified).arg("proxy", light->GetTrueParentProxy());
    light->GetProperty(LookName)->Modified();
  }
}

} // namespace

vtkPVDSMSharedOptions* vtkPVDSMSharedOptions::Registry::Get(
  vtkObject* owner, Part part, vtkSMProxy* like, vtkSMProxy* values)
{
  auto& owners = Registry::Get().Owners;
  if (owners.count(owner) == 0)
  {
    vtkNew<vtkCallbackCommand> forget;
    forget->SetCallback([](vtkObject* gone, unsigned long, void*, void*) { Forget(gone); });
    owner->AddObserver(vtkCommand::DeleteEvent, forget);
  }
  auto& options = owners[owner][part];
  if (!options)
  {
    const auto kept = values ? vtkSmartPointer<vtkSMProxy>(values) : CreateValues(like);
    options.reset(new vtkPVDSMSharedOptions(kept, like, part));
  }
  return options.get();
}

void vtkPVDSMSharedOptions::Join(
  vtkPVRenderView* view, vtkObjectBase* light, vtkObjectBase* memory, bool isTraced)
{
  vtkSMProxy* lightProxy = vtkPVDSMProxyFinder::Find(light);
  vtkSMProxy* memoryProxy = lightProxy ? vtkPVDSMProxyFinder::Find(memory) : nullptr;
  if (!memoryProxy)
  {
    return;
  }
  vtkPVDSMWrittenProperties::Choose(lightProxy->GetTrueParentProxy());
  const Word word = !lightProxy->GetSessionProxyManager()->GetInLoadXMLState() ? Word::Given
    : isTraced                                                                 ? Word::All
                                                                               : Word::None;
  Registry::Get(view, Part::AllButLook, lightProxy)->Add(lightProxy, word);
  if (isTraced)
  {
    Registry::Get(view, Part::Look, lightProxy)->Add(lightProxy, word);
    KeepLook(lightProxy);
  }

  vtkSMProxy* page = FindPage(memoryProxy);
  vtkPVDSMSharedOptions* const ofRanks =
    Registry::Get(memoryProxy->GetSession(), Part::All, memoryProxy, page);
  if (page)
  {
    ofRanks->Add(page, Word::Given);
  }
  ofRanks->Add(memoryProxy, Word::Given);
}

void vtkPVDSMSharedOptions::Leave(
  vtkPVRenderView* view, vtkObjectBase* light, vtkObjectBase* memory)
{
  for (const auto& owner : Registry::Get().Owners)
  {
    for (const auto& part : owner.second)
    {
      part.second->Remove(owner.first == view ? light : memory);
    }
  }
}

vtkPVDSMSharedOptions::vtkPVDSMSharedOptions(vtkSMProxy* values, vtkSMProxy* like, Part part)
  : Proxies{ values }
{
  vtkSmartPointer<vtkSMPropertyIterator> property;
  property.TakeReference(like->NewPropertyIterator());
  for (property->Begin(); !property->IsAtEnd(); property->Next())
  {
    vtkPVXMLElement* hints = property->GetProperty()->GetHints();
    const bool isShared = !hints || !hints->FindNestedElementByName("DSMOfDataset");
    const bool isLook = std::string(property->GetKey()) == LookName;
    if (isShared && (part == Part::All || isLook == (part == Part::Look)))
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

void vtkPVDSMSharedOptions::Add(vtkSMProxy* proxy, Word word)
{
  const bool isNew =
    std::find(this->Proxies.begin(), this->Proxies.end(), proxy) == this->Proxies.end();
  if (!isNew && word != Word::All)
  {
    return;
  }
  const vtkPVDSMNoUndo noUndo;
  vtkSMProxy* values = this->Proxies.front();
  this->IsSpreading = true;
  for (const std::string& name : this->Names)
  {
    vtkSMProperty* theirs = proxy->GetProperty(name.c_str());
    if (word == Word::All || (word == Word::Given && IsGiven(proxy, name.c_str())))
    {
      this->Spread(proxy, name);
    }
    else
    {
      theirs->Copy(values->GetProperty(name.c_str()));
    }
  }
  if (isNew)
  {
    this->Proxies.emplace_back(proxy);
    proxy->AddObserver(vtkCommand::PropertyModifiedEvent, this->Observer);
  }
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
