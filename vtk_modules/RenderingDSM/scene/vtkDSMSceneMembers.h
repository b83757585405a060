// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMSceneMembers_h
#define vtkDSMSceneMembers_h

#include "DSMRayTracing/scene/DebugView.h"
#include "DSMRayTracing/scene/Scene.h"
#include "vtkDSMMemorySettings.h"
#include "vtkDSMSceneMember.h"

#include "vtkSmartPointer.h"

#include <memory>
#include <vector>

class vtkMatrix4x4;
class vtkProp3D;
class vtkRenderer;

/// The objects of a renderer that are traced, and what they ask for together. Local; but the ranks find
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

  /// What is asked for by those that the renderer, which may have been changed since, still shows.
  vtkDSMMemorySettings GetMemorySettings(vtkRenderer* renderer) const;

  /// Whether the renderer has anything else to show, that may be behind, or between, translucent surfaces.
  bool AreBesideOthers(vtkRenderer* renderer) const;

  /// Of each property, what the most demanding object that is shown wants.
  /// A first look costs rays that a picture in passing does without.
  rt::LightTransport GetTransport(bool isPassing) const;
  double GetEnvironmentLight() const;
  int GetSamplesPerPixel() const;
  bool ShowStatistics() const;
  /// The first that an object asks for.
  rt::DebugView GetDebugView() const;
  /// Whether every object agrees to a debug view's legend.
  bool ShowLegend() const;

private:
  std::vector<std::unique_ptr<vtkDSMSceneMember>> States;
  std::vector<Member> Shown;
};

#endif
