// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMIsovalueWatch.h"

#include "vtkPVDSMNoUndo.h"
#include "vtkSMDSMImageRepresentationProxy.h"
#include "vtkSMDSMIsovalueDomain.h"
#include "vtkSMDSMVolumeRepresentationProxy.h"

#include "vtkCallbackCommand.h"
#include "vtkClientServerStream.h"
#include "vtkNew.h"
#include "vtkSMDoubleRangeDomain.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkSMSession.h"
#include "vtkSMTrace.h"
#include "vtkSMUncheckedPropertyHelper.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

namespace
{
constexpr const char* Single = "DSMIsoValue";
constexpr const char* List = "DSMIsoValues";

constexpr const char* WatchedIndices[] = { "DSMSliceXIndex", "DSMSliceYIndex", "DSMSliceZIndex" };
/// A property that no other way to show a dataset has.
constexpr const char* OfSlices = "DSMSliceLighting";

/// After what depends on a property, as ranges do, has heard of it.
constexpr float AfterOthers = -1.0f;

/// Properties that the range of that property depends on.
constexpr const char* Choices[] = { "DSMIsoArray", "DSMIsoComponent" };

/// Null for a mesh, which has no isovalue.
vtkSMDSMImageRepresentationProxy* FindVolume(vtkSMProxy* representation)
{
  vtkSMProperty* const single = representation->GetProperty(Single);
  return vtkSMDSMImageRepresentationProxy::SafeDownCast(single ? single->GetParent() : nullptr);
}

/// Returns the range of the values from which an isovalue is chosen, if it is known.
std::optional<std::array<double, 2>> FindRange(vtkSMProperty* single)
{
  auto* const range = single->FindDomain<vtkSMDoubleRangeDomain>();
  int isKnown[2] = { 0, 0 };
  const double least = range ? range->GetMinimum(0, isKnown[0]) : 0.0;
  const double most = range ? range->GetMaximum(0, isKnown[1]) : 0.0;
  return isKnown[0] && isKnown[1] ? std::optional(std::array<double, 2>{ least, most })
                                  : std::nullopt;
}

/// Returns the placeholder for data that suggest no isovalue: the middle of their range, which is
/// the value itself for constant data; 0 without a range.
double FindStandIn(vtkSMProperty* single)
{
  const auto [least, most] = FindRange(single).value_or(std::array<double, 2>{ 0.0, 0.0 });
  const double middle = 0.5 * least + 0.5 * most;
  return least <= most && std::isfinite(middle) ? middle : 0.0;
}
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
  vtkSMProperty* const ofSlices = representation->GetProperty(OfSlices);
  if (auto* const slices =
        vtkSMDSMVolumeRepresentationProxy::SafeDownCast(ofSlices ? ofSlices->GetParent() : nullptr))
  {
    slices->TakeSlices();
  }
  vtkSMDSMImageRepresentationProxy* const volume = FindVolume(representation);
  if (!volume || !volume->ShowsIsosurfaces())
  {
    return;
  }
  volume->NoteRender();
  for (const char* name : { Single, List })
  {
    auto* const domain = representation->GetProperty(name)->FindDomain<vtkSMDSMIsovalueDomain>();
    if (domain)
    {
      domain->TakeSuggestedRange();
    }
  }
  this->BeginList(representation);
  if (!volume->IsIsovalueAutomatic() ||
    vtkSMPropertyHelper(representation, List).GetNumberOfElements() > 0)
  {
    return;
  }
  vtkSMProperty* suggestion = representation->GetProperty("DSMSuggestedIsoValue");
  suggestion->GetParent()->UpdatePropertyInformation(suggestion);
  const double suggested = vtkSMPropertyHelper(suggestion).GetAsDouble();
  volume->SetAutomaticIsovalue(
    std::isfinite(suggested) ? suggested : FindStandIn(volume->GetProperty(Single)));
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
    if (property && !property->HasObserver(event, this->Observer))
    {
      property->AddObserver(event, this->Observer, AfterOthers);
    }
  };
  for (const char* choice : Choices)
  {
    observe(representation->GetProperty(choice), vtkCommand::ModifiedEvent);
    observe(representation->GetProperty(choice), vtkCommand::UncheckedPropertyModifiedEvent);
  }
  if (isInApplication)
  {
    observe(single, vtkCommand::UncheckedPropertyModifiedEvent);
    observe(representation->GetProperty(List), vtkCommand::ModifiedEvent);
    observe(representation->GetProperty(List), vtkCommand::UncheckedPropertyModifiedEvent);
    for (const char* index : WatchedIndices)
    {
      observe(representation->GetProperty(index), vtkCommand::UncheckedPropertyModifiedEvent);
    }
  }
}

void vtkPVDSMIsovalueWatch::OnEvent(vtkSMProperty* property, unsigned long event)
{
  vtkSMProxy* const proxy = property->GetParent();
  if (!proxy)
  {
    return;
  }
  if (property == proxy->GetProperty(Single))
  {
    this->OnSlider(property);
  }
  else if (property == proxy->GetProperty(List))
  {
    this->OnList(property, event);
  }
  else if (std::any_of(std::begin(WatchedIndices), std::end(WatchedIndices),
             [&](const char* index) { return property == proxy->GetProperty(index); }))
  {
    this->OnSliceIndex(property);
  }
  else if (event == vtkCommand::ModifiedEvent)
  {
    this->Choice = property;
  }
  else if (property == this->Choice) // properties that depend on it are up to date now
  {
    this->Choice = nullptr;
    this->OnOtherArray(proxy);
  }
}

/// Another array has another isovalue, which its data suggest with the next render, unless the user
/// has just set it: scripts may do so before they set the array. An isovalue that is set after the
/// array is always kept.
void vtkPVDSMIsovalueWatch::OnOtherArray(vtkSMProxy* representation)
{
  vtkSMDSMImageRepresentationProxy* const volume = FindVolume(representation);
  vtkSMProperty* const single = volume->GetProperty(Single);
  const double value = vtkSMPropertyHelper(single).GetAsDouble();
  const auto [least, most] = FindRange(single).value_or(std::array<double, 2>{ value, value });
  if (volume->IsIsovalueAutomatic() || !volume->IsIsovalueNew() || value < least || value > most)
  {
    volume->SetIsovalueAutomatic();
  }
}

void vtkPVDSMIsovalueWatch::OnList(vtkSMProperty* list, unsigned long event)
{
  const vtkSMPropertyHelper values(list);
  const vtkSMUncheckedPropertyHelper panel(list);
  if (event == vtkCommand::ModifiedEvent && values.GetNumberOfElements() == 0)
  {
    // The panel depends on this: ParaView reports values that are set, but not that there are none.
    list->ClearUncheckedElements();
  }
  else if (values.GetNumberOfElements() == 0 && panel.GetNumberOfElements() == 1 &&
    panel.GetAsDouble() == 0.0)
  {
    this->Begun = list;
  }
}

/// The first value that the panel adds to a list is 0. A script may want that value, but here the
/// user has not chosen it.
void vtkPVDSMIsovalueWatch::BeginList(vtkSMProxy* representation)
{
  vtkSMProperty* const list = representation->GetProperty(List);
  const double single = vtkSMPropertyHelper(representation, Single).GetAsDouble();
  if (list != this->Begun || vtkSMPropertyHelper(list).GetNumberOfElements() == 0)
  {
    return;
  }
  this->Begun = nullptr;
  if (vtkSMPropertyHelper(list).GetAsDouble() == 0.0)
  {
    const vtkPVDSMNoUndo noUndo;
    SM_SCOPED_TRACE(PropertiesModified).arg("proxy", representation);
    vtkSMPropertyHelper(list).Set(single);
    representation->UpdateVTKObjects();
    this->Changed();
  }
}

bool vtkPVDSMIsovalueWatch::IsDragged(vtkSMProperty* property, bool differs)
{
  const bool wasDragged = property == this->Dragged;
  this->Dragged = differs ? property : wasDragged ? nullptr : this->Dragged;
  return differs || wasDragged;
}

// Past the property, whose changes the application traces, and may undo.
void vtkPVDSMIsovalueWatch::OnSlider(vtkSMProperty* single)
{
  const double shown = vtkSMUncheckedPropertyHelper(single).GetAsDouble();
  const bool differs = shown != vtkSMPropertyHelper(single).GetAsDouble();
  if (!this->IsDragged(single, differs))
  {
    return;
  }
  vtkSMProxy* proxy = single->GetParent();
  const int isAutomatic = !differs && FindVolume(proxy)->IsIsovalueAutomatic() ? 1 : 0;
  vtkClientServerStream stream;
  stream << vtkClientServerStream::Invoke << VTKOBJECT(proxy) << "SetSingleIsoValue" << shown
         << vtkClientServerStream::End;
  stream << vtkClientServerStream::Invoke << VTKOBJECT(proxy) << "SetAutomaticIsoValue"
         << isAutomatic << vtkClientServerStream::End;
  proxy->GetSession()->ExecuteStream(proxy->GetLocation(), stream);
  this->Changed();
}

/// All representations of a dataset share the property, but it affects the slices only.
void vtkPVDSMIsovalueWatch::OnSliceIndex(vtkSMProperty* index)
{
  const int shown = vtkSMUncheckedPropertyHelper(index).GetAsInt();
  vtkSMProxy* const display = index->GetParent()->GetParentProxy();
  vtkSMProperty* const ofSlices = display ? display->GetProperty(OfSlices) : nullptr;
  if (!ofSlices || !this->IsDragged(index, shown != vtkSMPropertyHelper(index).GetAsInt()))
  {
    return;
  }
  vtkSMProxy* slices = ofSlices->GetParent();
  const std::string name = index->GetXMLName();
  const std::string method = "Set" + name.substr(std::string("DSM").size());
  vtkClientServerStream stream;
  stream << vtkClientServerStream::Invoke << VTKOBJECT(slices) << method.c_str() << shown
         << vtkClientServerStream::End;
  slices->GetSession()->ExecuteStream(slices->GetLocation(), stream);
  this->Changed();
}
