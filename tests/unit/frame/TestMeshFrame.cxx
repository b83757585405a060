// SPDX-License-Identifier: BSD-3-Clause
// Pictures of meshes: against trying all triangles, and the same however bricks are kept.
#include "tests/support/MeshScene.h"
#include "tests/support/PictureHash.h"

#include "DSMRayTracing/frame/FrameGather.h"
#include "DSMRayTracing/frame/FrameRenderer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <mutex>
#include <variant>

namespace
{

struct Keeping
{
  dsm::MemoryOrganization Organization = dsm::MemoryOrganization::Replicated;
  bool HostSharing = false;
  std::size_t CacheBytes = std::size_t(16) << 20;
};

/// The half towards the camera is cut away of everything, a corner of the volume as well.
void Clip(rt::Scene& scene)
{
  rt::ClipRegion region;
  region.HalfSpaces = { { { -1.0, -0.2, -0.6 }, glm::dvec3(0.5 * SphereScene::Points) } };
  const auto clip = [&](auto& object) { object.Clipping = region; };
  std::for_each(scene.Objects.begin() + 1, scene.Objects.end(),
    [&](rt::SceneObject& mesh) { clip(std::get<rt::MeshObject>(mesh)); });
  rt::ClipRegion::Grid boxes;
  boxes.Lower = glm::dvec3(0.3 * SphereScene::Points);
  boxes.Upper = glm::dvec3(0.7 * SphereScene::Points);
  boxes.Kept = 0x7ffffff & ~(1u << 26 | 1u << 13 | 1u);
  region.Boxes = boxes;
  clip(std::get<rt::LatticeIsosurface>(scene.Objects.front()));
}

rt::Picture Trace(const Keeping& keeping, int ranks, int workers, bool clipped = false)
{
  rt::Picture first;
  std::mutex guard;
  RunOnCluster(ranks,
    [&](dsm::Messenger& messenger)
    {
      dsm::BlockStore::Settings settings =
        SphereScene::CreateSettings(keeping.CacheBytes, workers, keeping.Organization);
      settings.HostSharing = keeping.HostSharing;
      dsm::BlockStore store(messenger, settings);
      rt::Scene scene = MeshScene::Create(messenger, store);
      if (clipped)
      {
        Clip(scene);
      }
      rt::FrameRenderer renderer(messenger);
      renderer.Render(store, scene, SphereScene::CreateRequest(40, 30));
      const rt::Picture picture = rt::GatherFrame(
        messenger, renderer.Render(store, scene, SphereScene::CreateRequest(97, 61)));
      const std::lock_guard<std::mutex> lock(guard);
      if (first.Width == 0)
      {
        first = picture;
      }
      EXPECT_EQ(GetPictureHash(first), GetPictureHash(picture)) << "rank " << messenger.GetRank();
    });
  return first;
}

class MeshFrame : public testing::TestWithParam<Keeping>
{
};

INSTANTIATE_TEST_SUITE_P(Organizations, MeshFrame,
  testing::Values(Keeping{ dsm::MemoryOrganization::Automatic, true },
    Keeping{ dsm::MemoryOrganization::Replicated, true },
    Keeping{ dsm::MemoryOrganization::ObjectBased, false },
    Keeping{ dsm::MemoryOrganization::ObjectBased, false, 4 * MeshScene::BrickBytes },
    Keeping{ dsm::MemoryOrganization::ObjectBased, true },
    Keeping{ dsm::MemoryOrganization::PageBased, false }));

/// One mesh, looked at by a camera that looks down the z axis, in parallel, at [-1.5, 1.5]^2.
class MeshPicture : public testing::Test
{
protected:
  static constexpr int Size = 80;

  rt::MeshObject Publish(const TestMesh::Mesh& mesh, const glm::dmat4& place = glm::dmat4(1.0))
  {
    rt::MeshObject object;
    object.Instance = std::make_shared<rt::MeshInstance>(
      MeshScene::Publish(mesh, this->Messenger, this->Store), place);
    object.Look.Surface.Lighting = false;
    return object;
  }

  rt::Picture Trace(const std::vector<rt::MeshObject>& meshes)
  {
    std::vector<rt::SceneObject>& objects = this->World.Objects;
    objects.erase(std::remove_if(objects.begin(), objects.end(),
                    [](const rt::SceneObject& object)
                    { return std::holds_alternative<rt::MeshObject>(object); }),
      objects.end());
    objects.insert(objects.end(), meshes.begin(), meshes.end());
    rt::FrameRequest request;
    request.Width = Size;
    request.Height = Size;
    request.Layers = this->Layers;
    request.Channels = this->Channels;
    request.WorldToClip = glm::ortho(-1.5, 1.5, -1.5, 1.5, 0.0, 10.0) *
      glm::lookAt(glm::dvec3(0.0, 0.0, 5.0), glm::dvec3(0.0), glm::dvec3(0.0, 1.0, 0.0));
    rt::FrameRenderer renderer(this->Messenger);
    return rt::GatherFrame(this->Messenger, renderer.Render(this->Store, this->World, request));
  }

  /// World position of the middle of a pixel.
  static double GetPlace(int pixel) { return (pixel + 0.5) * 3.0 / Size - 1.5; }
  static glm::ivec4 GetColor(const rt::Picture& picture, double x, double y)
  {
    const auto column = static_cast<std::size_t>((x + 1.5) / 3.0 * Size);
    const auto row = static_cast<std::size_t>((y + 1.5) / 3.0 * Size);
    const std::uint8_t* color = &picture.Color[4 * (row * Size + column)];
    return { color[0], color[1], color[2], color[3] };
  }

  dsm::Messenger Messenger{ std::move(dsm::LoopbackTransport::CreateGroup(1).front()) };
  dsm::BlockStore Store{ Messenger, dsm::BlockStore::Settings{} };
  rt::Scene World;
  int Layers = 1;
  rt::ChannelSet Channels;
};

/// The square [-1, 1]^2 at a height, its front towards the camera; values and colors grow with x.
TestMesh::Mesh CreateSquare(double height)
{
  TestMesh::Mesh mesh;
  mesh.Positions = { -1, -1, height, 1, -1, height, 1, 1, height, -1, 1, height };
  mesh.Triangles = { 0, 1, 2, 0, 2, 3 };
  mesh.Values = { 0.0, 1.0, 1.0, 0.0 };
  mesh.Colors = { 0, 0, 0, 255, 255, 0, 0, 255, 255, 0, 0, 255, 0, 0, 0, 255 };
  return mesh;
}

std::shared_ptr<rt::ColorMap> CreateRainbow()
{
  auto colors = std::make_shared<rt::ColorMap>();
  colors->Table = { { 1.0f, 0.0f, 0.0f, 1.0f }, { 0.0f, 1.0f, 0.0f, 1.0f },
    { 0.0f, 0.0f, 1.0f, 1.0f } };
  return colors;
}

} // namespace

TEST_P(MeshFrame, PictureDoesNotDependOnRanksOrWorkers)
{
  const rt::Picture expected = Trace({}, 1, 1);
  for (const int ranks : { 1, 2, 3, 4 })
  {
    for (const int workers : { 1, 2 })
    {
      const rt::Picture picture = Trace(GetParam(), ranks, workers);
      EXPECT_EQ(picture.Color, expected.Color) << ranks << " ranks, " << workers << " workers";
      EXPECT_EQ(picture.Depth, expected.Depth) << ranks << " ranks, " << workers << " workers";
    }
  }
}

TEST_P(MeshFrame, ClippedPictureDoesNotDependOnRanks)
{
  const rt::Picture expected = Trace({}, 1, 1, true);
  EXPECT_NE(GetPictureHash(expected), GetPictureHash(Trace({}, 1, 1)));
  for (const int ranks : { 2, 3 })
  {
    EXPECT_EQ(GetPictureHash(Trace(GetParam(), ranks, 2, true)), GetPictureHash(expected)) << ranks;
  }
}

TEST_F(MeshPicture, ClippingShowsWhatLiesBehind)
{
  rt::MeshObject above = this->Publish(CreateSquare(0.5));
  above.Look.Surface.DiffuseColor = { 1.0f, 0.0f, 0.0f };
  rt::MeshObject below = this->Publish(CreateSquare(-0.5));
  below.Look.Surface.DiffuseColor = { 0.0f, 0.0f, 1.0f };
  below.Clipping.HalfSpaces = { { { 0.0, 1.0, 0.0 }, { 0.0, -0.4, 0.0 } } };
  above.Clipping.HalfSpaces = { { { 2.0, 0.0, 0.0 }, { 0.2, 0.0, 0.0 } },
    { { 0.0, 0.0, 1.0 }, { 0.0, 0.0, 0.5 } } }; // it lies in the border itself
  const rt::Picture picture = this->Trace({ above, below });
  EXPECT_EQ(GetColor(picture, 0.3, 0.0), glm::ivec4(255, 0, 0, 255));
  EXPECT_EQ(GetColor(picture, 0.1, 0.0), glm::ivec4(0, 0, 255, 255));
  EXPECT_EQ(GetColor(picture, 0.1, -0.6), glm::ivec4(0));
  EXPECT_EQ(GetColor(picture, 0.3, -0.6), glm::ivec4(255, 0, 0, 255));
  for (int x = 0; x < Size; ++x)
  {
    // The camera's rays are parallel to the plane: the cut is exact.
    const std::size_t pixel = std::size_t(Size) / 2 * Size + x;
    const double place = GetPlace(x);
    EXPECT_EQ(picture.Color[4 * pixel] == 255, place >= 0.2 && place <= 1.0) << place;
  }
}

TEST_F(MeshPicture, WhatIsClippedCastsNoShadow)
{
  rt::MeshObject floor = this->Publish(CreateSquare(-0.5));
  floor.Look.Surface.Lighting = true;
  rt::MeshObject roof =
    this->Publish(CreateSquare(0.5), glm::translate(glm::dmat4(1.0), glm::dvec3(1.0, 0.0, 0.0)));
  this->World.Lights.resize(1);
  this->World.Lights[0].Direction = glm::normalize(glm::dvec3(-1.0, 0.0, -1.0));
  this->World.Transport.Shadows = true;
  const int dark = GetColor(this->Trace({ floor, roof }), -0.5, 0.2).x;
  roof.Clipping.HalfSpaces = { { { 1.0, 0.0, 0.0 }, { 0.9, 0.0, 0.0 } } };
  const int lit = GetColor(this->Trace({ floor, roof }), -0.5, 0.2).x;
  EXPECT_EQ(dark, 0);
  EXPECT_NEAR(lit, 255.0 * std::sqrt(0.5), 1.0);
}

TEST_F(MeshPicture, EveryPixelIsThatOfTryingAllTriangles)
{
  const TestMesh::Mesh blob = TestMesh::CreateBlob(3);
  const rt::Picture picture = this->Trace({ this->Publish(blob) });
  int covered = 0;
  for (int y = 0; y < Size; ++y)
  {
    for (int x = 0; x < Size; ++x)
    {
      rt::Ray ray;
      ray.Origin = { GetPlace(x), GetPlace(y), 5.0 };
      ray.Direction = { 0.0, 0.0, -10.0 };
      ray.Max = 1.0;
      const TestMesh::Oracle hit = TestMesh::FindByTryingAll(blob, ray);
      EXPECT_NEAR(picture.Depth[y * Size + x], hit.Found ? hit.T : 1.0, 1e-6) << x << ", " << y;
      covered += hit.Found;
    }
  }
  EXPECT_GT(covered, Size * Size / 5);
}

TEST_F(MeshPicture, IsosurfacesAndMeshesHideOneAnother)
{
  const auto field = SphereScene::Publish(this->Messenger, this->Store);
  this->World = SphereScene::CreateScene(field, 1.0f);
  rt::LatticeIsosurface& ball = std::get<rt::LatticeIsosurface>(this->World.Objects.front());
  const double scale = 2.0 / (SphereScene::Points - 1);
  ball.Field.SetIndexToWorld(glm::translate(glm::dmat4(1.0), glm::dvec3(-1.0)) *
    glm::scale(glm::dmat4(1.0), glm::dvec3(scale)));
  ball.Isovalues = { 0.5 };
  ball.Look.Surface.Lighting = false;
  rt::MeshObject square = this->Publish(CreateSquare(0.0));
  square.Look.Surface.DiffuseColor = { 0.0f, 0.0f, 1.0f };
  const rt::Picture picture = this->Trace({ square });
  EXPECT_EQ(GetColor(picture, 0.0, 0.0), glm::ivec4(255)); // the ball's upper half
  EXPECT_EQ(GetColor(picture, 0.95, 0.95), glm::ivec4(0, 0, 255, 255));
  const rt::Picture under = this->Trace({ this->Publish(CreateSquare(-0.9)), square });
  EXPECT_EQ(picture.Color, under.Color);
}

TEST_F(MeshPicture, CullingAndTheColourOfTheBack)
{
  const glm::dmat4 turned =
    glm::rotate(glm::dmat4(1.0), glm::pi<double>(), glm::dvec3(0.0, 1.0, 0.0));
  for (const bool back : { false, true })
  {
    rt::MeshObject object = this->Publish(CreateSquare(0.0), back ? turned : glm::dmat4(1.0));
    object.Look.Surface.DiffuseColor = { 1.0f, 0.0f, 0.0f };
    EXPECT_EQ(GetColor(this->Trace({ object }), 0.1, 0.2), glm::ivec4(255, 0, 0, 255)) << back;
    object.Look.BackSurface = object.Look.Surface;
    object.Look.BackSurface->DiffuseColor = { 0.0f, 0.0f, 1.0f };
    EXPECT_EQ(GetColor(this->Trace({ object }), 0.1, 0.2),
      back ? glm::ivec4(0, 0, 255, 255) : glm::ivec4(255, 0, 0, 255));
    auto culled = std::make_shared<rt::MeshInstance>(*object.Instance);
    culled->Culling.Back = true;
    object.Instance = culled;
    EXPECT_EQ(GetColor(this->Trace({ object }), 0.1, 0.2),
      back ? glm::ivec4(0) : glm::ivec4(255, 0, 0, 255));
  }
}

TEST_F(MeshPicture, ColoursByTheirSource)
{
  rt::MeshObject object = this->Publish(CreateSquare(0.0));
  object.Look.Colors = CreateRainbow();
  object.Look.ColoredBy = rt::MeshLook::Coloring::Values;
  rt::Picture picture = this->Trace({ object });
  EXPECT_EQ(GetColor(picture, -0.8, 0.3), glm::ivec4(255, 0, 0, 255));
  EXPECT_EQ(GetColor(picture, 0.02, -0.4), glm::ivec4(0, 255, 0, 255));
  EXPECT_EQ(GetColor(picture, 0.8, 0.3), glm::ivec4(0, 0, 255, 255));

  object.Look.ColoredBy = rt::MeshLook::Coloring::CornerValues;
  picture = this->Trace({ object });
  const double part = (GetPlace(Size / 2) + 1.0) / 2.0; // of the way from red to blue
  const glm::ivec4 middle = GetColor(picture, 0.01, 0.3);
  EXPECT_NEAR(middle.x, 255.0 * (1.0 - part), 1.0);
  EXPECT_EQ(middle.y, 0);
  EXPECT_NEAR(middle.z, 255.0 * part, 1.0);

  object.Look.ColoredBy = rt::MeshLook::Coloring::Colors;
  picture = this->Trace({ object });
  EXPECT_NEAR(GetColor(picture, 0.01, 0.3).x, 255.0 * part, 1.0);
  EXPECT_EQ(GetColor(picture, 0.01, 0.3).z, 0);
}

TEST_F(MeshPicture, ATextureIsLaidOnByItsCoordinates)
{
  TestMesh::Mesh square = CreateSquare(0.0);
  square.TextureCoordinates = { 0, 0, 2, 0, 2, 1, 0, 1 };
  rt::MeshObject object = this->Publish(square);
  auto texture = std::make_shared<rt::Texture>();
  texture->Width = 2;
  texture->Height = 1;
  texture->Texels = { 255, 0, 0, 255, 0, 255, 0, 255 };
  object.Look.Picture = texture;
  rt::Picture picture = this->Trace({ object });
  EXPECT_EQ(GetColor(picture, -0.8, 0.1), glm::ivec4(255, 0, 0, 255));
  EXPECT_EQ(GetColor(picture, -0.3, 0.1), glm::ivec4(0, 255, 0, 255));
  EXPECT_EQ(GetColor(picture, 0.2, 0.1), glm::ivec4(255, 0, 0, 255)) << "repeated";
  texture->Repeat = false;
  EXPECT_EQ(GetColor(this->Trace({ object }), 0.2, 0.1), glm::ivec4(0, 255, 0, 255)) << "border";
  texture->Interpolate = true;
  const glm::ivec4 between = GetColor(this->Trace({ object }), -0.49, 0.1);
  EXPECT_NEAR(between.x, 127, 12);
  EXPECT_NEAR(between.x + between.y, 255, 1);
  texture->Interpolate = false;
  texture->Transform = glm::translate(glm::dmat4(1.0), glm::dvec3(0.5, 0.0, 0.0));
  EXPECT_EQ(GetColor(this->Trace({ object }), -0.8, 0.1), glm::ivec4(0, 255, 0, 255)) << "moved";
}

TEST_F(MeshPicture, EdgesAreDrawnWithoutTheDiagonal)
{
  TestMesh::Mesh square = CreateSquare(0.0);
  square.EdgeFlags = { 0b011, 0b110 };
  rt::MeshObject object = this->Publish(square);
  object.Look.Surface.DiffuseColor = { 0.0f, 1.0f, 0.0f };
  object.Look.Edges = rt::EdgeLines{ { 1.0f, 0.0f, 0.0f }, 3.0f };
  const rt::Picture picture = this->Trace({ object });
  const double pixel = 3.0 / Size;
  for (int y = 0; y < Size; ++y)
  {
    for (int x = 0; x < Size; ++x)
    {
      const double border = std::max(std::fabs(GetPlace(x)), std::fabs(GetPlace(y)));
      if (border < 1.0)
      {
        const double cover = std::clamp(2.0 - (1.0 - border) / pixel, 0.0, 1.0);
        const std::uint8_t* color = &picture.Color[4 * (y * Size + x)];
        EXPECT_NEAR(color[0], 255.0 * cover, 0.6) << x << ", " << y;
        EXPECT_NEAR(color[1], 255.0 * (1.0 - cover), 0.6) << x << ", " << y;
      }
    }
  }
}

TEST_F(MeshPicture, EdgesAreSeenInMirrorsAndPaintedOnThem)
{
  // Looked at from above, a mirror on a slant shows the square that stands beside it.
  TestMesh::Mesh square = CreateSquare(0.0);
  square.EdgeFlags = { 0b011, 0b110 };
  rt::MeshObject mirror = this->Publish(
    square, glm::rotate(glm::dmat4(1.0), -glm::quarter_pi<double>(), glm::dvec3(0.0, 1.0, 0.0)));
  mirror.Look.Surface.Reflectivity = 1.0f;
  mirror.Look.Edges = rt::EdgeLines{ { 0.0f, 0.0f, 1.0f }, 4.0f };
  const glm::dmat4 upright =
    glm::rotate(glm::translate(glm::dmat4(1.0), glm::dvec3(-2.0, 0.0, 0.0)), glm::half_pi<double>(),
      glm::dvec3(0.0, 1.0, 0.0));
  rt::MeshObject wall = this->Publish(square, glm::scale(upright, glm::dvec3(0.5)));
  wall.Look.Surface.DiffuseColor = { 0.0f, 1.0f, 0.0f };
  wall.Look.Edges = rt::EdgeLines{ { 1.0f, 0.0f, 0.0f }, 4.0f };
  const rt::Picture picture = this->Trace({ mirror, wall });
  const double pixel = 3.0 / Size;
  EXPECT_EQ(GetColor(picture, 0.1, 0.1), glm::ivec4(0, 255, 0, 255)) << "no diagonal";
  EXPECT_EQ(GetColor(picture, 0.1, 0.5 - 0.75 * pixel), glm::ivec4(255, 0, 0, 255));
  EXPECT_EQ(GetColor(picture, 0.5 - 0.75 * pixel, 0.1), glm::ivec4(255, 0, 0, 255));
  EXPECT_EQ(GetColor(picture, 0.1, 0.5 - 3.5 * pixel), glm::ivec4(0, 255, 0, 255));
  EXPECT_EQ(GetColor(picture, 0.1, 1.0 - 0.75 * pixel), glm::ivec4(0, 0, 255, 255));
}

TEST_F(MeshPicture, TwoTranslucentSquaresAndTheirCommonEdges)
{
  rt::MeshObject above = this->Publish(CreateSquare(0.5));
  rt::MeshObject below = this->Publish(CreateSquare(-0.5));
  above.Look.Surface.Opacity = below.Look.Surface.Opacity = 0.5f;
  const rt::Picture picture = this->Trace({ below, above });
  for (int y = 0; y < Size; ++y)
  {
    for (int x = 0; x < Size; ++x)
    {
      const bool inside = std::fabs(GetPlace(x)) < 1.0 && std::fabs(GetPlace(y)) < 1.0;
      // Also along the diagonal, where a ray meets two triangles of each square.
      EXPECT_EQ(picture.Color[4 * (y * Size + x) + 3], inside ? 191 : 0) << x << ", " << y;
    }
  }
}

TEST_F(MeshPicture, LayersAreWhatEachSurfaceContributes)
{
  std::vector<rt::MeshObject> squares;
  for (const double height : { -0.5, 0.5, 0.0 })
  {
    squares.push_back(this->Publish(CreateSquare(height)));
    squares.back().Look.Surface.Opacity = 0.5f;
  }
  squares[1].Clipping.HalfSpaces = { { { 1.0, 0.0, 0.0 }, glm::dvec3(0.0) } };
  this->Channels.Value = rt::ChannelSet::All;
  const auto trace = [&](int layers)
  {
    this->Layers = layers;
    return this->Trace(squares);
  };
  const rt::Picture whole = trace(1);
  const rt::Picture two = trace(2);
  const rt::Picture all = trace(8);
  ASSERT_EQ(two.Layers, 2);
  ASSERT_EQ(all.Layers, 3) << "those that show nothing are left out";
  const auto getAlpha = [](const rt::Picture& picture, int layer, int x)
  { return static_cast<int>(picture.Color[4 * (Size * (Size * layer + Size / 2) + x) + 3]); };
  const int left = Size / 3;
  const int right = Size - left;
  EXPECT_EQ(getAlpha(whole, 0, right), 223);
  EXPECT_EQ(getAlpha(all, 0, right), 128);
  EXPECT_EQ(getAlpha(all, 1, right), 64);
  EXPECT_EQ(getAlpha(all, 2, right), 32);
  EXPECT_EQ(getAlpha(all, 1, left), 64);
  EXPECT_EQ(getAlpha(all, 2, left), 0);
  EXPECT_EQ(getAlpha(two, 0, right), 128);
  EXPECT_EQ(getAlpha(two, 1, right), 96) << "the last layer stands for what is behind it";
  const auto getDepth = [](const rt::Picture& picture, int layer, int x)
  { return picture.Depth[Size * (Size * layer + Size / 2) + x]; };
  EXPECT_FLOAT_EQ(getDepth(all, 0, right), 0.45f);
  EXPECT_FLOAT_EQ(getDepth(all, 1, right), 0.5f);
  EXPECT_FLOAT_EQ(getDepth(all, 2, right), 0.55f);
  EXPECT_FLOAT_EQ(getDepth(all, 1, left), 0.55f);
  EXPECT_FLOAT_EQ(getDepth(all, 2, left), 1.0f);
  EXPECT_FLOAT_EQ(getDepth(two, 1, right), 0.5f);
  // Other channels are of the pixel, in the first layer.
  std::vector<std::int32_t> objects = whole.Object;
  objects.resize(3 * objects.size(), -1);
  EXPECT_EQ(all.Object, objects);
  std::vector<std::uint8_t> albedo = whole.Albedo;
  albedo.resize(3 * albedo.size(), 0);
  EXPECT_EQ(all.Albedo, albedo);
}

TEST_F(MeshPicture, BothSidesAreLitWhereverTheNormalsPoint)
{
  for (const double side : { 1.0, -1.0 })
  {
    for (const double points : { 1.0, -1.0 })
    {
      TestMesh::Mesh square = CreateSquare(0.0);
      for (int corner = 0; corner < 4; ++corner)
      {
        square.Normals.insert(square.Normals.end(), { 0.5f, 0.0f, static_cast<float>(points) });
      }
      rt::MeshObject object =
        this->Publish(square, glm::scale(glm::dmat4(1.0), glm::dvec3(1.0, side, side)));
      object.Look.Surface.Lighting = true;
      this->World.Lights.resize(1);
      EXPECT_NEAR(GetColor(this->Trace({ object }), 0.3, 0.2).x, 255.0 / std::sqrt(1.25), 1.5)
        << side << ", " << points;
    }
  }
}

TEST_F(MeshPicture, NormalsOfPointsOrOfPlanes)
{
  TestMesh::Mesh square = CreateSquare(0.0);
  square.Normals = { 1, 0, 1, 1, 0, 1, 1, 0, 1, 1, 0, 1 };
  rt::MeshObject object = this->Publish(square);
  object.Look.Surface.Lighting = true;
  this->World.Lights.emplace_back(); // along -z
  EXPECT_NEAR(GetColor(this->Trace({ object }), 0.3, 0.2).x, 255.0 * std::sqrt(0.5), 1.0);
  object.Look.Flat = true;
  EXPECT_EQ(GetColor(this->Trace({ object }), 0.3, 0.2).x, 255);
}

TEST_F(MeshPicture, NoSurfaceShadowsItself)
{
  for (const double farAway : { 0.0, 1e6 })
  {
    // A plane of many bricks, lit at a low angle: any shadow would be its own.
    TestMesh::Mesh plane = TestMesh::CreateTerrain(40);
    for (std::size_t z = 2; z < plane.Positions.size(); z += 3)
    {
      plane.Positions[z] = 0.0;
    }
    plane.Normals.clear();
    const glm::dvec3 center(farAway, -farAway, farAway);
    rt::MeshObject object = this->Publish(plane, glm::translate(glm::dmat4(1.0), center));
    object.Look.Surface.Lighting = true;
    this->World.Lights.resize(1);
    this->World.Lights[0].Direction = glm::normalize(glm::dvec3(1.0, 0.3, -0.02));
    this->World.Lights[0].Color = glm::vec3(40.0f);
    this->World.Transport.Shadows = true;
    this->World.Objects = { object };
    rt::FrameRequest request;
    request.Width = Size;
    request.Height = Size;
    request.WorldToClip = glm::ortho(0.0, 1.0, 0.0, 1.0, 0.0, 10.0) *
      glm::lookAt(center + glm::dvec3(0.0, 0.0, 5.0), center, glm::dvec3(0.0, 1.0, 0.0));
    rt::FrameRenderer renderer(this->Messenger);
    const rt::Picture picture =
      rt::GatherFrame(this->Messenger, renderer.Render(this->Store, this->World, request));
    int dark = 0;
    for (std::size_t pixel = 0; pixel < picture.Depth.size(); ++pixel)
    {
      dark += picture.Color[4 * pixel] < 150;
    }
    EXPECT_EQ(dark, 0) << farAway;
  }
}
