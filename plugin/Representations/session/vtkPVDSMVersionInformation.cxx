// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMVersionInformation.h"

#include "vtkPVDSMDefinitions.h"

#include "vtkClientServerStream.h"
#include "vtkObjectFactory.h"
#include "vtkPVPlugin.h"
#include "vtkPVPluginTracker.h"

vtkStandardNewMacro(vtkPVDSMVersionInformation);

vtkPVDSMVersionInformation::vtkPVDSMVersionInformation()
{
  this->RootOnly = 0; // each rank learns that its client has the plugin
}

vtkPVDSMVersionInformation::~vtkPVDSMVersionInformation() = default;

void vtkPVDSMVersionInformation::CopyFromObject(vtkObject*)
{
  vtkPVDSMDefinitions::Allow();
  this->Version.clear();
  vtkPVPluginTracker* plugins = vtkPVPluginTracker::GetInstance();
  for (unsigned int index = 0; index < plugins->GetNumberOfPlugins(); ++index)
  {
    vtkPVPlugin* plugin = plugins->GetPlugin(index);
    if (plugin && std::string(plugin->GetPluginName()) == "DSMRayTracer")
    {
      this->Version = plugin->GetPluginVersionString();
    }
  }
}

void vtkPVDSMVersionInformation::AddInformation(vtkPVInformation* other)
{
  if (auto* information = vtkPVDSMVersionInformation::SafeDownCast(other))
  {
    this->Version = information->Version;
  }
}

void vtkPVDSMVersionInformation::CopyToStream(vtkClientServerStream* stream)
{
  stream->Reset();
  *stream << vtkClientServerStream::Reply << this->Version.c_str() << vtkClientServerStream::End;
}

void vtkPVDSMVersionInformation::CopyFromStream(const vtkClientServerStream* stream)
{
  const char* version = nullptr;
  this->Version = stream->GetArgument(0, 0, &version) && version ? version : "";
}

void vtkPVDSMVersionInformation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Version: " << this->Version << "\n";
}
