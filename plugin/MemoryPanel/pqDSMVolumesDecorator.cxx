// SPDX-License-Identifier: BSD-3-Clause
#include "pqDSMVolumesDecorator.h"

#include "pqCoreUtilities.h"
#include "pqPropertyWidget.h"
#include "vtkCommand.h"
#include "vtkPVDataInformation.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkSMSourceProxy.h"

pqDSMVolumesDecorator::pqDSMVolumesDecorator(vtkPVXMLElement* config, pqPropertyWidget* parent)
  : pqPropertyWidgetDecorator(config, parent)
{
  const vtkSMPropertyHelper input(parent->proxy(), "Input");
  pqCoreUtilities::connect(
    input.GetAsProxy(), vtkCommand::UpdateDataEvent, this, SIGNAL(visibilityChanged()));
}

pqDSMVolumesDecorator::~pqDSMVolumesDecorator() = default;

bool pqDSMVolumesDecorator::canShowWidget(bool) const
{
  const vtkSMPropertyHelper input(this->parentWidget()->proxy(), "Input");
  auto* const source = vtkSMSourceProxy::SafeDownCast(input.GetAsProxy());
  vtkPVDataInformation* const data =
    source ? source->GetDataInformation(input.GetOutputPort()) : nullptr;
  return data &&
    (data->HasDataSetType("vtkImageData") || data->HasDataSetType("vtkRectilinearGrid") ||
      data->HasDataSetType("vtkStructuredGrid") || data->HasDataSetType("vtkUnstructuredGrid") ||
      data->HasDataSetType("vtkHyperTreeGrid"));
}
