// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMStepStatistics.h"

#include "vtkVersionMacros.h"

#if VTK_MAJOR_VERSION == 9 && VTK_MINOR_VERSION < 4

#include "vtkClientServerInterpreter.h"
#include "vtkClientServerInterpreterInitializer.h"
#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkPVXMLElement.h"
#include "vtkSIProxyDefinitionManager.h"
#include "vtkSmartPointer.h"
#include "vtkTemporalStatistics.h"

namespace
{

constexpr const char* Name = "vtkPVDSMStepStatistics";

/// Returns the arrays; those that are not VTK's own as ordinary ones.
vtkSmartPointer<vtkFieldData> Copy(vtkFieldData* arrays)
{
  auto copy = vtkSmartPointer<vtkFieldData>::Take(arrays->NewInstance());
  copy->ShallowCopy(arrays);
  for (int number = 0; number < arrays->GetNumberOfArrays(); ++number)
  {
    vtkDataArray* const array = arrays->GetArray(number);
    if (array && !array->HasStandardMemoryLayout())
    {
      const auto ordinary = vtkSmartPointer<vtkDataArray>::Take(array->NewInstance());
      ordinary->DeepCopy(array);
      ordinary->SetName(array->GetName());
      copy->AddArray(ordinary); // replaces the one with this name
    }
  }
  return copy;
}

/// Has its superclass's name for ParaView, which finds methods by it.
class StepStatistics final : public vtkTemporalStatistics
{
public:
  static vtkObjectBase* Make(void*)
  {
    auto* const made = new StepStatistics;
    made->InitializeObjectBase();
    return made;
  }

private:
  void InitializeArrays(vtkFieldData* input, vtkFieldData* output) override
  {
    vtkTemporalStatistics::InitializeArrays(Copy(input), output);
  }
  void AccumulateArrays(vtkFieldData* input, vtkFieldData* output) override
  {
    vtkTemporalStatistics::AccumulateArrays(Copy(input), output);
  }
};

} // namespace

void vtkPVDSMStepStatistics::Replace(vtkSIProxyDefinitionManager* definitions)
{
  vtkPVXMLElement* const filter =
    definitions->GetProxyDefinition("filters", "TemporalStatistics", false);
  if (filter)
  {
    // This holds for all sessions, also later ones. A second call does nothing.
    vtkClientServerInterpreterInitializer::GetInitializer()->RegisterCallback(
      [](vtkClientServerInterpreter* interpreter)
      { interpreter->AddNewInstanceFunction(Name, &StepStatistics::Make); });
    filter->SetAttribute("class", Name);
  }
}

#else

void vtkPVDSMStepStatistics::Replace(vtkSIProxyDefinitionManager*) {}

#endif
