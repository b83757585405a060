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
    /// Of a part of an assembly: where it is in the world; null: where the prop itself says.
    vtkSmartPointer<vtkMatrix4x4> Place;
  };

  /// Looks through the renderer's props, and through their assemblies. What belongs to props that were
  /// removed is let go; what is hidden is kept, but not shown.
  void Find(vtkRenderer* renderer);

  /// Those that are visible, in the renderer's order.
  const std::vector<Member>& GetShown() const { return this->Shown; }
  /// With those that are hidden.
  std::size_t GetCount() const { return this->States.size(); }

  void GiveUpBlocks();
  /// Of the hidden ones that have bricks, the one that was shown the longest ago; null without any.
  vtkDSMSceneMember* FindOldestHidden() const;

  /// What is shown becomes the objects of the scene, at the finest level of detail (0), or so many below it.
  void AddTo(rt::Scene& scene, int coarser) const;
  /// The most levels below the finest that anything has.
  int CountCoarser() const;

  /// Of what is shown, in world space; not initialised where nothing is.
  void GetBounds(double bounds[6]) const;

  /// What is set for the mappers that are shown has its effect on the light and the memory of all.
  void ForwardOptions(vtkDSMLightOptions* light, vtkDSMMemoryOptions* memory) const;

  /// Whether the renderer has anything else to show, that may be behind, or between, translucent surfaces.
  bool AreBesideOthers(vtkRenderer* renderer) const { return !this->FindOthers(renderer).empty(); }
  /// These; of assemblies, the whole.
  std::vector<vtkProp*> FindOthers(vtkRenderer* renderer) const;

private:
  std::vector<std::unique_ptr<vtkDSMSceneMember>> States;
  std::vector<Member> Shown;
};

#endif
