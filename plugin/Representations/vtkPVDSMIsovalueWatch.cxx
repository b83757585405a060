// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMIsovalueWatch.h"

#include "vtkPVDSMImageRepresentation.h"

#include "vtkCallbackCommand.h"
#include "vtkClientServerStream.h"
#include "vtkNew.h"
#include "vtkSMDoubleRangeDomain.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkSMProxyManager.h"
#include "vtkSMSession.h"
#include "vtkSMTrace.h"
#include "vtkSMUncheckedPropertyHelper.h"
#include "vtkSMUndoStackBuilder.h"

#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace
{
constexpr const char* Single = "DSMIsoValue";
constexpr const char* List = "DSMIsoValues";
constexpr const char* Unchosen = "DSMUnchosenIsoValue";

/// After what depends on a property, as ranges do, has heard of it.
constexpr float Late = -1.0f;

/// What that property's range depends on.
constexpr const char* Choices[] = { "DSMIsoArray", "DSMIsoComponent" };

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

/// Whether somebody has chosen the single isovalue.
bool IsChosen(vtkSMProxy* representation)
{
  const double value = vtkSMPropertyHelper(representation, Single).GetAsDouble();
  return value != vtkPVDSMImageRepresentation::FirstIsoValue &&
    value != vtkSMPropertyHelper(representation, Unchosen).GetAsDouble();
}

/// Of the values among which an isovalue is chosen, least and greatest, where they are known.
std::optional<std::array<double, 2>> FindRange(vtkSMProperty* single)
{
  auto* const range = single->FindDomain<vtkSMDoubleRangeDomain>();
  int isKnown[2] = { 0, 0 };
  const double least = range ? range->GetMinimum(0, isKnown[0]) : 0.0;
  const double most = range ? range->GetMaximum(0, isKnown[1]) : 0.0;
  return isKnown[0] && isKnown[1] ? std::optional(std::array<double, 2>{ least, most })
                                  : std::nullopt;
}

/// What stands there where the data suggest no isovalue: the middle of their range, which is the value of those that are
/// the same everywhere; without a range, 0.
double FindStandIn(vtkSMProperty* single)
{
  const auto [least, most] = FindRange(single).value_or(std::array<double, 2>{ 0.0, 0.0 });
  const double middle = 0.5 * least + 0.5 * most;
  return least <= most && std::isfinite(middle) ? middle : 0.0;
}

/// While it lives, nothing becomes a step of its own for the user to undo.
class NoUndo
{
public:
  NoUndo()
    : Builder(vtkSMProxyManager::GetProxyManager()->GetUndoStackBuilder())
    , Before(this->Builder && this->Builder->GetIgnoreAllChanges())
  {
    this->Ignore(true);
  }
  ~NoUndo() { this->Ignore(this->Before); }
  NoUndo(const NoUndo&) = delete;
  NoUndo& operator=(const NoUndo&) = delete;

private:
  void Ignore(bool ignores)
  {
    if (this->Builder)
    {
      this->Builder->SetIgnoreAllChanges(ignores);
    }
  }

  vtkSMUndoStackBuilder* Builder;
  bool Before;
};
} // namespace

vtkPVDSMIsovalueWatch::vtkPVDSMIsovalueWatch(std::function<void()> changed)
  : Changed(std::move(changed))
{
  vtkNew<vtkCallbackCommand> observer;
  observer->SetClientData(this);
  observer->SetCallback(
    [](vtkObject* property, unsigned long event, void* watch, void*)
    {
      if (watch)
      {
        static_cast<vtkPVDSMIsovalueWatch*>(watch)->OnEvent(
          vtkSMProperty::SafeDownCast(property), event);
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
  this->IsTaking = true;
  ChooseWhatIsMissing(representation);
  this->IsTaking = false;
  this->BeginList(representation);
  if (IsChosen(representation) ||
    vtkSMPropertyHelper(representation, List).GetNumberOfElements() > 0)
  {
    return;
  }
  vtkSMProperty* suggestion = representation->GetProperty("DSMSuggestedIsoValue");
  suggestion->GetParent()->UpdatePropertyInformation(suggestion);
  const double suggested = vtkSMPropertyHelper(suggestion).GetAsDouble();
  const bool isSuggested = std::isfinite(suggested);
  const double value = isSuggested ? suggested : FindStandIn(single);
  this->IsTaking = true;
  const NoUndo noUndo;
  vtkSMPropertyHelper(representation, Unchosen)
    .Set(isSuggested ? vtkPVDSMImageRepresentation::FirstIsoValue : value);
  vtkSMPropertyHelper(single).Set(value);
  representation->UpdateVTKObjects();
  this->IsTaking = false;
}

void vtkPVDSMIsovalueWatch::Watch(vtkSMProxy* representation, bool isInApplication)
{
  vtkSMProperty* single = representation->GetProperty(Single);
  if (!single)
  {
    return;
  }
  const auto observe = [this](vtkSMProperty* property, unsigned long event)
  {
    if (!property->HasObserver(event, this->Observer))
    {
      property->AddObserver(event, this->Observer, Late);
    }
  };
  for (const char* choice : Choices)
  {
    observe(representation->GetProperty(choice), vtkCommand::ModifiedEvent);
    observe(representation->GetProperty(choice), vtkCommand::UncheckedPropertyModifiedEvent);
  }
  observe(single, vtkCommand::ModifiedEvent);
  if (isInApplication)
  {
    observe(single, vtkCommand::UncheckedPropertyModifiedEvent);
    observe(representation->GetProperty(List), vtkCommand::ModifiedEvent);
    observe(representation->GetProperty(List), vtkCommand::UncheckedPropertyModifiedEvent);
  }
}

void vtkPVDSMIsovalueWatch::OnEvent(vtkSMProperty* property, unsigned long event)
{
  vtkSMProxy* const proxy = property->GetParent();
  if (this->IsTaking || !proxy)
  {
    return;
  }
  if (property == proxy->GetProperty(Single))
  {
    event == vtkCommand::ModifiedEvent ? this->OnChoice(proxy) : this->OnSlider(property);
  }
  else if (property == proxy->GetProperty(List))
  {
    this->OnList(property, event);
  }
  else if (event == vtkCommand::ModifiedEvent)
  {
    this->Choice = property;
  }
  else if (property == this->Choice) // what depends on it knows it now
  {
    this->Choice = nullptr;
    this->OnOtherArray(proxy);
  }
}

/// A surface that the new values do not have becomes the one that they suggest, with the next render. Whoever knows the
/// isovalue sets it after the array: scripts, state files, undo.
void vtkPVDSMIsovalueWatch::OnOtherArray(vtkSMProxy* representation)
{
  vtkSMProperty* const single = representation->GetProperty(Single);
  const double value = vtkSMPropertyHelper(single).GetAsDouble();
  const auto [least, most] = FindRange(single).value_or(std::array<double, 2>{ value, value });
  if (IsChosen(representation) && (value < least || value > most))
  {
    vtkSMPropertyHelper(single).Set(vtkPVDSMImageRepresentation::FirstIsoValue);
  }
}

/// The number that stood there may be chosen later. With the choice, so that both are undone together; whoever has
/// made it brings both to the datasets.
void vtkPVDSMIsovalueWatch::OnChoice(vtkSMProxy* representation)
{
  if (IsChosen(representation))
  {
    vtkSMPropertyHelper(representation, Unchosen).Set(vtkPVDSMImageRepresentation::FirstIsoValue);
  }
}

void vtkPVDSMIsovalueWatch::OnList(vtkSMProperty* list, unsigned long event)
{
  const vtkSMPropertyHelper values(list);
  const vtkSMUncheckedPropertyHelper panel(list);
  if (event == vtkCommand::ModifiedEvent && values.GetNumberOfElements() == 0)
  {
    // What the panel shows depends on this; ParaView tells it of values that are set, but not that there are none.
    list->ClearUncheckedElements();
  }
  else if (values.GetNumberOfElements() == 0 && panel.GetNumberOfElements() == 1 &&
    panel.GetAsDouble() == 0.0)
  {
    this->Begun = list;
  }
}

/// A first value that the panel adds is 0, which a script may mean, but here is nobody's choice.
void vtkPVDSMIsovalueWatch::BeginList(vtkSMProxy* representation)
{
  vtkSMProperty* const list = representation->GetProperty(List);
  const double single = vtkSMPropertyHelper(representation, Single).GetAsDouble();
  if (list != this->Begun || vtkSMPropertyHelper(list).GetNumberOfElements() == 0)
  {
    return;
  }
  this->Begun = nullptr;
  if (vtkSMPropertyHelper(list).GetAsDouble() == 0.0 &&
    single != vtkPVDSMImageRepresentation::FirstIsoValue)
  {
    const NoUndo noUndo;
    SM_SCOPED_TRACE(PropertiesModified).arg("proxy", representation);
    vtkSMPropertyHelper(list).Set(single);
    representation->UpdateVTKObjects();
    this->Changed();
  }
}

// Past the property, whose changes the application traces, and may undo.
void vtkPVDSMIsovalueWatch::OnSlider(vtkSMProperty* single)
{
  vtkSMProxy* proxy = single->GetParent();
  vtkClientServerStream stream;
  stream << vtkClientServerStream::Invoke << VTKOBJECT(proxy) << "SetSingleIsoValue"
         << vtkSMUncheckedPropertyHelper(single).GetAsDouble() << vtkClientServerStream::End;
  proxy->GetSession()->ExecuteStream(proxy->GetLocation(), stream);
  this->Changed();
}
