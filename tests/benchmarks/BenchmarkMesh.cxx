// SPDX-License-Identifier: BSD-3-Clause
#include "BenchmarkMesh.h"

#include "DSMBricks/build/PublishMesh.h"
#include "DSMBricks/build/TriangleBrickBuilder.h"
#include "DSMBricks/build/TriangleReader.h"

#include <glm/common.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace
{

MeshFile::Mesh CreateGrid(std::uint64_t n)
{
  MeshFile::Mesh mesh;
  for (std::uint64_t j = 0; j <= n; ++j)
  {
    for (std::uint64_t i = 0; i <= n; ++i)
    {
      const double x = static_cast<double>(i) / static_cast<double>(n);
      const double y = static_cast<double>(j) / static_cast<double>(n);
      const double z = 0.05 * std::sin(13.0 * x) * std::cos(11.0 * y) +
        0.01 * std::sin(97.0 * x + 1.0) * std::sin(89.0 * y);
      for (const double coordinate : { x, y, z })
      {
        mesh.Positions.push_back(static_cast<float>(coordinate));
      }
    }
  }
  for (std::uint64_t j = 0; j < n; ++j)
  {
    for (std::uint64_t i = 0; i < n; ++i)
    {
      const std::uint64_t p = i + j * (n + 1);
      mesh.Triangles.insert(mesh.Triangles.end(), { p, p + 1, p + n + 2, p, p + n + 2, p + n + 1 });
    }
  }
  return mesh;
}

/// A run of the triangles of a mesh.
class Slice final : public bricks::TriangleSource
{
public:
  Slice(const MeshFile::Mesh& mesh, std::uint64_t first, std::uint64_t last)
    : Mesh(mesh)
    , First(first)
    , Last(last)
  {
  }
  bricks::MeshAttributes GetAttributes() const override { return this->Mesh.GetAttributes(); }
  std::uint64_t GetTriangleCount() const override { return this->Last - this->First; }
  std::uint64_t GetPointCount() const override { return this->Mesh.GetPointCount(); }
  void GetTriangle(std::uint64_t triangle, std::uint64_t points[3]) const override
  {
    this->Mesh.GetTriangle(this->First + triangle, points);
  }
  void GetPosition(std::uint64_t point, double position[3]) const override
  {
    this->Mesh.GetPosition(point, position);
  }
  void GetNormal(std::uint64_t point, double normal[3]) const override
  {
    this->Mesh.GetNormal(point, normal);
  }
  double GetValue(std::uint64_t element) const override { return this->Mesh.GetValue(element); }
  void GetColor(std::uint64_t element, std::uint8_t rgba[4]) const override
  {
    this->Mesh.GetColor(element, rgba);
  }
  void GetTextureCoordinate(std::uint64_t point, double coordinate[2]) const override
  {
    this->Mesh.GetTextureCoordinate(point, coordinate);
  }
  unsigned GetEdgeFlags(std::uint64_t triangle) const override
  {
    return this->Mesh.GetEdgeFlags(this->First + triangle);
  }
  double GetRadius(std::uint64_t triangle, int corner) const override
  {
    return this->Mesh.GetRadius(this->First + triangle, corner);
  }

private:
  const MeshFile::Mesh& Mesh;
  std::uint64_t First;
  std::uint64_t Last;
};

} // namespace

BenchmarkMesh::BenchmarkMesh(const std::string& description, int subdivisions)
{
  const std::string grid = "grid:";
  this->Triangles = description.compare(0, grid.size(), grid) == 0
    ? CreateGrid(std::stoull(description.substr(grid.size())))
    : MeshFile::Read(description);
  this->Triangles = MeshFile::Subdivide(this->Triangles, subdivisions);
  MeshFile::AddNormals(this->Triangles);
  this->Triangles.Values.resize(this->Triangles.GetPointCount());
  for (std::uint64_t point = 0; point < this->Triangles.GetPointCount(); ++point)
  {
    this->Triangles.Values[point] = this->Triangles.Positions[3 * point + 2];
  }
}

std::shared_ptr<bricks::TriangleMesh> BenchmarkMesh::Publish(
  Order order, int threads, dsm::BlockStore& store, dsm::Messenger& messenger, double& seconds)
{
  const auto start = std::chrono::steady_clock::now();
  auto mesh = order == Order::Sorted || this->TrianglesPerBrick == 0
    ? this->PublishSorted(threads, store, messenger)
    : nullptr;
  if (mesh)
  {
    this->TrianglesPerBrick =
      std::max<std::uint64_t>(mesh->Triangles / mesh->Segment->GetDirectory().GetCount(), 1);
  }
  if (order != Order::Sorted)
  {
    if (mesh)
    {
      store.Retire(mesh->Segment);
    }
    mesh = this->PublishRuns(order == Order::Random, store, messenger);
  }
  seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return mesh;
}

std::shared_ptr<bricks::TriangleMesh> BenchmarkMesh::PublishSorted(
  int threads, dsm::BlockStore& store, dsm::Messenger& messenger) const
{
  const std::uint64_t count = this->Triangles.GetTriangleCount();
  const auto rank = static_cast<std::uint64_t>(messenger.GetRank());
  const auto ranks = static_cast<std::uint64_t>(messenger.GetSize());
  const Slice mine(this->Triangles, count * rank / ranks, count * (rank + 1) / ranks);
  bricks::TriangleMeshSettings settings;
  settings.Threads = threads;
  return bricks::PublishMesh("the mesh", mine, settings, store, messenger);
}

std::shared_ptr<bricks::TriangleMesh> BenchmarkMesh::PublishRuns(
  bool shuffled, dsm::BlockStore& store, dsm::Messenger& messenger) const
{
  std::vector<std::uint64_t> order(this->Triangles.GetTriangleCount());
  std::iota(order.begin(), order.end(), std::uint64_t(0));
  if (shuffled)
  {
    std::shuffle(order.begin(), order.end(), std::mt19937_64(1));
  }
  auto mesh = std::make_shared<bricks::TriangleMesh>();
  mesh->Attributes = this->Triangles.GetAttributes();
  mesh->Lower = glm::dvec3(std::numeric_limits<double>::infinity());
  mesh->Upper = -mesh->Lower;
  for (std::uint64_t point = 0; point < this->Triangles.GetPointCount(); ++point)
  {
    const float* p = &this->Triangles.Positions[3 * point];
    mesh->Lower = glm::min(mesh->Lower, glm::dvec3(p[0], p[1], p[2]));
    mesh->Upper = glm::max(mesh->Upper, glm::dvec3(p[0], p[1], p[2]));
  }
  const float lower[3] = { static_cast<float>(mesh->Lower.x), static_cast<float>(mesh->Lower.y),
    static_cast<float>(mesh->Lower.z) };
  const glm::dvec3 size = mesh->Upper - mesh->Lower;
  const bricks::MortonCode curve(lower, std::max({ size.x, size.y, size.z }));
  const bricks::TriangleReader reader(this->Triangles, mesh->Attributes);
  bricks::TriangleBrickBuilder builder(
    mesh->Attributes, curve, bricks::TriangleBrickHeader::LargestTriangles);
  const auto words = reader.GetKind().RecordBytes / sizeof(std::uint32_t);
  std::vector<std::uint32_t> records;
  std::vector<bricks::BoundingBox> boxes;
  std::vector<std::uint32_t> bytes;
  std::vector<dsm::Fragment> mine;
  const auto closeBrick = [&]
  {
    for (bricks::RecordBrick& brick : builder.Build(records.data(), records.size() / words))
    {
      if (bytes.size() % static_cast<std::size_t>(messenger.GetSize()) ==
        static_cast<std::size_t>(messenger.GetRank()))
      {
        mine.push_back({ bytes.size(), brick.Bytes });
      }
      boxes.push_back(brick.Bounds);
      bytes.push_back(static_cast<std::uint32_t>(brick.Bytes.size()));
    }
    records.clear();
  };
  for (const std::uint64_t triangle : order)
  {
    if (reader.FindCode(triangle, curve) == bricks::RecordReader::NoCode)
    {
      continue;
    }
    records.resize(records.size() + words);
    reader.ReadRecord(triangle, &records[records.size() - words]);
    ++mesh->Triangles;
    if (records.size() == words * this->TrianglesPerBrick)
    {
      closeBrick();
    }
  }
  if (!records.empty())
  {
    closeBrick();
  }
  mesh->Bricks = bricks::BrickBvh(boxes);
  bricks::BlockSource source(std::move(mine));
  bricks::BlockSink sink;
  mesh->Segment = store.Publish(
    "the mesh", { bytes, dsm::RoundRobinAssigner(messenger.GetSize()) }, source, sink);
  return mesh;
}
