// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMSceneMember.h"

#include "vtkDSMTranslation.h"

#include "vtkAlgorithm.h"
#include "vtkCommand.h"
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

/// Returns the members of all scenes, in the order of their creation. Outlives scenes that are
/// destroyed at program exit.
std::vector<vtkDSMSceneMember*>& GetAll()
{
  static auto* const all = new std::vector<vtkDSMSceneMember*>;
  return *all;
}

} // namespace

vtkDSMSceneMember::vtkDSMSceneMember()
{
  GetAll().push_back(this);
}

vtkDSMSceneMember::~vtkDSMSceneMember()
{
  std::vector<vtkDSMSceneMember*>& all = GetAll();
  all.erase(std::find(all.begin(), all.end(), this));
}

std::vector<const vtkDSMSceneMember*> vtkDSMSceneMember::FreeOutdated(dsm::Messenger& messenger)
{
  std::vector<vtkDSMSceneMember*> sharers;
  std::vector<std::byte> mine;
  messenger.RunTogether("Finding old data",
    [&]
    {
      for (vtkDSMSceneMember* member : GetAll())
      {
        if (member != this && this->SharesBlocks(*member))
        {
          sharers.push_back(member);
          mine.push_back(std::byte(member->IsOutdated() ? 1 : 0));
        }
      }
    });
  std::vector<const vtkDSMSceneMember*> freed;
  if (sharers.empty())
  {
    return freed;
  }
  const auto all = messenger.AllGather(mine);
  for (std::size_t index = 0; index < sharers.size(); ++index)
  {
    if (std::all_of(all.begin(), all.end(),
          [=](const auto& flags) { return index < flags.size() && flags[index] != std::byte(0); }))
    {
      sharers[index]->GiveUpBlocks();
      freed.push_back(sharers[index]);
    }
  }
  return freed;
}

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

void vtkDSMSceneMember::ReportMessages(bool tells)
{
  std::vector<std::string> known = this->Reported;
  vtkAlgorithm* const algorithm = this->GetAlgorithm();
  const auto isNew = [&](const std::string& message, unsigned long event)
  {
    const bool isKnown = std::find(known.begin(), known.end(), message) != known.end();
    known.push_back(message); // AddTo may have said it more than once
    return !isKnown && (tells || algorithm->HasObserver(event));
  };
  for (const std::string& message : this->Messages)
  {
    if (isNew(message, vtkCommand::ErrorEvent))
    {
      vtkErrorWithObjectMacro(algorithm, << message);
    }
  }
  for (const std::string& warning : this->Warnings)
  {
    if (isNew(warning, vtkCommand::WarningEvent))
    {
      vtkWarningWithObjectMacro(algorithm, << warning);
    }
  }
  this->Reported = this->Messages;
  this->Reported.insert(this->Reported.end(), this->Warnings.begin(), this->Warnings.end());
}
