// SPDX-License-Identifier: BSD-3-Clause
// From data to picture on 1 to 3 ranks, in every organization of memory: each allocation, mapping,
// protection of pages, thread and message of one rank fails in turn. All ranks end with one text, or with
// the picture; and the next time there is the right picture.
//
// Of very many, a part is tried, spread over all; with DSM_ALL_FAULTS=1 in the environment, every one.
#include "tests/faults/FailingTransport.h"
#include "tests/faults/FaultInjection.h"
#include "tests/support/MeshScene.h"
#include "tests/support/PictureHash.h"

#include "DSMCore/transport/LoopbackTransport.h"
#include "DSMRayTracing/frame/FrameGather.h"
#include "DSMRayTracing/frame/FrameRenderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

namespace
{

using Kind = FaultInjection::Kind;

constexpr std::chrono::seconds Patience(30);

const char* GetName(Kind kind)
{
  constexpr const char* names[] = { "Memory", "Mapping", "Protection", "Thread", "Message" };
  return names[static_cast<int>(kind)];
}

/// Where the threads of all ranks meet, without the messenger that is tested.
class Meeting
{
public:
  explicit Meeting(int size)
    : Size(size)
  {
  }
  void Wait()
  {
    std::unique_lock<std::mutex> lock(this->Guard);
    const int round = this->Round;
    if (++this->Here == this->Size)
    {
      this->Here = 0;
      ++this->Round;
      this->Changed.notify_all();
      return;
    }
    this->Changed.wait(lock, [&] { return this->Round != round; });
  }

private:
  int Size;
  int Here = 0;
  int Round = 0;
  std::mutex Guard;
  std::condition_variable Changed;
};

/// Ends the process when a rank waits for ever, and says after what.
class Watchdog
{
public:
  ~Watchdog()
  {
    {
      const std::lock_guard<std::mutex> lock(this->Guard);
      this->Ended = true;
    }
    this->Changed.notify_all();
    this->Thread.join();
  }
  void Begin(Kind kind, int rank, long fault)
  {
    {
      const std::lock_guard<std::mutex> lock(this->Guard);
      std::snprintf(
        this->What, sizeof(this->What), "%s %ld of rank %d", GetName(kind), fault, rank);
      ++this->Steps;
    }
    this->Changed.notify_all();
  }

private:
  void Watch()
  {
    std::unique_lock<std::mutex> lock(this->Guard);
    while (!this->Ended)
    {
      const long seen = this->Steps;
      if (!this->Changed.wait_for(
            lock, Patience, [&] { return this->Ended || this->Steps != seen; }))
      {
        std::fprintf(stderr, "A rank waits for ever after a fault: %s\n", this->What);
        std::abort();
      }
    }
  }

  std::mutex Guard;
  std::condition_variable Changed;
  bool Ended = false;
  long Steps = 0;
  char What[80] = "";
  std::thread Thread{ [this] { this->Watch(); } };
};

struct Keeping
{
  const char* Name;
  dsm::MemoryOrganization Organization;
  bool HostSharing;
};

/// One rank's part of what is published and traced again and again.
class Rank
{
public:
  Rank(std::unique_ptr<dsm::Transport> transport, const Keeping& keeping)
    : Messenger(std::make_unique<FailingTransport>(std::move(transport)))
    , Store(this->Messenger, CreateSettings(keeping))
    , Piece(TestMesh::TakePart(TestMesh::CreateBlob(2),
        static_cast<std::uint64_t>(this->Messenger.GetRank()),
        static_cast<std::uint64_t>(this->Messenger.GetSize()), 7))
  {
  }

  /// The picture's hash; 0, and why, when there is none.
  std::uint64_t Try(std::string& failure)
  {
    std::uint64_t hash = 0;
    const dsm::Status outcome = this->Messenger.RunStep([&] { hash = this->PublishAndTrace(); });
    failure = outcome.Cause;
    for (auto& segment : this->Segments)
    {
      this->Store.Retire(segment);
      segment.reset();
    }
    return hash;
  }

  /// Between attempts: threads start anew.
  void Renew() { this->Renderer = std::make_unique<rt::FrameRenderer>(this->Messenger); }

  dsm::Messenger Messenger;
  FaultInjection Faults;

private:
  /// What is taken in, made where the ranks agree.
  struct Input
  {
    explicit Input(const dsm::Messenger& messenger)
    {
      const int size = messenger.GetSize();
      const int rank = messenger.GetRank();
      const bricks::SampleVolume volume(bricks::SampleVolume::Kind::Sphere, bricks::Index3(Points));
      const bricks::Box cells{ { 0, 0, (Points - 1) * rank / size },
        { Points - 1, Points - 1, (Points - 1) * (rank + 1) / size } };
      this->Pieces.push_back(
        std::make_shared<bricks::SampleVolumeSource>(volume, cells, bricks::ScalarType::Float32));
    }
    static constexpr int Points = 20;
    const bricks::BrickLattice Lattice{ bricks::Index3(Points), bricks::ScalarType::Float32, false,
      4 };
    std::vector<std::shared_ptr<const bricks::VoxelSource>> Pieces;
  };

  static dsm::BlockStore::Settings CreateSettings(const Keeping& keeping)
  {
    dsm::BlockStore::Settings settings =
      SphereScene::CreateSettings(std::size_t(1) << 16, 2, keeping.Organization);
    settings.HostSharing = keeping.HostSharing;
    return settings;
  }

  std::uint64_t PublishAndTrace()
  {
    std::optional<Input> input;
    this->Messenger.RunTogether("Preparing", [&] { input.emplace(this->Messenger); });
    const auto field =
      bricks::PublishVolume("sphere", input->Lattice, input->Pieces, this->Store, this->Messenger);
    this->Segments[0] = field->Segment;

    bricks::TriangleMeshSettings settings;
    settings.BrickBytes = MeshScene::BrickBytes;
    settings.Threads = 2;
    const auto mesh =
      bricks::PublishMesh("mesh", this->Piece, settings, this->Store, this->Messenger);
    this->Segments[1] = mesh->Segment;
    rt::Scene scene;
    this->Messenger.RunTogether("Preparing the frame",
      [&]
      {
        scene = SphereScene::CreateScene(field, 0.7f);
        scene.Transport.Shadows = true;
        scene.Objects.emplace_back(rt::MeshObject());
        constexpr double middle = 0.5 * (Input::Points - 1);
        std::get<rt::MeshObject>(scene.Objects.back()).Instance =
          std::make_shared<rt::MeshInstance>(mesh,
            glm::scale(glm::translate(glm::dmat4(1.0), glm::dvec3(middle, middle, 2.0 * middle)),
              glm::dvec3(middle)));
      });
    const rt::Frame frame =
      this->Renderer->Render(this->Store, scene, SphereScene::CreateRequest(60, 40));
    return GetPictureHash(rt::GatherFrame(this->Messenger, frame));
  }

  dsm::BlockStore Store;
  TestMesh::Mesh Piece;
  std::shared_ptr<dsm::BlockSegment> Segments[2];
  std::unique_ptr<rt::FrameRenderer> Renderer;
};

class FrameFaults : public testing::TestWithParam<std::tuple<int, Keeping>>
{
};

INSTANTIATE_TEST_SUITE_P(Keepings, FrameFaults,
  testing::Combine(testing::Values(1, 3),
    testing::Values(Keeping{ "Automatic_shared", dsm::MemoryOrganization::Automatic, true },
      Keeping{ "Automatic", dsm::MemoryOrganization::Automatic, false },
      Keeping{ "Replicated", dsm::MemoryOrganization::Replicated, false },
      Keeping{ "Object_shared", dsm::MemoryOrganization::ObjectBased, true },
      Keeping{ "Object", dsm::MemoryOrganization::ObjectBased, false },
      Keeping{ "Page", dsm::MemoryOrganization::PageBased, false })),
  [](const auto& info)
  {
    return std::string(std::get<1>(info.param).Name) + "_" +
      std::to_string(std::get<0>(info.param));
  });

/// Of each kind, on each rank.
constexpr long MostFaults = 40;

long GetStride(long calls)
{
  return std::getenv("DSM_ALL_FAULTS") ? 1 : std::max(1L, calls / MostFaults);
}

TEST_P(FrameFaults, AreEverybodysAndTheNextFrameIsRight)
{
  const auto [ranks, keeping] = this->GetParam();
  Watchdog watchdog;
  Meeting meeting(ranks);
  std::vector<std::string> texts(static_cast<std::size_t>(ranks));
  std::vector<std::uint64_t> hashes(static_cast<std::size_t>(ranks));
  std::uint64_t expected = 0;
  std::atomic<long> calls{ 0 };
  std::atomic<bool> isReached{ false };
  long failures = 0;

  const auto compare = [&](const std::string& when, bool mayFail)
  {
    for (int rank = 0; rank < ranks; ++rank)
    {
      const auto index = static_cast<std::size_t>(rank);
      EXPECT_EQ(texts[index], texts[0]) << when << ", rank " << rank;
      EXPECT_TRUE(mayFail || texts[index].empty()) << when << ": " << texts[index];
      EXPECT_EQ(hashes[index], texts[index].empty() ? expected : 0u) << when << ", rank " << rank;
    }
    failures += texts[0].empty() ? 0 : 1;
  };

  const auto run = [&](std::unique_ptr<dsm::Transport> transport)
  {
    Rank self(std::move(transport), keeping);
    self.Faults.Join();
    const int own = self.Messenger.GetRank();
    const auto attempt = [&]
    {
      const auto index = static_cast<std::size_t>(own);
      hashes[index] = self.Try(texts[index]);
    };
    self.Renew();
    attempt();
    meeting.Wait();
    if (own == 0)
    {
      expected = hashes[0];
      EXPECT_NE(expected, 0u) << texts[0];
    }
    meeting.Wait();
    for (const Kind kind :
      { Kind::Memory, Kind::Mapping, Kind::Protection, Kind::Thread, Kind::Message })
    {
      for (const int victim : { 0, ranks - 1 })
      {
        long fault = -1; // the first time, they are counted
        bool isThrough = false;
        while (!isThrough)
        {
          self.Renew();
          meeting.Wait();
          if (own == 0)
          {
            watchdog.Begin(kind, victim, fault);
          }
          if (own == victim)
          {
            self.Faults.Arm(kind, fault < 0 ? std::numeric_limits<long>::max() : fault);
          }
          attempt();
          if (own == victim)
          {
            isReached = self.Faults.Disarm();
            calls = fault < 0 ? self.Faults.GetCalls() : calls.load();
          }
          meeting.Wait();
          const std::string when = std::string(GetName(kind)) + " " + std::to_string(fault) +
            " of " + std::to_string(calls) + " of rank " + std::to_string(victim);
          if (own == 0)
          {
            compare(when, fault >= 0);
          }
          meeting.Wait();
          if (fault >= 0)
          {
            attempt();
            meeting.Wait();
            if (own == 0)
            {
              compare("after " + when, false);
            }
          }
          const bool isFirst = fault < 0;
          fault = isFirst ? 0 : fault + GetStride(calls);
          isThrough = fault >= calls || (!isFirst && !isReached);
          meeting.Wait();
        }
      }
    }
    FaultInjection::Leave();
  };

  auto transports = dsm::LoopbackTransport::CreateGroup(ranks);
  std::vector<std::thread> threads;
  for (auto& transport : transports)
  {
    threads.emplace_back([&, own = std::move(transport)]() mutable { run(std::move(own)); });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  EXPECT_GT(failures, 5);
}

} // namespace
