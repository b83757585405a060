// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_OtherKind_h
#define rt_OtherKind_h

#include <memory>
#include <utility>

namespace rt
{

class MediumTracer;
class ObjectDigest;
class ObjectTracer;

/// An object or a medium of a kind that SceneObject or SceneMedium does not name, such as of a field that only
/// tests have. CreateOtherObject and CreateOtherMedium (OtherKindDescription.h) make it. Its tracers derive from
/// `TracerType`.
template <class TracerType>
class OtherKind
{
public:
  class Description;

  /// `described`: not null.
  explicit OtherKind(std::shared_ptr<const Description> described)
    : Described(std::move(described))
  {
  }

  const Description& Get() const { return *this->Described; }

  ///@{
  /// See SceneObject and SceneMedium.
  bool IsOpaque() const;
  bool IsLayered() const;
  void AddShapeTo(ObjectDigest& digest) const;
  void AddTo(ObjectDigest& digest) const;
  ///@}

private:
  std::shared_ptr<const Description> Described;
};

using OtherMedium = OtherKind<MediumTracer>;
using OtherObject = OtherKind<ObjectTracer>;

} // namespace rt

#endif
