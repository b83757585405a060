// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMSceneMembers_h
#define vtkDSMSceneMembers_h

#include "DSMRayTracing/scene/Scene.h"
#include "vtkDSMSceneMember.h"

#include "vtkSmartPointer.h"

#include <memory>
#include <vector>

class vtkMatrix4x4;
class vtkProp;
class vtkProp3D;
class vtkRenderer;

/// The objects of a renderer that are traced. Local; but the ranks find
/// the same objects in the same order.
class vtkDSMSceneMembers
{
public:
  struct Member
  {
    vtkProp3D* Prop;
    vtkDSMSceneMember* State;
    /// For a part of an assembly: its matrix in world space; null: the prop's own matrix.
    vtkSmartPointer<vtkMatrix4x4> Place;
  };

  /// Traverses the renderer's props and their assemblies. Releases members of removed props; keeps members of
  /// hidden props, but does not show them.
  void Find(vtkRenderer* renderer);

  /// Returns the visible members, in the renderer's order.
  const std::vector<Member>& GetShown() const { return this->Shown; }
  /// With those that are hidden.
  std::size_t GetCount() const { return this->States.size(); }

  void GiveUpBlocks();
  /// Returns the hidden member with bricks that was shown the longest ago; null if there is none.
  vtkDSMSceneMember* FindOldestHidden() const;

  /// Adds the shown members' objects to the scene, at the finest level of detail (0), or so many
  /// levels below it.
  void AddTo(rt::Scene& scene, int coarser) const;
  /// The most levels below the finest that anything has.
  int CountCoarser() const;

  /// Finds the bounds of the shown members, in world space; not initialized if there are none.
  void GetBounds(double bounds[6]) const;

  /// Applies the options of the shown mappers to the light and the memory of all.
  void ForwardOptions(vtkDSMLightOptions* light, vtkDSMMemoryOptions* memory) const;

  /// Returns whether the renderer shows anything else, which may be behind, or between, translucent
  /// surfaces.
  bool AreBesideOthers(vtkRenderer* renderer) const { return !this->FindOthers(renderer).empty(); }
  /// These; of assemblies, the whole.
  std::vector<vtkProp*> FindOthers(vtkRenderer* renderer) const;

private:
  std::vector<std::unique_ptr<vtkDSMSceneMember>> States;
  std::vector<Member> Shown;
};

#endif
