// SPDX-License-Identifier: BSD-3-Clause
#include "pqDSMIsovaluesDecorator.h"

#include "pqCoreUtilities.h"
#include "pqPropertyWidget.h"
#include "vtkCommand.h"
#include "vtkSMProperty.h"
#include "vtkSMProxy.h"
#include "vtkSMUncheckedPropertyHelper.h"

namespace
{
constexpr const char* List = "DSMIsoValues";
}

pqDSMIsovaluesDecorator::pqDSMIsovaluesDecorator(vtkPVXMLElement* config, pqPropertyWidget* parent)
  : pqPropertyWidgetDecorator(config, parent)
{
  if (vtkSMProperty* const list = parent->proxy()->GetProperty(List))
  {
    for (const char* signal : { SIGNAL(visibilityChanged()), SIGNAL(enableStateChanged()) })
    {
      pqCoreUtilities::connect(list, vtkCommand::UncheckedPropertyModifiedEvent, this, signal);
    }
  }
}

pqDSMIsovaluesDecorator::~pqDSMIsovaluesDecorator() = default;

bool pqDSMIsovaluesDecorator::canShowWidget(bool isAdvanced) const
{
  return isAdvanced || this->HasValues() == this->IsOfList();
}

bool pqDSMIsovaluesDecorator::enableWidget() const
{
  return this->IsOfList() || !this->HasValues();
}

bool pqDSMIsovaluesDecorator::IsOfList() const
{
  vtkSMProperty* const property = this->parentWidget()->property();
  return property && property == this->parentWidget()->proxy()->GetProperty(List);
}

bool pqDSMIsovaluesDecorator::HasValues() const
{
  vtkSMProperty* const list = this->parentWidget()->proxy()->GetProperty(List);
  return list && vtkSMUncheckedPropertyHelper(list).GetNumberOfElements() > 0;
}
