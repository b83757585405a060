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
#if RTC_VERSION_MAJOR >= 4
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  rtcIntersect1(this->Scene->Scene, &query, &arguments);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect1(this->Scene->Scene, &context, &query);
#endif
  t = static_cast<double>(query.ray.tfar);
  return query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
}
