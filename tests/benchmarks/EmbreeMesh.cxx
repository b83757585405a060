// SPDX-License-Identifier: BSD-3-Clause
#include "EmbreeMesh.h"

#include "DSMCore/base/Error.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <chrono>
#include <string>

struct EmbreeMesh::Handles
{
  RTCDevice Device = nullptr;
  RTCScene Scene = nullptr;
  ~Handles()
  {
    rtcReleaseScene(this->Scene);
    rtcReleaseDevice(this->Device);
  }
};

const char* EmbreeMesh::GetVersion()
{
  return RTC_VERSION_STRING;
}

EmbreeMesh::EmbreeMesh(const MeshFile::Mesh& mesh, int threads)
  : Scene(std::make_unique<Handles>())
{
  this->Scene->Device = rtcNewDevice(("threads=" + std::to_string(threads)).c_str());
  if (!this->Scene->Device)
  {
    throw dsm::Error("Embree cannot be started.");
  }
  const auto start = std::chrono::steady_clock::now();
  this->Scene->Scene = rtcNewScene(this->Scene->Device);
  RTCGeometry geometry = rtcNewGeometry(this->Scene->Device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* positions = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
    RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.GetPointCount()));
  auto* triangles = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX,
    0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), mesh.GetTriangleCount()));
  std::copy(mesh.Positions.begin(), mesh.Positions.end(), positions);
  std::transform(mesh.Triangles.begin(), mesh.Triangles.end(), triangles,
    [](std::uint64_t point) { return static_cast<unsigned>(point); });
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(this->Scene->Scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(this->Scene->Scene);
  this->BuildSeconds =
    std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (rtcGetDeviceError(this->Scene->Device) != RTC_ERROR_NONE)
  {
    throw dsm::Error("Embree cannot build the mesh.");
  }
}

EmbreeMesh::~EmbreeMesh() = default;

namespace
{

/// How rays that belong together are traced.
struct CoherentQuery
{
#if RTC_VERSION_MAJOR >= 4
  RTCIntersectArguments Arguments;
  CoherentQuery()
  {
    rtcInitIntersectArguments(&this->Arguments);
    this->Arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  }
  void Intersect(RTCScene scene, RTCRayHit& ray)
  {
    rtcIntersect1(scene, &ray, &this->Arguments);
  }
  void Intersect(const int* valid, RTCScene scene, RTCRayHit16& rays)
  {
    rtcIntersect16(valid, scene, &rays, &this->Arguments);
  }
#else
  RTCIntersectContext Context;
  CoherentQuery()
  {
    rtcInitIntersectContext(&this->Context);
    this->Context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  }
  void Intersect(RTCScene scene, RTCRayHit& ray)
  {
    rtcIntersect1(scene, &this->Context, &ray);
  }
  void Intersect(const int* valid, RTCScene scene, RTCRayHit16& rays)
  {
    rtcIntersect16(valid, scene, &this->Context, &rays);
  }
#endif
};

} // namespace

bool EmbreeMesh::Intersect(const rt::Ray& ray, double& t) const
{
  RTCRayHit query{};
  query.ray.org_x = static_cast<float>(ray.Origin.x);
  query.ray.org_y = static_cast<float>(ray.Origin.y);
  query.ray.org_z = static_cast<float>(ray.Origin.z);
  query.ray.dir_x = static_cast<float>(ray.Direction.x);
  query.ray.dir_y = static_cast<float>(ray.Direction.y);
  query.ray.dir_z = static_cast<float>(ray.Direction.z);
  query.ray.tnear = static_cast<float>(ray.Min);
  query.ray.tfar = static_cast<float>(ray.Max);
  query.ray.mask = ~0u;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  CoherentQuery().Intersect(this->Scene->Scene, query);
  t = static_cast<double>(query.ray.tfar);
  return query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
}

rt::RayMask EmbreeMesh::IntersectPackets(const rt::Ray* rays, rt::RayMask wanted, double* t) const
{
  constexpr int size = 16;
  rt::RayMask found = 0;
  for (int first = 0; first < rt::MaxRays; first += size)
  {
    if (rt::GetPart(wanted, first, size) == 0)
    {
      continue;
    }
    alignas(64) int valid[size];
    RTCRayHit16 query;
    for (int lane = 0; lane < size; ++lane)
    {
      const int index = first + lane;
      valid[lane] = (wanted & rt::GetBit(index)) != 0 ? -1 : 0;
      query.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
      if (valid[lane] != 0)
      {
        const rt::Ray& ray = rays[index];
        query.ray.org_x[lane] = static_cast<float>(ray.Origin.x);
        query.ray.org_y[lane] = static_cast<float>(ray.Origin.y);
        query.ray.org_z[lane] = static_cast<float>(ray.Origin.z);
        query.ray.dir_x[lane] = static_cast<float>(ray.Direction.x);
        query.ray.dir_y[lane] = static_cast<float>(ray.Direction.y);
        query.ray.dir_z[lane] = static_cast<float>(ray.Direction.z);
        query.ray.tnear[lane] = static_cast<float>(ray.Min);
        query.ray.tfar[lane] = static_cast<float>(ray.Max);
        query.ray.time[lane] = 0.0f;
        query.ray.mask[lane] = ~0u;
      }
    }
    CoherentQuery().Intersect(valid, this->Scene->Scene, query);
    for (int lane = 0; lane < size; ++lane)
    {
      if (valid[lane] != 0 && query.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID)
      {
        t[first + lane] = static_cast<double>(query.ray.tfar[lane]);
        found |= rt::GetBit(first + lane);
      }
    }
  }
  return found;
}
