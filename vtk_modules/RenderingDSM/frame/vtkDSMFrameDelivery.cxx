// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMFrameDelivery.h"

#include "vtkDSMFrameLayers.h"
#include "vtkDSMFrameProp.h"

#include <cstddef>
#include <cstdint>
#include <utility>

void vtkDSMFrameDelivery::UseTiles()
{
  this->DrawsColor = nullptr;
  this->DrawsPlace = nullptr;
}

void vtkDSMFrameDelivery::UseWholeFrames(ColorChoice drawsColor, PlaceChoice drawsPlace)
{
  this->DrawsColor = std::move(drawsColor);
  this->DrawsPlace = std::move(drawsPlace);
}

rt::Picture vtkDSMFrameDelivery::Assemble(const rt::Frame& frame) const
{
  return this->DrawsColor ? rt::Picture() : rt::AssembleTiles(frame);
}

rt::Picture vtkDSMFrameDelivery::Gather(
  dsm::Messenger& messenger, const rt::Frame& frame, rt::Picture assembled, bool hasEdges) const
{
  if (this->DrawsColor)
  {
    return rt::GatherFrame(messenger, frame);
  }
  if (hasEdges)
  {
    rt::AddEdges(messenger, frame, assembled);
  }
  return assembled;
}

void vtkDSMFrameDelivery::Prepare(const rt::FrameRequest& request, rt::Picture& picture) const
{
  if (request.Layers > 1)
  {
    vtkDSMFrameLayers::Separate(picture);
    if (this->DrawsPlace)
    {
      this->LeaveToOthers(request, picture);
    }
  }
}

void vtkDSMFrameDelivery::Show(const rt::FrameRequest& request, rt::Picture picture,
  vtkCamera* camera, vtkMatrix4x4* projection, const double bounds[6], bool hasEdges,
  vtkDSMFrameProp* prop) const
{
  if (request.Layers > 1)
  {
    prop->SetLayers(picture, projection, bounds);
    return;
  }
  using Drawing = vtkDSMFrameProp::Drawing;
  const bool drawsColor = !this->DrawsColor || this->DrawsColor(camera);
  const bool sharesEdges = hasEdges && !this->DrawsColor;
  prop->SetFrame(std::move(picture), projection, bounds,
    !drawsColor     ? Drawing::DepthOnly
      : sharesEdges ? Drawing::SharedEdges
                    : Drawing::All);
}

/// Takes out what other ranks draw.
void vtkDSMFrameDelivery::LeaveToOthers(const rt::FrameRequest& request, rt::Picture& picture) const
{
  const glm::dmat4 clipToWorld = glm::inverse(request.WorldToClip);
  const std::size_t pixels = static_cast<std::size_t>(picture.Width) * picture.Height;
  for (std::size_t place = 0; place < pixels * picture.Layers; ++place)
  {
    std::uint8_t& alpha = picture.Color[4 * place + 3];
    if (alpha == 0)
    {
      continue;
    }
    const std::size_t pixel = place % pixels;
    const double x = static_cast<double>(pixel % picture.Width) + 0.5;
    const double y = static_cast<double>(pixel / picture.Width) + 0.5;
    const glm::dvec4 clip(2.0 * x / picture.Width - 1.0, 2.0 * y / picture.Height - 1.0,
      2.0 * static_cast<double>(picture.Depth[place]) - 1.0, 1.0);
    const glm::dvec4 world = clipToWorld * clip;
    const double point[3] = { world.x / world.w, world.y / world.w, world.z / world.w };
    alpha = this->DrawsPlace(point) ? alpha : std::uint8_t{ 0 };
  }
}
