// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMIsovalueWatch.h"

#include "vtkPVDSMImageRepresentation.h"

#include "vtkCallbackCommand.h"
#include "vtkClientServerStream.h"
#include "vtkNew.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkSMSession.h"
#include "vtkSMUncheckedPropertyHelper.h"

#include <cmath>
#include <utility>

namespace
{
constexpr const char* Single = "DSMIsoValue";

/// Whether a box is as large as data that are not there: upside down, or, since ParaView 6, of no extent.
bool IsOfNothing(const vtkSMPropertyHelper& bounds)
{
  const auto isFlat = [&](unsigned int axis)
  { return !(bounds.GetAsDouble(2 * axis) < bounds.GetAsDouble(2 * axis + 1)); };
  return isFlat(0) && isFlat(1) && isFlat(2);
}

/// A display that was made before its data came had nothing to choose its array or its box from, and has none.
void ChooseWhatIsMissing(vtkSMProxy* representation)
{
  vtkSMProperty* const array = representation->GetProperty("DSMIsoArray");
  const char* const name = vtkSMPropertyHelper(array).GetInputArrayNameToProcess();
  bool any = (!name || !*name) && array->ResetToDomainDefaults();
  vtkSMProperty* const box = representation->GetProperty("DSMCroppingBox");
  any = (IsOfNothing(vtkSMPropertyHelper(box)) && box->ResetToDomainDefaults()) || any;
  if (any)
  {
    representation->UpdateVTKObjects();
  }
}
} // namespace

vtkPVDSMIsovalueWatch::vtkPVDSMIsovalueWatch(std::function<void()> changed)
  : Changed(std::move(changed))
{
  vtkNew<vtkCallbackCommand> observer;
  observer->SetClientData(this);
  observer->SetCallback(
    [](vtkObject* property, unsigned long, void* watch, void*)
    {
      if (watch)
      {
        static_cast<vtkPVDSMIsovalueWatch*>(watch)->OnChange(vtkSMProperty::SafeDownCast(property));
      }
    });
  this->Observer = observer;
}

vtkPVDSMIsovalueWatch::~vtkPVDSMIsovalueWatch()
{
  // The properties may outlive this.
  static_cast<vtkCallbackCommand*>(this->Observer.Get())->SetClientData(nullptr);
}

void vtkPVDSMIsovalueWatch::TakeSuggestion(vtkSMProxy* representation)
{
  vtkSMProperty* single = representation->GetProperty(Single);
  if (!single)
  {
    return;
  }
  ChooseWhatIsMissing(representation);
  if (vtkSMPropertyHelper(single).GetAsDouble() != vtkPVDSMImageRepresentation::UnsetIsoValue ||
    vtkSMPropertyHelper(representation, "DSMIsoValues").GetNumberOfElements() > 0)
  {
    return;
  }
  vtkSMProperty* suggestion = representation->GetProperty("DSMSuggestedIsoValue");
  suggestion->GetParent()->UpdatePropertyInformation(suggestion);
  const double value = vtkSMPropertyHelper(suggestion).GetAsDouble();
  if (std::isfinite(value))
  {
    this->IsTaking = true;
    vtkSMPropertyHelper(single).Set(value);
    representation->UpdateVTKObjects();
    this->IsTaking = false;
  }
}

void vtkPVDSMIsovalueWatch::Watch(vtkSMProxy* representation)
{
  vtkSMProperty* single = representation->GetProperty(Single);
  if (single && !single->HasObserver(vtkCommand::UncheckedPropertyModifiedEvent, this->Observer))
  {
    single->AddObserver(vtkCommand::UncheckedPropertyModifiedEvent, this->Observer);
  }
}

// Past the property, whose changes the application traces, and may undo.
void vtkPVDSMIsovalueWatch::OnChange(vtkSMProperty* single)
{
  vtkSMProxy* proxy = single->GetParent();
  if (this->IsTaking || !proxy)
  {
    return;
  }
  vtkClientServerStream stream;
  stream << vtkClientServerStream::Invoke << VTKOBJECT(proxy) << "SetSingleIsoValue"
         << vtkSMUncheckedPropertyHelper(single).GetAsDouble() << vtkClientServerStream::End;
  proxy->GetSession()->ExecuteStream(proxy->GetLocation(), stream);
  this->Changed();
}
