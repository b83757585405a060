// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/scene/OtherKindDescription.h"

namespace rt
{

template <class TracerType>
bool OtherKind<TracerType>::IsOpaque() const
{
  return this->Described->IsOpaque();
}

template <class TracerType>
bool OtherKind<TracerType>::IsLayered() const
{
  return this->Described->IsLayered();
}

template <class TracerType>
void OtherKind<TracerType>::AddShapeTo(ObjectDigest& digest) const
{
  this->Described->AddShapeTo(digest);
}

template <class TracerType>
void OtherKind<TracerType>::AddTo(ObjectDigest& digest) const
{
  this->Described->AddTo(digest);
}

template class OtherKind<MediumTracer>;
template class OtherKind<ObjectTracer>;

} // namespace rt
