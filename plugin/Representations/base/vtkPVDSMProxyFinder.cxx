// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMProxyFinder.h"

#include "vtkCollection.h"
#include "vtkNew.h"
#include "vtkProcessModule.h"
#include "vtkSMProxy.h"
#include "vtkSMSession.h"

vtkSMProxy* vtkPVDSMProxyFinder::Find(vtkObjectBase* object)
{
  auto* module = vtkProcessModule::GetProcessModule();
  auto* session = module ? vtkSMSession::SafeDownCast(module->GetActiveSession()) : nullptr;
  vtkNew<vtkCollection> objects;
  if (session)
  {
    session->GetAllRemoteObjects(objects);
  }
  for (int index = 0; index < objects->GetNumberOfItems(); ++index)
  {
    auto* proxy = vtkSMProxy::SafeDownCast(objects->GetItemAsObject(index));
    // To ask for a proxy's object makes the object.
    if (proxy && proxy->GetObjectsCreated() && proxy->GetClientSideObject() == object)
    {
      return proxy;
    }
  }
  return nullptr;
}
