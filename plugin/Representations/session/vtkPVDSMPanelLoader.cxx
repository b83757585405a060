// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMPanelLoader.h"

#include "vtkNew.h"
#include "vtkPVPluginLoader.h"
#include "vtkPVPluginTracker.h"

#include <dlfcn.h>
#include <vtksys/SystemTools.hxx>

#include <cstring>
#include <string>

namespace
{

constexpr const char* PanelName = "DSMRayTracerPanel";

/// Whether this process is ParaView's application: pqApplicationCore::instance is there, and is an object.
bool HasUserInterface()
{
  using InstanceFunction = void* (*)();
  void* const symbol = dlsym(RTLD_DEFAULT, "_ZN17pqApplicationCore8instanceEv");
  return symbol && reinterpret_cast<InstanceFunction>(symbol)();
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
