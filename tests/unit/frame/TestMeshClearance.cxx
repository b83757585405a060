// SPDX-License-Identifier: BSD-3-Clause
// Rays that leave a mesh's surface miss that surface, at any scale, and nothing else.
#include "tests/support/MeshScene.h"

#include "DSMRayTracing/frame/FrameGather.h"
#include "DSMRayTracing/frame/FrameRenderer.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <tuple>
#include <variant>

namespace
{

/// Pictures of one mesh.
class MeshClearance : public testing::Test
{
protected:
  static constexpr int Size = 40;

  void Show(const TestMesh::Mesh& mesh, const glm::dmat4& place = glm::dmat4(1.0))
  {
    rt::MeshObject object;
    object.Instance = std::make_shared<rt::MeshInstance>(
      MeshScene::Publish(mesh, this->Messenger, this->Store), place);
    object.Look.Flat = true;
    this->World.Objects = { object };
  }

  rt::Picture Trace(const glm::dmat4& worldToClip)
  {
    rt::FrameRequest request;
    request.Width = request.Height = Size;
    request.WorldToClip = worldToClip;
    rt::FrameRenderer renderer(this->Messenger);
    return rt::GatherFrame(this->Messenger, renderer.Render(this->Store, this->World, request));
  }

  dsm::Messenger Messenger{ std::move(dsm::LoopbackTransport::CreateGroup(1).front()) };
  dsm::BlockStore Store{ Messenger, dsm::BlockStore::Settings{} };
  rt::Scene World;
};

/// Looks down the z axis, in parallel, at [x - half, x + half] times [y - half, y + half].
glm::dmat4 LookDown(double x, double y, double half)
{
  const glm::dvec3 center(x, y, 0.0);
  return glm::ortho(-half, half, -half, half, 0.0, 10.0) *
    glm::lookAt(center + glm::dvec3(0.0, 0.0, 5.0), center, glm::dvec3(0.0, 1.0, 0.0));
}

const std::uint8_t* GetColor(const rt::Picture& picture, int x, int y)
{
  return &picture.Color[4 * (static_cast<std::size_t>(y) * picture.Width + x)];
}

/// Adds a square that looks up.
void AddSquare(TestMesh::Mesh& mesh, const glm::dvec3& center, double half)
{
  const std::uint64_t first = mesh.GetPointCount();
  for (const glm::dvec2& corner : { glm::dvec2(-1, -1), { 1, -1 }, { 1, 1 }, { -1, 1 } })
  {
    mesh.Positions.insert(
      mesh.Positions.end(), { center.x + half * corner.x, center.y + half * corner.y, center.z });
  }
  mesh.Triangles.insert(
    mesh.Triangles.end(), { first, first + 1, first + 2, first, first + 2, first + 3 });
}

/// A convex body of flat sides, all but a sphere.
TestMesh::Mesh CreateSphere(double radius, const glm::dvec3& center)
{
  constexpr int rings = 16; // between the poles
  constexpr int sides = 32;
  TestMesh::Mesh mesh;
  const auto add = [&](double height, double around)
  {
    const double width = std::sqrt(1.0 - height * height);
    const glm::dvec3 point =
      center + radius * glm::dvec3(width * std::cos(around), width * std::sin(around), height);
    mesh.Positions.insert(mesh.Positions.end(), { point.x, point.y, point.z });
  };
  for (int ring = 0; ring < rings; ++ring)
  {
    const double height = -std::cos(glm::pi<double>() * (ring + 1) / (rings + 1));
    for (int side = 0; side < sides; ++side)
    {
      add(height, 2.0 * glm::pi<double>() * side / sides);
    }
  }
  add(-1.0, 0.0);
  add(1.0, 0.0);
  const auto get = [](int ring, int side) -> std::uint64_t
  {
    return ring < 0   ? rings * sides
      : ring == rings ? rings * sides + 1
                      : static_cast<std::uint64_t>(ring * sides + side % sides);
  };
  for (int ring = 0; ring <= rings; ++ring)
  {
    for (int side = 0; side < sides; ++side)
    {
      const std::uint64_t below[2] = { get(ring - 1, side), get(ring - 1, side + 1) };
      const std::uint64_t above[2] = { get(ring, side), get(ring, side + 1) };
      if (ring > 0)
      {
        mesh.Triangles.insert(mesh.Triangles.end(), { below[0], below[1], above[1] });
      }
      if (ring < rings)
      {
        mesh.Triangles.insert(mesh.Triangles.end(), { below[0], above[1], above[0] });
      }
    }
  }
  return mesh;
}

enum class View
{
  Near,
  Middle,
  Far,
  Parallel
};

/// Looks at a sphere of radius 1 around the origin.
glm::dmat4 LookAtSphere(View view)
{
  const auto look = [](double distance, double half)
  {
    const glm::dvec3 from = glm::normalize(glm::dvec3(0.3, 0.5, 1.0));
    const double first = distance - 1.0 > 1.5 ? distance - 1.5 : 0.5 * (distance - 1.0);
    const double open = half * first / distance;
    return glm::frustum(-open, open, -open, open, first, distance + 1.5) *
      glm::lookAt(distance * from, glm::dvec3(0.0), glm::dvec3(0.0, 1.0, 0.0));
  };
  switch (view)
  {
    case View::Near:
      return look(1.01, 0.3);
    case View::Middle:
      return look(4.0, 1.2);
    case View::Far:
      return look(1e6, 1.1);
    case View::Parallel:
      return LookDown(0.0, 0.0, 1.1);
  }
  return glm::dmat4(1.0);
}

} // namespace

TEST_F(MeshClearance, DoesNotGrowWithWhatIsFarAwayInTheSameMesh)
{
  TestMesh::Mesh mesh = CreateSphere(1.0, glm::dvec3(0.0));
  AddSquare(mesh, { 3e6, 0.0, 0.0 }, 1.0);
  this->Show(mesh);
  std::get<rt::MeshObject>(this->World.Objects.front()).Look.Surface.Opacity = 0.5f;
  const rt::Picture picture = this->Trace(LookDown(0.0, 0.0, 0.6));
  for (int y = 0; y < Size; ++y)
  {
    for (int x = 0; x < Size; ++x)
    {
      EXPECT_EQ(GetColor(picture, x, y)[3], 191) << "front and back at " << x << ", " << y;
    }
  }
}

TEST_F(MeshClearance, ATerrainOfAHundredKilometresHasShadowsOfAFewCentimetres)
{
  for (const glm::dvec2& place : { glm::dvec2(0.0), glm::dvec2(3e4, -4e4), glm::dvec2(49998.0) })
  {
    TestMesh::Mesh mesh;
    AddSquare(mesh, glm::dvec3(0.0), 5e4);
    AddSquare(mesh, { place, 0.0625 }, 1.0);
    this->Show(mesh);
    this->World.Lights.resize(1);
    this->World.Lights[0].Direction = glm::normalize(glm::dvec3(1.0, 0.0, -1.0));
    this->World.Transport.Shadows = true;
    // Beyond the edge of the board its shadow goes on for as far as it is high.
    constexpr double half = 0.125;
    const rt::Picture picture = this->Trace(LookDown(place.x + 1.0, place.y, half));
    for (int x = 0; x < Size; ++x)
    {
      const double beyond = half * (2 * x + 1 - Size) / Size;
      const bool dark = beyond > 0.0 && beyond < 0.0625;
      const double border = std::min(std::fabs(beyond), std::fabs(beyond - 0.0625));
      if (border > 0.008) // corners are rounded to 0.004
      {
        EXPECT_EQ(GetColor(picture, x, Size / 2)[0] == 0, dark)
          << beyond << " beyond the board at " << place.x;
      }
    }
  }
}

class SphereAtScale
  : public MeshClearance
  , public testing::WithParamInterface<std::tuple<double, double, View>>
{
};

INSTANTIATE_TEST_SUITE_P(Scales, SphereAtScale,
  testing::Combine(testing::Values(1e-6, 1.0, 1e6), testing::Values(0.0, 1e3, 1e6),
    testing::Values(View::Near, View::Middle, View::Far, View::Parallel)));

TEST_P(SphereAtScale, ShadowsNothingOfItselfAndHidesNothingOfItself)
{
  const auto [radius, away, view] = GetParam();
  const glm::dvec3 center = radius * away * glm::dvec3(0.6, -0.48, 0.64);
  const glm::dmat4 toWorld =
    glm::scale(glm::translate(glm::dmat4(1.0), center), glm::dvec3(radius));
  const glm::dmat4 worldToClip = LookAtSphere(view) * glm::inverse(toWorld);
  for (const bool byMatrix : { false, true })
  {
    this->World = rt::Scene();
    if (byMatrix)
    {
      this->Show(CreateSphere(1.0, glm::dvec3(0.0)), toWorld);
    }
    else
    {
      this->Show(CreateSphere(radius, center));
    }
    const std::string what = byMatrix ? "placed by its matrix" : "placed by its points";
    for (const glm::dvec3& direction :
      { glm::dvec3(-0.3, -1.0, -0.4), { 0.9, -0.1, 0.1 }, { 0.1, 0.2, -1.0 } })
    {
      this->World.Lights.emplace_back();
      this->World.Lights.back().Direction = glm::normalize(direction);
      this->World.Lights.back().Color = glm::vec3(0.4f);
    }
    const rt::Picture bright = this->Trace(worldToClip);
    this->World.Transport.Shadows = true;
    EXPECT_EQ(this->Trace(worldToClip).Color, bright.Color) << what << ": hard shadows";
    this->World.Transport.AmbientOcclusionSamples = 4;
    this->World.Transport.AmbientOcclusionDistance = 10.0 * radius;
    EXPECT_EQ(this->Trace(worldToClip).Color, bright.Color) << what << ": ambient occlusion";

    std::get<rt::MeshObject>(this->World.Objects.front()).Look.Surface.Opacity = 0.5f;
    this->World.Transport = rt::LightTransport();
    const rt::Picture clear = this->Trace(worldToClip);
    int layers = 0;
    for (std::size_t pixel = 0; pixel < clear.Depth.size(); ++pixel)
    {
      const int alpha = clear.Color[4 * pixel + 3];
      EXPECT_TRUE(alpha == 0 || alpha == 191) << what << ": " << alpha;
      layers += alpha == 191;
    }
    EXPECT_GT(layers, Size * Size / 2) << what;
  }
}
