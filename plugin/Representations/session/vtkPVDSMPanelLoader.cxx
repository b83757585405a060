// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMPanelLoader.h"

#include "vtkNew.h"
#include "vtkPVPluginLoader.h"
#include "vtkPVPluginTracker.h"
#include "vtkSMProxyManager.h"

#include <dlfcn.h>
#include <vtksys/SystemTools.hxx>

#include <cstring>
#include <string>

namespace
{

constexpr const char* PanelName = "DSMRayTracerPanel";

/// Only ParaView's application has changes to undo.
bool HasUserInterface()
{
  return vtkSMProxyManager::GetProxyManager()->GetUndoStackBuilder() != nullptr;
}

bool IsLoaded()
{
  vtkPVPluginTracker* const tracker = vtkPVPluginTracker::GetInstance();
  for (unsigned int number = 0; number < tracker->GetNumberOfPlugins(); ++number)
  {
    if (std::strcmp(tracker->GetPluginName(number), PanelName) == 0)
    {
      return tracker->GetPluginLoaded(number);
    }
  }
  return false;
}

/// Beside this library, or in a folder of its own, as ParaView installs plugins. Empty if it is in neither.
std::string FindPanel()
{
  Dl_info here;
  if (dladdr(reinterpret_cast<void*>(&vtkPVDSMPanelLoader::Load), &here) == 0 || !here.dli_fname)
  {
    return std::string();
  }
  const std::string folder =
    vtksys::SystemTools::GetParentDirectory(vtksys::SystemTools::CollapseFullPath(here.dli_fname));
  const std::string name = std::string(PanelName) + ".so";
  for (const std::string& file : { folder + "/" + name, folder + "/../" + PanelName + "/" + name })
  {
    if (vtksys::SystemTools::FileExists(file, true))
    {
      return file;
    }
  }
  return std::string();
}

} // namespace

void vtkPVDSMPanelLoader::Load()
{
  if (!HasUserInterface() || IsLoaded())
  {
    return;
  }
  const std::string panel = FindPanel();
  if (!panel.empty())
  {
    vtkNew<vtkPVPluginLoader> loader;
    loader->LoadPluginSilently(panel.c_str());
  }
}
