// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMImageArrays.h"

#include "vtkDSMFileArray.h"
#include "vtkDSMGather.h"
#include "vtkDSMImagePiece.h"

#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"

#include <algorithm>
#include <cstring>

namespace
{

bricks::ValidValues FindValid(vtkDataArray* array, const vtkDSMImageArrays::Choice& choice)
{
  if (choice.Component == vtkDSMImagePiece::Color)
  {
    return {};
  }
  bricks::ValidValues valid = choice.Valid;
  const vtkDSMFileValues* const file = vtkDSMGetFileValues(array);
  const bool isOne = array->GetNumberOfComponents() == 1 || choice.Component >= 0;
  if (file && isOne)
  {
    const bricks::ValidValues& own = file->GetArray().Valid;
    valid = { std::max(valid.Lowest, own.Lowest), std::min(valid.Highest, own.Highest), own.Fills };
  }
  return valid;
}

} // namespace

vtkDataArray* vtkDSMImageArrays::Find(vtkDataObject* part, const Choice& choice, Info& info)
{
  const int type = choice.OnCells ? vtkDataObject::CELL : vtkDataObject::POINT;
  vtkDataSetAttributes* const attributes = part->GetAttributes(type);
  if (!attributes)
  {
    info.Found = State::Missing;
    return nullptr;
  }
  vtkAbstractArray* found = choice.Name.empty()
    ? static_cast<vtkAbstractArray*>(attributes->GetScalars())
    : attributes->GetAbstractArray(choice.Name.c_str());
  if (!found)
  {
    vtkDataSetAttributes* const ofCells = part->GetAttributes(vtkDataObject::CELL);
    const bool onCells = choice.Name.empty()
      ? attributes->GetNumberOfArrays() == 0 && ofCells->GetNumberOfArrays() > 0
      : ofCells->HasArray(choice.Name.c_str());
    info.Found = onCells && !choice.OnCells ? State::OnCells : State::Missing;
    return nullptr;
  }
  auto* array = vtkDataArray::SafeDownCast(found);
  if (!array)
  {
    info.Found = State::NotNumeric;
    return nullptr;
  }
  info.Components = array->GetNumberOfComponents();
  const bool areColors = choice.Component == vtkDSMImagePiece::Color;
  if (areColors && (info.Components > 4 || array->GetDataType() == VTK_CHAR))
  {
    info.Found = State::NoColors;
    return nullptr;
  }
  if (choice.Component >= info.Components || choice.Component < vtkDSMImagePiece::Color)
  {
    info.Found = State::NoSuchComponent;
    return nullptr;
  }
  if (array->GetNumberOfTuples() != part->GetNumberOfElements(type))
  {
    info.Found = State::WrongLength;
    return nullptr;
  }
  info.Found = State::Usable;
  info.Type = vtkDSMImagePiece::GetScalarType(array, choice.Component);
  info.Valid = FindValid(array, choice);
  return array;
}

vtkDSMImageArrays::vtkDSMImageArrays(dsm::Messenger& messenger,
  const std::vector<vtkSmartPointer<vtkDataObject>>& parts,
  const std::vector<vtkSmartPointer<vtkDataObject>>& all)
  : Components(Gather(messenger, parts))
  , WithHidden(Gather(messenger, all))
{
}

vtkDSMImageArrays::Counts vtkDSMImageArrays::Gather(
  dsm::Messenger& messenger, const std::vector<vtkSmartPointer<vtkDataObject>>& parts)
{
  std::vector<char> mine;
  const auto append = [&mine](const std::string& text)
  { mine.insert(mine.end(), text.c_str(), text.c_str() + text.size() + 1); };
  const auto appendAll = [&append](vtkDataSetAttributes* attributes, const char* place)
  {
    if (!attributes)
    {
      return;
    }
    if (vtkDataArray* active = attributes->GetScalars())
    {
      append(place);
      append("");
      append(std::to_string(active->GetNumberOfComponents()));
    }
    for (int index = 0; index < attributes->GetNumberOfArrays(); ++index)
    {
      vtkDataArray* array = attributes->GetArray(index);
      if (array && array->GetName() &&
        std::strcmp(array->GetName(), vtkDataSetAttributes::GhostArrayName()) != 0)
      {
        append(place);
        append(array->GetName());
        append(std::to_string(array->GetNumberOfComponents()));
      }
    }
  };
  for (vtkDataObject* part : parts)
  {
    appendAll(part->GetAttributes(vtkDataObject::POINT), "0");
    appendAll(part->GetAttributes(vtkDataObject::CELL), "1");
  }
  Counts counts;
  const std::vector<char> all = vtkDSMGather::Items(messenger, mine);
  for (auto place = all.begin(); place != all.end();)
  {
    const auto name = std::find(place, all.end(), '\0') + 1;
    const auto components = std::find(name, all.end(), '\0') + 1;
    counts[*place == '1' ? 1 : 0][&*name] = std::stoi(&*components);
    place = std::find(components, all.end(), '\0') + 1;
  }
  return counts;
}

vtkDSMImageArrays::Choice vtkDSMImageArrays::Normalize(const Choice& choice) const
{
  const int components = this->CountComponents(choice);
  if (components == 0 || choice.Component == vtkDSMImagePiece::Color)
  {
    return choice;
  }
  Choice normal = choice;
  // ParaView's panels number the magnitude after the last component.
  normal.Component = components == 1 ? 0
    : choice.Component == components ? vtkDSMImagePiece::Magnitude
                                     : choice.Component;
  return normal;
}

int vtkDSMImageArrays::CountComponents(const Choice& choice) const
{
  const auto& arrays = this->Components[choice.OnCells ? 1 : 0];
  const auto known = arrays.find(choice.Name);
  return known != arrays.end() ? known->second : 0;
}

bool vtkDSMImageArrays::HasOpacity(const Choice& choice) const
{
  const int components = this->CountComponents(choice);
  return components > 0 && components % 2 == 0;
}

void vtkDSMImageArrays::Refuse(
  const Choice& choice, const std::string& purpose, const std::vector<Info>& infos) const
{
  std::string list;
  for (const auto& [name, components] : this->Components[choice.OnCells ? 1 : 0])
  {
    list += name.empty() ? "" : (list.empty() ? "'" : ", '") + name + "'";
  }
  const std::string array = "The " + purpose + " '" + choice.Name + "'";
  const std::string remedy = !list.empty() ? " Choose one of " + list + "."
    : choice.OnCells                       ? " The dataset has no numeric cell array."
                                           : " The dataset has no numeric point array.";
  const auto is = [&](State state)
  {
    return std::any_of(
      infos.begin(), infos.end(), [=](const Info& info) { return info.Found == state; });
  };
  if (is(State::NotNumeric))
  {
    throw dsm::Error(array + " contains text, not numbers." + remedy);
  }
  if (is(State::NoSuchComponent))
  {
    const int components = this->CountComponents(choice);
    throw dsm::Error(array +
      (components > 1 ? " has the components 0 to " + std::to_string(components - 1) + ", and " +
            std::to_string(components) + " for the magnitude"
                      : std::string(" has the component 0 only")) +
      ". Choose one of these.");
  }
  if (is(State::WrongLength))
  {
    throw dsm::Error(array + " does not have one value for every " +
      (choice.OnCells ? "cell" : "point") + " of the image." + remedy);
  }
  if (is(State::NoColors))
  {
    throw dsm::Error(array +
      " does not contain colors: colors have up to four components and a type other than char. "
      "Turn on Map Scalars.");
  }
  const auto& withHidden = this->WithHidden[choice.OnCells ? 1 : 0];
  if (withHidden.find(choice.Name) != withHidden.end())
  {
    throw Missing("");
  }
  if (is(State::OnCells) && !choice.Name.empty())
  {
    throw Missing(array +
      " is a cell array, but a point array of that name is chosen. Choose the cell array: "
      "['CELLS', '" +
      choice.Name + "'] in ParaView, SetIsoArrayOnCells(true) or the like in VTK.");
  }
  if (is(State::OnCells))
  {
    std::string cells;
    for (const auto& [name, components] : this->Components[1])
    {
      cells += name.empty() ? "" : (cells.empty() ? "'" : ", '") + name + "'";
    }
    throw Missing("No " + purpose + " is chosen. The dataset has only cell arrays. Choose one of " +
      cells + ".");
  }
  throw Missing((choice.Name.empty() ? "No " + purpose + " is chosen."
                                     : array + " does not exist in the dataset.") +
    remedy);
}
