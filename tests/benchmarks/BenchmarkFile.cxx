// SPDX-License-Identifier: BSD-3-Clause
#include "BenchmarkFile.h"

#include "DSMBricks/build/VoxelBrickReader.h"
#include "DSMBricks/build/VoxelIndex.h"
#include "DSMBricks/layout/DealBricks.h"
#include "DSMCore/base/Error.h"
#include "DSMCore/fetch/ReadingSource.h"
#include "DSMVolumeFiles/cache/FileBrickReader.h"
#include "DSMVolumeFiles/cache/FileSamples.h"
#include "DSMVolumeFiles/open/OpenVolumeFile.h"

#include <numeric>
#include <optional>

namespace
{

std::shared_ptr<const bricks::VoxelSource> GetSamples(
  const std::shared_ptr<const vol::VolumeFile>& file, bool scattered)
{
  return std::make_shared<vol::FileSamples>(
    vol::ArrayStep{ file, 0, 0 }, vol::ChunkCache::GetShared(), scattered);
}

bricks::VoxelIndex FindIndex(const std::shared_ptr<const vol::VolumeFile>& file,
  const bricks::BrickLattice& lattice, int threads, dsm::Messenger& messenger)
{
  std::optional<bricks::VoxelIndex> known;
  std::optional<bricks::VoxelBrickReader> reader;
  bricks::VoxelIndex::Pass pass;
  pass.Threads = threads;
  messenger.RunTogether("Reading the file's index",
    [&]
    {
      const vol::VolumeFile::Index index = file->ReadIndex(0, 0);
      if (index.BrickEdge == lattice.GetEdge())
      {
        known = bricks::VoxelIndex::Decode(index.Bricks, lattice.GetBrickCount());
      }
      reader.emplace(lattice, GetSamples(file, false));
      pass.Order.resize(lattice.GetBrickCount());
      std::iota(pass.Order.begin(), pass.Order.end(), dsm::BlockId(0));
    });
  return known ? std::move(*known)
               : bricks::VoxelIndex::Find(messenger, lattice, *reader, pass, {});
}

} // namespace

rt::LatticeIsosurface PublishBenchmarkFile(
  const std::string& path, int brickEdge, dsm::BlockStore& store, dsm::Messenger& messenger)
{
  auto field = std::make_shared<bricks::VoxelField>();
  std::shared_ptr<const vol::VolumeFile> file;
  std::shared_ptr<dsm::ReadingSource> source;
  std::optional<dsm::BlockDirectory> directory;
  rt::LatticeIsosurface object;
  messenger.RunTogether("Opening the volume's file",
    [&]
    {
      file = vol::OpenVolumeFile(path);
      const vol::FileArray& array = file->GetArrays().front();
      if (array.Components != 1 || array.OnCells)
      {
        throw dsm::Error("The first array of '" + path + "' is not one of numbers on points.");
      }
      const vol::FileGeometry& geometry = file->GetGeometry();
      field->Lattice = bricks::BrickLattice(geometry.Points, array.Type, /*cellMask=*/false,
        brickEdge > 0 ? brickEdge : bricks::BrickLattice::GetDefaultEdge(array.Type));
      glm::dmat4 indexToWorld(1.0);
      for (int axis = 0; axis < 3; ++axis)
      {
        indexToWorld[axis][axis] = geometry.Spacing[axis];
      }
      object.Field.SetIndexToWorld(indexToWorld);
      directory = field->Lattice.CreateDirectory(bricks::DealBricks(
        field->Lattice, array.Grid.ChunkSamples, bricks::Index3(0), messenger.GetSize()));
      source = std::make_shared<dsm::ReadingSource>(messenger,
        std::make_shared<vol::FileBrickReader>(field->Lattice, GetSamples(file, true),
          [file](const std::vector<bricks::Box>& boxes) {
            vol::ChunkCache::GetShared().Prefetch({ file, 0, 0 }, boxes);
          }),
        path);
    });
  field->Segment = store.Publish(path, *directory, source);
  bricks::VoxelIndex index =
    FindIndex(file, field->Lattice, store.GetSettings().Workers, messenger);
  field->Survey = index.Survey;
  field->Hierarchy = bricks::MacrocellHierarchy(field->Lattice, std::move(index.Bricks));
  object.Field.Voxels = field;
  // The first picture finds no chunks in memory, as if the index had been kept.
  vol::ChunkCache& chunks = vol::ChunkCache::GetShared();
  const std::size_t limit = chunks.GetLimit();
  chunks.SetLimit(0);
  chunks.SetLimit(limit);
  return object;
}
