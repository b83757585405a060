// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMFrameDelivery_h
#define vtkDSMFrameDelivery_h

#include "DSMCore/transport/Messenger.h"
#include "DSMRayTracing/frame/Frame.h"
#include "DSMRayTracing/frame/FrameGather.h"
#include "DSMRayTracing/frame/FrameRequest.h"

#include <functional>

class vtkCamera;
class vtkDSMFrameProp;
class vtkMatrix4x4;

/// How a frame gets from the ranks that traced its tiles to those that draw it. Which way is the
/// application's choice, the same on every rank; see vtkDSMScene.
class vtkDSMFrameDelivery
{
public:
  using ColorChoice = std::function<bool(vtkCamera*)>;
  using PlaceChoice = std::function<bool(const double place[3])>;

  /// Each rank draws its own tiles.
  void UseTiles();
  /// Each rank draws everything, but color only where `drawsColor` says so, and of surfaces that are
  /// kept apart, where `drawsPlace` is set, those for whose place that says so.
  void UseWholeFrames(ColorChoice drawsColor, PlaceChoice drawsPlace = nullptr);

  /// Returns whether surfaces can be kept in separate layers with so many ranks.
  bool CanSeparate(int ranks) const { return ranks == 1 || this->DrawsPlace; }
  /// Returns whether the application blends the ranks' images; otherwise the nearest of them is
  /// visible.
  bool AreBlended() const { return static_cast<bool>(this->DrawsColor); }

  /// Local, before Gather: of this rank's part of a frame, as much of what it draws as needs no other ranks; else
  /// nothing.
  rt::Picture Assemble(const rt::Frame& frame) const;

  /// Collective where NeedsRanks: what this rank draws; the whole frame, or its own tiles. `assembled`: see
  /// Assemble. `hasEdges`: an opaque surface may cover pixels in part. The surface behind it may be another rank's,
  /// so all ranks draw such pixels.
  rt::Picture Gather(
    dsm::Messenger& messenger, const rt::Frame& frame, rt::Picture assembled, bool hasEdges) const;
  bool NeedsRanks(bool hasEdges) const { return this->DrawsColor || hasEdges; }

  /// Local: leaves, of surfaces that are kept apart, what this rank has to draw.
  void Prepare(const rt::FrameRequest& request, rt::Picture& picture) const;

  /// Local: the prop draws a prepared picture from now on. `bounds`: of what it shows, on all ranks. `hasEdges`: as
  /// in Gather, where there are several ranks.
  void Show(const rt::FrameRequest& request, rt::Picture picture, vtkCamera* camera,
    vtkMatrix4x4* projection, const double bounds[6], bool hasEdges, vtkDSMFrameProp* prop) const;

private:
  void LeaveToOthers(const rt::FrameRequest& request, rt::Picture& picture) const;

  ColorChoice DrawsColor; ///< set: the frame is delivered everywhere
  PlaceChoice DrawsPlace;
};

#endif
