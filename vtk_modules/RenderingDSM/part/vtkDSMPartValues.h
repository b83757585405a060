// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMPartValues_h
#define vtkDSMPartValues_h

#include "DSMBricks/base/Box.h"
#include "DSMBricks/layout/FirstIsovalue.h"
#include "DSMBricks/layout/GridPlanes.h"
#include "DSMBricks/layout/MacrocellHierarchy.h"
#include "DSMRayTracing/field/Fields.h"
#include "vtkDSMNestedLevels.h"

#include <glm/mat4x4.hpp>

#include <utility>
#include <variant>

/// Published values of one array on a vtkDSMPart, at one level of detail. All scenes that show them share them;
/// they leave the store with their last user, which must happen in the same order on every rank. All arrays of a
/// part have the same kind of field.
class vtkDSMPartValues
{
public:
  virtual ~vtkDSMPartValues() = default;
  vtkDSMPartValues(const vtkDSMPartValues&) = delete;
  vtkDSMPartValues& operator=(const vtkDSMPartValues&) = delete;

  /// Returns the values at their place in the world.
  rt::AnyField GetField(const glm::dmat4& dataToWorld) const
  {
    rt::AnyField any = this->Field;
    std::visit([&](auto& field) { field.SetIndexToWorld(dataToWorld * field.IndexToWorld); }, any);
    return any;
  }
  /// From the index space of the field, or the grid space of its planes, to the data.
  const glm::dmat4& GetIndexToData() const
  {
    return std::visit(
      [](const auto& field) -> const glm::dmat4& { return field.IndexToWorld; }, this->Field);
  }
  virtual bricks::ValueRange GetRange() const
  {
    return std::visit(
      [](const auto& field) { return field.GetValues().Hierarchy.GetRange(); }, this->Field);
  }
  /// Returns the bricks from which a first isovalue is found.
  virtual bricks::SurveyedBricks GetSurveyed() const = 0;

  ///@{
  /// The slices that can be chosen by an index: their number along each axis, and where they are if their distances
  /// differ (else null).
  virtual bricks::Index3 CountSlices() const = 0;
  virtual const bricks::GridPlanes* GetPlanes() const { return nullptr; }
  ///@}

  /// From indices of slices to the data.
  virtual const glm::dmat4& GetSlicesToData() const { return this->GetIndexToData(); }

  /// Returns the number of coarser levels of detail that vtkDSMPart::PublishCoarser may find.
  virtual int CountCoarser() const { return 0; }
  /// Returns the level that the result of vtkDSMPart::Publish is of: finer ones are too large.
  virtual int GetLevel() const { return 0; }
  /// Levels of which a picture may show a box each (vtkDSMPart::PublishBoxes); null: none.
  virtual const vtkDSMNestedLevels* GetNested() const { return nullptr; }

protected:
  /// `field`: in the space of the data.
  explicit vtkDSMPartValues(rt::AnyField field)
    : Field(std::move(field))
  {
  }

private:
  rt::AnyField Field;
};

#endif
