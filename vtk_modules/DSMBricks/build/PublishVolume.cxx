// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/build/PublishVolume.h"

#include "DSMBricks/build/VoxelBrickBuilder.h"
#include "DSMCore/publish/ConcurrentFragmentSource.h"

#include <optional>
#include <utility>

namespace bricks
{

namespace
{

using PieceSources = std::vector<std::shared_ptr<const VoxelSource>>;

std::unique_ptr<dsm::FragmentSource> CutConcurrently(
  const BrickLattice& lattice, const PieceSources& pieces)
{
  std::vector<std::unique_ptr<dsm::FragmentSource>> sources;
  for (const auto& piece : pieces)
  {
    sources.push_back(std::make_unique<VoxelFragmentSource>(lattice, PieceSources{ piece }));
  }
  return std::make_unique<dsm::ConcurrentFragmentSource>(std::move(sources));
}

} // namespace

std::shared_ptr<VoxelField> PublishVolume(std::string_view what, const BrickLattice& lattice,
  const PieceSources& pieces, dsm::BlockStore& store, dsm::Messenger& messenger,
  const VolumeSettings& settings, dsm::FunctionRef<void(double)> progress)
{
  std::shared_ptr<VoxelField> field;
  std::optional<dsm::BlockDirectory> directory;
  std::unique_ptr<dsm::FragmentSource> fragments;
  std::optional<dsm::NotingFragmentSource> noting;
  std::optional<VoxelBrickSink> sink;
  messenger.RunTogether(what,
    [&]
    {
      field = std::make_shared<VoxelField>();
      field->Lattice = lattice;
      directory = lattice.CreateDirectory(messenger.GetSize());
      fragments = settings.IsConcurrent ? CutConcurrently(lattice, pieces)
                                        : std::make_unique<VoxelFragmentSource>(lattice, pieces);
      if (settings.Digests)
      {
        *settings.Digests = dsm::FragmentDigests(directory->GetCount());
        directory->AddIndexBytes(dsm::FragmentDigests::CountBytes(directory->GetCount()));
        noting.emplace(*fragments, *settings.Digests);
      }
      sink.emplace(lattice);
    });
  dsm::FragmentSource& source = noting ? static_cast<dsm::FragmentSource&>(*noting) : *fragments;
  field->Segment =
    store.Publish(what, std::move(*directory), source, *sink, progress, settings.Place);
  try
  {
    field->Hierarchy = MacrocellHierarchy(lattice, *field->Segment, messenger);
  }
  catch (...) // on every rank
  {
    store.Retire(field->Segment);
    throw;
  }
  return field;
}

} // namespace bricks
