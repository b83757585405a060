// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_CellMedia_h
#define rt_CellMedia_h

#include "DSMRayTracing/field/ValuePredicates.h"
#include "DSMRayTracing/field/tetrahedra/CellField.h"
#include "DSMRayTracing/field/tetrahedra/CellKernel.h"
#include "DSMRayTracing/field/tetrahedra/CellPacket.h"
#include "DSMRayTracing/field/tetrahedra/CellWalk.h"
#include "DSMRayTracing/field/walk/WalkSearch.h"
#include "DSMRayTracing/look/TransferFunction.h"
#include "DSMRayTracing/object/ObjectBeam.h"
#include "DSMRayTracing/ray/MediumLight.h"
#include "DSMRayTracing/ray/Ray.h"
#include "DSMRayTracing/ray/RayMask.h"

namespace rt
{

/// Takes rays through a medium whose values are a CellField's; see LatticeMedia.
template <class Store>
class CellMedia : public WalkSearch<CellField, Store>
{
public:
  CellMedia(
    Store& store, typename Store::Worker& worker, const CellKernel& kernel = CellKernel::GetBest())
    : WalkSearch<CellField, Store>(store, worker)
    , Kernel(kernel)
  {
  }

  static bool CanShade(const CellField&) { return false; }

  RayMask March(const CellField& field, const TransferFunction& function, ObjectBeam*,
    const Ray* rays, RayMask wanted, MediumLight& light) const
  {
    return this->Way.PassEach(
      field, rays, wanted, [&](RayMask) { return TransferPredicate(function); },
      [&](const CellPacket& packet, const CellKernel::Runs& runs, const TransferPredicate&)
      { return this->Kernel.Integrate(packet, runs, function, light); });
  }

private:
  const CellKernel& Kernel;
};

} // namespace rt

#endif
