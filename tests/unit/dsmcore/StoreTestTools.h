// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_test_StoreTestTools_h
#define dsm_test_StoreTestTools_h

#include "DSMCore/table/ObjectStore.h"
#include "tests/unit/dsmcore/RankGroup.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <vector>

namespace dsm_test
{

/// The byte that every test block has at a place; no two blocks are alike.
inline std::byte GetPattern(dsm::BlockId id, std::size_t place)
{
  std::uint64_t mix = (id + 1) * 0x9e3779b97f4a7c15u + place * 0xbf58476d1ce4e5b9u;
  mix ^= mix >> 29;
  return static_cast<std::byte>(mix & 255);
}

/// How the ranks share the work of producing the blocks' bytes.
enum class Spread
{
  EveryRankASlice, ///< each rank gives a part of every block
  OnlyRankZero,
  OnlyLastRank
};

/// Yields this rank's parts of the pattern, in pieces of at most `piece` bytes.
class PatternSource : public dsm::FragmentSource
{
public:
  PatternSource(
    const dsm::BlockDirectory& directory, int rank, int size, Spread spread, std::size_t piece)
    : Piece(piece)
  {
    for (dsm::BlockId id = 0; id < directory.GetCount(); ++id)
    {
      const std::uint64_t bytes = directory.GetBytes(id);
      std::uint64_t first = bytes * static_cast<std::uint64_t>(rank) / size;
      std::uint64_t last = bytes * static_cast<std::uint64_t>(rank + 1) / size;
      if (spread != Spread::EveryRankASlice)
      {
        const bool mine = rank == (spread == Spread::OnlyRankZero ? 0 : size - 1);
        first = 0;
        last = mine ? bytes : 0;
      }
      for (; first < last; first += this->Piece)
      {
        this->Parts.push_back({ id, first, std::min<std::uint64_t>(first + this->Piece, last) });
      }
    }
  }

  bool Next(dsm::Fragment& fragment) override
  {
    if (this->Index == this->Parts.size())
    {
      return false;
    }
    const Part& part = this->Parts[this->Index++];
    fragment.Block = part.Id;
    fragment.Bytes.resize(sizeof(std::uint64_t) + part.Last - part.First);
    std::memcpy(fragment.Bytes.data(), &part.First, sizeof(std::uint64_t));
    for (std::uint64_t place = part.First; place < part.Last; ++place)
    {
      fragment.Bytes[sizeof(std::uint64_t) + place - part.First] = GetPattern(part.Id, place);
    }
    return true;
  }

  double GetProgress() const override
  {
    return this->Parts.empty() ? 1.0 : double(this->Index) / double(this->Parts.size());
  }

private:
  struct Part
  {
    dsm::BlockId Id;
    std::uint64_t First;
    std::uint64_t Last;
  };
  std::size_t Piece;
  std::vector<Part> Parts;
  std::size_t Index = 0;
};

/// Puts the pieces together, and checks what the store promises to a sink.
class PatternSink : public dsm::FragmentSink
{
public:
  void Begin(dsm::BlockId id, std::byte* block, std::size_t bytes) override
  {
    EXPECT_TRUE(this->Begun.insert(id).second);
    EXPECT_TRUE(std::all_of(block, block + bytes, [](std::byte b) { return b == std::byte{ 0 }; }));
  }

  void Absorb(dsm::BlockId id, std::byte* block, std::size_t bytes, const std::byte* fragment,
    std::size_t fragmentBytes) override
  {
    EXPECT_EQ(this->Begun.count(id), 1u);
    EXPECT_TRUE(this->Finished.empty());
    std::uint64_t first = 0;
    std::memcpy(&first, fragment, sizeof(first));
    const std::size_t count = fragmentBytes - sizeof(first);
    if (first + count > bytes)
    {
      throw dsm::Error("a fragment does not fit its block");
    }
    std::copy_n(fragment + sizeof(first), count, block + first);
    this->Absorbed += count;
  }

  void Finish(dsm::BlockId id, std::byte*, std::size_t bytes) override
  {
    EXPECT_EQ(this->Begun.count(id), 1u);
    EXPECT_TRUE(this->Finished.insert(id).second);
    this->Expected += bytes;
  }

  std::set<dsm::BlockId> Begun;
  std::set<dsm::BlockId> Finished;
  std::uint64_t Absorbed = 0;
  std::uint64_t Expected = 0;
};

inline dsm::BlockDirectory MakeDirectory(int ranks, std::size_t count, std::uint32_t bytes)
{
  return dsm::BlockDirectory(
    std::vector<std::uint32_t>(count, bytes), dsm::RoundRobinAssigner(ranks));
}

template <class Store>
std::shared_ptr<dsm::BlockSegment> PublishPattern(dsm::Messenger& messenger, Store& store,
  const dsm::BlockDirectory& directory, Spread spread = Spread::EveryRankASlice,
  std::size_t piece = 1000)
{
  PatternSource source(directory, messenger.GetRank(), messenger.GetSize(), spread, piece);
  PatternSink sink;
  auto segment = store.Publish("Publishing the pattern", directory, source, sink);
  EXPECT_EQ(sink.Absorbed, sink.Expected);
  EXPECT_EQ(sink.Begun, sink.Finished);
  return segment;
}

/// Wrong bytes of a block, whole or sampled at its ends and in the middle.
inline std::size_t CountWrongBytes(dsm::BlockId id, const std::byte* block, std::size_t bytes)
{
  std::size_t wrong = 0;
  for (std::size_t place = 0; place < bytes; ++place)
  {
    wrong += block[place] != GetPattern(id, place) ? 1 : 0;
  }
  return wrong;
}

/// MakeDirectory for blocks that are read in pairs.
inline dsm::BlockDirectory MakePairedDirectory(int ranks, std::size_t count, std::uint32_t bytes)
{
  dsm::BlockDirectory directory = MakeDirectory(ranks, count, bytes);
  directory.SetPaired();
  return directory;
}

/// A frame as a renderer drives it: `trace` runs on a thread for each of the store's workers, this thread serves
/// until every rank's workers are done. What this thread comes upon cancels the frame on all ranks, what a worker
/// throws ends that worker; then every rank throws the same Error. `first` (may be empty) runs on this thread when
/// the frame has begun.
template <class Store>
void RunFrame(dsm::Messenger& messenger, Store& store,
  const std::function<void(typename Store::Worker&, int)>& trace,
  const std::function<void()>& first = {})
{
  store.BeginFrame();
  if (first)
  {
    first();
  }
  const int workers = store.GetSettings().Workers;
  std::atomic<int> running{ workers };
  std::vector<std::string> causes(static_cast<std::size_t>(workers));
  std::vector<std::thread> threads;
  for (int index = 0; index < workers; ++index)
  {
    threads.emplace_back(
      [&, index]
      {
        typename Store::Worker& worker = store.GetWorker(index);
        store.Enter(worker);
        try
        {
          trace(worker, index);
        }
        catch (const std::exception& exception)
        {
          causes[static_cast<std::size_t>(index)] = exception.what();
        }
        store.Leave(worker);
        --running;
        messenger.WakeUp();
      });
  }
  std::string cause;
  int finished = 0;
  bool told = false;
  messenger.SetHandler(dsm::MessageKind::FrameDone, [&](dsm::Message&&) { ++finished; });
  bool stopped = false; // by another rank's failure, which that rank reports
  messenger.SetHandler(dsm::MessageKind::FrameStop,
    [&](dsm::Message&&)
    {
      stopped = stopped || cause.empty();
      store.Cancel("another rank has failed");
    });
  const auto serve = [&]
  {
    bool any = store.Service();
    if (running == 0 && !told && store.Drain())
    {
      for (int rank = 0; rank < messenger.GetSize(); ++rank)
      {
        messenger.Post(rank, dsm::MessageKind::FrameDone, {});
      }
      told = true;
      any = true;
    }
    return any;
  };
  bool over = false;
  while (!over)
  {
    try
    {
      messenger.ProgressUntil([&] { return finished == messenger.GetSize(); }, serve);
      over = true;
    }
    catch (...) // a malformed message, no memory for a block, or a source that fails
    {
      if (cause.empty() && !stopped)
      {
        cause = dsm::Messenger::DescribeException();
        for (int rank = 0; rank < messenger.GetSize(); ++rank)
        {
          messenger.Post(rank, dsm::MessageKind::FrameStop, {});
        }
      }
      store.Cancel(cause);
    }
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  messenger.SetHandler(dsm::MessageKind::FrameDone, {});
  messenger.SetHandler(dsm::MessageKind::FrameStop, {});
  store.EndFrame();
  for (const std::string& text : causes)
  {
    cause = cause.empty() && !stopped ? text : cause;
  }
  messenger.RunTogether("The frame failed",
    [&]
    {
      if (!cause.empty())
      {
        throw dsm::Error(cause);
      }
    });
}

/// One worker's look at a block.
template <class Store>
std::size_t Visit(
  Store& store, typename Store::Worker& worker, const dsm::BlockSegment& segment, dsm::BlockId id)
{
  const typename Store::Pin pin = store.Acquire(worker, segment, id);
  EXPECT_EQ(pin.GetBytes(), segment.GetDirectory().GetBytes(id));
  return CountWrongBytes(id, pin.GetData(), pin.GetBytes());
}

} // namespace dsm_test

#endif
