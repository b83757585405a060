// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_OtherKindDescription_h
#define rt_OtherKindDescription_h

#include "DSMCore/paged/PagedStore.h"
#include "DSMCore/table/ObjectStore.h"
#include "DSMCore/table/ReplicatedStore.h"
#include "DSMRayTracing/object/MediumTracer.h"
#include "DSMRayTracing/object/ObjectTracer.h"
#include "DSMRayTracing/scene/OtherKind.h"

#include <memory>
#include <type_traits>
#include <utility>

namespace rt
{

/// Contents of OtherKind: a description, and functions that make its tracers for each store.
template <class TracerType>
class OtherKind<TracerType>::Description
{
public:
  virtual ~Description() = default;
  virtual bool IsOpaque() const = 0;
  virtual bool IsLayered() const = 0;
  virtual void AddShapeTo(ObjectDigest& digest) const = 0;
  virtual void AddTo(ObjectDigest& digest) const = 0;
  ///@{
  /// The tracer keeps references to all.
  virtual std::unique_ptr<TracerType> CreateTracer(
    dsm::ReplicatedStore& store, dsm::ReplicatedStore::Worker& worker) const = 0;
  virtual std::unique_ptr<TracerType> CreateTracer(
    dsm::ObjectStore& store, dsm::ObjectStore::Worker& worker) const = 0;
  virtual std::unique_ptr<TracerType> CreateTracer(
    dsm::PagedStore& store, dsm::PagedStore::Worker& worker) const = 0;
  ///@}
};

/// A description such as SceneObject and SceneMedium have, held by an OtherKind. Compiles its tracers for all stores.
template <class Kind, class TracerType>
class DescriptionOf final : public OtherKind<TracerType>::Description
{
public:
  explicit DescriptionOf(Kind kind)
    : Described(std::move(kind))
  {
  }

  bool IsOpaque() const override
  {
    if constexpr (IsObject)
    {
      return this->Described.IsOpaque();
    }
    return false;
  }
  bool IsLayered() const override
  {
    if constexpr (!IsObject)
    {
      return this->Described.IsLayered();
    }
    return false;
  }
  void AddShapeTo(ObjectDigest& digest) const override
  {
    if constexpr (IsObject)
    {
      this->Described.AddShapeTo(digest);
    }
  }
  void AddTo(ObjectDigest& digest) const override { this->Described.AddTo(digest); }

  std::unique_ptr<TracerType> CreateTracer(
    dsm::ReplicatedStore& store, dsm::ReplicatedStore::Worker& worker) const override
  {
    return this->Create(store, worker);
  }
  std::unique_ptr<TracerType> CreateTracer(
    dsm::ObjectStore& store, dsm::ObjectStore::Worker& worker) const override
  {
    return this->Create(store, worker);
  }
  std::unique_ptr<TracerType> CreateTracer(
    dsm::PagedStore& store, dsm::PagedStore::Worker& worker) const override
  {
    return this->Create(store, worker);
  }

private:
  static constexpr bool IsObject = std::is_same_v<TracerType, ObjectTracer>;

  template <class Store>
  std::unique_ptr<TracerType> Create(Store& store, typename Store::Worker& worker) const
  {
    return std::make_unique<typename Kind::template Tracer<Store>>(store, worker, this->Described);
  }

  Kind Described;
};

///@{
/// Holds such a description, for a scene.
template <class Kind>
OtherObject CreateOtherObject(Kind described)
{
  return OtherObject(
    std::make_shared<const DescriptionOf<Kind, ObjectTracer>>(std::move(described)));
}
template <class Kind>
OtherMedium CreateOtherMedium(Kind described)
{
  return OtherMedium(
    std::make_shared<const DescriptionOf<Kind, MediumTracer>>(std::move(described)));
}
///@}

} // namespace rt

#endif
