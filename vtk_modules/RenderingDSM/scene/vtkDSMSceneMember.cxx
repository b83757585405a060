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
  std::vector<std::string> known = this->Reported;
  for (const std::string& message : this->Messages)
  {
    if (std::find(known.begin(), known.end(), message) == known.end())
    {
      vtkErrorWithObjectMacro(this->GetAlgorithm(), << message);
      known.push_back(message); // AddTo may have said it more than once
    }
  }
  this->Reported = this->Messages;
}
