// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMSceneMembers_h
#define vtkDSMSceneMembers_h

#include "DSMRayTracing/frame/FrameRequest.h"
#include "DSMRayTracing/scene/Scene.h"
#include "vtkDSMSceneMember.h"

#include "vtkSmartPointer.h"

#include <cstdint>
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
    int Level = 0; ///< of detail; see ChooseLevels
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

  /// Local: chooses the level of detail of each shown member for a picture (vtkDSMSceneMember::FindLevel), or the boxes
  /// of its levels; 0 pixels: the finest. While a view is `moving`, none becomes finer, and boxes stay. Returns a
  /// number that ranks share that choose the same.
  std::uint64_t ChooseLevels(const rt::FrameRequest& request, double pixels, bool moving);
  /// Local: how many levels below the finest a draft is of.
  int FindDraftLevel(const rt::FrameRequest& request, double pixels) const;
  /// Local: whether any boxes of levels are shown.
  bool HaveBoxes() const;
  /// Local: whether any boxes are to be shown that are not; TakeBoxes, collective, shows them.
  bool NeedBoxes() const;
  void TakeBoxes(const std::shared_ptr<vtkDSMRankGroup>& group);
  /// The coarsest level of detail that was chosen for anything, below the finest; and the finest one of what has
  /// several.
  int GetCoarsestChosen() const;
  int GetFinestChosen() const;
  /// Adds the shown members' objects to the scene, at the level of detail that was chosen (0), or, of those that have
  /// finer ones, so many levels below the finest.
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
