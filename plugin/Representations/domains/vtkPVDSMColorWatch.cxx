// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMColorWatch.h"

#include "vtkPVDSMNoUndo.h"

#include "vtkCallbackCommand.h"
#include "vtkDataSetAttributes.h"
#include "vtkNew.h"
#include "vtkPVArrayInformation.h"
#include "vtkPVDataInformation.h"
#include "vtkPVDataSetAttributesInformation.h"
#include "vtkSMPVRepresentationProxy.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSourceProxy.h"

#include <algorithm>
#include <string>

namespace
{

/// Array that colors a dataset, and arrays of the dataset.
class Coloring
{
public:
  explicit Coloring(vtkSMProxy* representation)
  {
    const vtkSMPropertyHelper input(representation, "Input");
    const vtkSMPropertyHelper color(representation, "ColorArrayName");
    this->Producer = vtkSMSourceProxy::SafeDownCast(input.GetAsProxy());
    this->Data =
      this->Producer ? this->Producer->GetDataInformation(input.GetOutputPort()) : nullptr;
    this->Association = color.GetInputArrayAssociation();
    const char* const name = color.GetInputArrayNameToProcess();
    this->Name = name ? name : "";
  }

  /// Null where there are none.
  const char* GetScalars() const
  {
    vtkPVDataSetAttributesInformation* const arrays =
      this->Data ? this->Data->GetAttributeInformation(this->Association) : nullptr;
    vtkPVArrayInformation* const scalars =
      arrays ? arrays->GetAttributeInformation(vtkDataSetAttributes::SCALARS) : nullptr;
    return scalars ? scalars->GetName() : nullptr;
  }
  bool IsByScalars() const
  {
    const char* const scalars = this->GetScalars();
    return scalars && this->Name == scalars;
  }
  bool IsMissing() const
  {
    return this->Data && !this->Name.empty() &&
      !this->Data->GetArrayInformation(this->Name.c_str(), this->Association);
  }

  vtkSMSourceProxy* Producer;
  int Association;

private:
  vtkPVDataInformation* Data;
  std::string Name;
};

} // namespace

vtkPVDSMColorWatch::vtkPVDSMColorWatch()
{
  vtkNew<vtkCallbackCommand> observer;
  observer->SetClientData(this);
  observer->SetCallback(
    [](vtkObject* producer, unsigned long, void* watch, void*)
    {
      if (watch)
      {
        static_cast<vtkPVDSMColorWatch*>(watch)->OnData(vtkSMProxy::SafeDownCast(producer));
      }
    });
  this->Observer = observer;
}

vtkPVDSMColorWatch::~vtkPVDSMColorWatch()
{
  // The producers may outlive this.
  static_cast<vtkCallbackCommand*>(this->Observer.Get())->SetClientData(nullptr);
}

void vtkPVDSMColorWatch::Note(vtkSMProxy* representation)
{
  this->Automatic.erase(std::remove_if(this->Automatic.begin(), this->Automatic.end(),
                          [=](const auto& one) { return !one || one == representation; }),
    this->Automatic.end());
  const Coloring coloring(representation);
  if (!coloring.IsByScalars())
  {
    return;
  }
  this->Automatic.emplace_back(representation);
  if (!coloring.Producer->HasObserver(vtkCommand::UpdateDataEvent, this->Observer))
  {
    coloring.Producer->AddObserver(vtkCommand::UpdateDataEvent, this->Observer);
  }
}

void vtkPVDSMColorWatch::OnData(vtkSMProxy* producer)
{
  for (const auto& one : this->Automatic)
  {
    auto* const representation = vtkSMPVRepresentationProxy::SafeDownCast(one);
    if (!representation)
    {
      continue;
    }
    const Coloring coloring(representation);
    if (coloring.Producer == producer && coloring.IsMissing())
    {
      const vtkPVDSMNoUndo noUndo;
      representation->SetScalarColoring(coloring.GetScalars(), coloring.Association);
      representation->RescaleTransferFunctionToDataRange(false, false);
    }
  }
}
