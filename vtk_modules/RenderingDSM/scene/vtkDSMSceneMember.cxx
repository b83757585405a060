// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMSceneMember.h"

#include "vtkDSMTranslation.h"

#include "vtkAlgorithm.h"
#include "vtkObject.h"
#include "vtkScalarsToColors.h"

#include <algorithm>

namespace
{

std::vector<vtkDSMSceneMember::Maker>& GetKinds()
{
  static std::vector<vtkDSMSceneMember::Maker> kinds;
  return kinds;
}

} // namespace

void vtkDSMSceneMember::AddKind(Maker make)
{
  std::vector<Maker>& kinds = GetKinds();
  if (std::find(kinds.begin(), kinds.end(), make) == kinds.end())
  {
    kinds.push_back(make);
  }
}

std::unique_ptr<vtkDSMSceneMember> vtkDSMSceneMember::Create(vtkAlgorithm* mapper)
{
  std::unique_ptr<vtkDSMSceneMember> member;
  for (const Maker make : GetKinds())
  {
    member = member ? std::move(member) : make(mapper);
  }
  return member;
}

std::shared_ptr<const rt::ColorMap> vtkDSMSceneMember::SampleColors(vtkScalarsToColors* table)
{
  if (table != this->ColorsSource || table->GetMTime() != this->ColorsTime)
  {
    this->Colors = std::make_shared<rt::ColorMap>(vtkDSMTranslation::ToColorMap(table));
    this->ColorsSource = table;
    this->ColorsTime = table->GetMTime();
  }
  return this->Colors;
}

void vtkDSMSceneMember::ReportMessages()
{
  for (const std::string& message : this->Messages)
  {
    if (std::find(this->Reported.begin(), this->Reported.end(), message) == this->Reported.end())
    {
      vtkErrorWithObjectMacro(this->GetAlgorithm(), << message);
    }
  }
  this->Reported = this->Messages;
}
