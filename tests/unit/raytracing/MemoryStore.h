// SPDX-License-Identifier: BSD-3-Clause
#ifndef tests_MemoryStore_h
#define tests_MemoryStore_h

#include "DSMCore/base/FunctionRef.h"
#include "DSMCore/publish/BlockSegment.h"
#include "DSMCore/publish/Publication.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <vector>

/// Blocks in this process's memory, with the members that the tracer wants of a store. Fails the
/// test when a worker acquires a block while it holds another.
class MemoryStore
{
public:
  struct Worker
  {
    int Pins = 0;
    int Accesses = 0;
  };

  class Pin
  {
  public:
    Pin(const std::byte* data, Worker& holder)
      : Data(data)
      , Holder(holder)
    {
      ++holder.Pins;
    }
    Pin(const Pin&) = delete;
    Pin& operator=(const Pin&) = delete;
    ~Pin() { --this->Holder.Pins; }
    const std::byte* GetData() const { return this->Data; }

  private:
    const std::byte* Data;
    Worker& Holder;
  };

  class Segment final : public dsm::BlockSegment
  {
  public:
    explicit Segment(dsm::BlockDirectory directory)
      : BlockSegment(0, std::move(directory))
    {
      for (dsm::BlockId id = 0; id < this->GetDirectory().GetCount(); ++id)
      {
        this->Blocks.emplace_back((this->GetDirectory().GetBytes(id) + 63) / 64);
      }
    }
    std::byte* GetBlock(dsm::BlockId id)
    {
      return reinterpret_cast<std::byte*>(this->Blocks[id].data());
    }
    const std::byte* GetBlock(dsm::BlockId id) const
    {
      return reinterpret_cast<const std::byte*>(this->Blocks[id].data());
    }
    void ForEachResident(const Visit& visit) const override
    {
      for (dsm::BlockId id = 0; id < this->Blocks.size(); ++id)
      {
        visit(id, this->GetBlock(id), this->GetDirectory().GetBytes(id));
      }
    }
    std::uint64_t GetResidentBytes() const override { return this->GetDirectory().GetTotalBytes(); }
    std::byte* GetOwned(dsm::BlockId) const override { return nullptr; }
    void Seal() override {}

  private:
    struct alignas(64) Chunk
    {
      std::byte Bytes[64] = {};
    };
    std::vector<std::vector<Chunk>> Blocks;
  };

  std::shared_ptr<Segment> Publish(
    dsm::BlockDirectory directory, dsm::FragmentSource& source, dsm::FragmentSink& sink)
  {
    const auto segment = std::make_shared<Segment>(std::move(directory));
    const dsm::BlockDirectory& sizes = segment->GetDirectory();
    for (dsm::BlockId id = 0; id < sizes.GetCount(); ++id)
    {
      sink.Begin(id, segment->GetBlock(id), sizes.GetBytes(id));
    }
    dsm::Fragment fragment;
    while (source.Next(fragment))
    {
      sink.Absorb(fragment.Block, segment->GetBlock(fragment.Block), sizes.GetBytes(fragment.Block),
        fragment.Bytes.data(), fragment.Bytes.size());
    }
    for (dsm::BlockId id = 0; id < sizes.GetCount(); ++id)
    {
      sink.Finish(id, segment->GetBlock(id), sizes.GetBytes(id));
    }
    return segment;
  }

  /// Says that none was absent.
  bool Prefetch(const dsm::BlockSegment&, const dsm::BlockId* ids, std::size_t count,
    dsm::FunctionRef<void(dsm::BlockId, std::vector<dsm::BlockId>&)> addNeighbors)
  {
    this->Prefetched.assign(ids, ids + count);
    this->Neighbors.clear();
    std::for_each(ids, ids + count, [&](dsm::BlockId id) { addNeighbors(id, this->Neighbors); });
    return false;
  }

  std::vector<dsm::BlockId> Prefetched; ///< last
  std::vector<dsm::BlockId> Neighbors;  ///< of these

  Pin Acquire(Worker& worker, const dsm::BlockSegment& segment, dsm::BlockId id)
  {
    if (worker.Pins != 0)
    {
      throw std::logic_error("a pin is held while another block is acquired");
    }
    ++worker.Accesses;
    return Pin(static_cast<const Segment&>(segment).GetBlock(id), worker);
  }
};

#endif
