// SPDX-License-Identifier: BSD-3-Clause
// The system refuses memory, or a thread, where a block is taken in, asked for, or produced: the frame or
// the publication fails on every rank, and the next one is as good as new.
#include "DSMCore/publish/ConcurrentFragmentSource.h"

#include "tests/unit/dsmcore/FailingCalls.h"
#include "tests/unit/dsmcore/PagedStoreInProcess.h"
#include "tests/unit/dsmcore/SharingScenarios.h"
#include "tests/unit/dsmcore/StoreScenarios.h"

#include <pthread.h>
#include <sys/resource.h>

#include <atomic>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace
{

using dsm_test::Call;
using dsm_test::FailingCall;
using dsm_test::Way;

/// A frame in which rank 0 reads a block of rank 1, and `call` fails; then one in which it does not.
template <class Store>
void FailOnce(dsm::Messenger& messenger, Store& store, Call call, FailingCall::Of threads)
{
  FailingCall::SpareThisThread();
  const auto directory = dsm_test::MakeDirectory(2, 8, 5000);
  const auto segment = dsm_test::PublishPattern(messenger, store, directory);
  std::unique_ptr<FailingCall> failure;
  std::size_t wrong = 0;
  const auto look = [&](typename Store::Worker& worker, int)
  {
    FailingCall::SpareThisThread();
    if (messenger.GetRank() == 0)
    {
      wrong = dsm_test::Visit(store, worker, *segment, 1);
    }
  };
  const std::string text = dsm_test::GetErrorText(
    [&]
    {
      dsm_test::RunFrame<Store>(messenger, store, look,
        [&]
        {
          messenger.Barrier(); // nobody else is at it
          if (messenger.GetRank() == 0)
          {
            failure = std::make_unique<FailingCall>(call, threads);
          }
        });
    });
  EXPECT_EQ(text.find("The frame failed: Rank 0: "), 0u) << text;
  EXPECT_NE(text.find("memory"), std::string::npos) << text;
  EXPECT_TRUE(FailingCall::HasHappened());
  messenger.Barrier();
  failure.reset();
  EXPECT_EQ(store.GetCounters().CachedBytes, 0u) << "no room stays set aside";
  dsm_test::RunFrame<Store>(messenger, store, look);
  EXPECT_EQ(wrong, 0u);
  store.Retire(segment);
}

TEST(ObjectStoreMemoryShortage, BlockThatFindsNoMemoryFailsTheFrameOnly)
{
  dsm_test::RunRanks(2,
    [](dsm::Messenger& messenger)
    {
      dsm::ObjectStore store(messenger, dsm_test::MakeSettings(5056)); // of the cache: one block
      FailOnce(messenger, store, Call::Map, FailingCall::Of::AnyThread);
    });
}

class PagedMemoryShortage : public dsm_test::PagedStoreInProcess
{
};

INSTANTIATE_TEST_SUITE_P(Ways, PagedMemoryShortage, testing::ValuesIn(dsm_test::GetAllWays()),
  [](const testing::TestParamInfo<Way>& way) { return way.param.GetName(); });

TEST_P(PagedMemoryShortage, PagesThatCannotBeFilledFailTheFrameOnly)
{
  dsm_test::RunRanks(2,
    [&](dsm::Messenger& messenger)
    {
      dsm::PagedStore store(messenger, this->GetParam().GetSettings(2 * dsm_test::GetPage()));
      FailOnce(messenger, store, Call::FillPages, FailingCall::Of::AnyThread);
    });
}

/// A worker's fault is queued by the listening thread, which needs memory for it.
TEST_P(PagedMemoryShortage, ListenerWithoutMemoryFailsTheFrameOnly)
{
  if (!this->GetParam().PureFaulting)
  {
    GTEST_SKIP() << "a worker that asks first does not fault";
  }
  dsm_test::RunRanks(2,
    [&](dsm::Messenger& messenger)
    {
      dsm::PagedStore store(messenger, this->GetParam().GetSettings(2 * dsm_test::GetPage()));
      FailOnce(messenger, store, Call::Allocate, FailingCall::Of::ThreadsNotSpared);
    });
}

// -- Publishing ------------------------------------------------------------------------------------

/// Publishes many small blocks, whose tables are large, and a few large ones, whose fragments are;
/// `before` right before it. The text of what that throws, if anything.
std::string Publish(
  dsm::Messenger& messenger, dsm::BlockStore& store, std::shared_ptr<dsm::BlockSegment>& segment,
  const std::function<void()>& before = [] {})
{
  std::vector<std::uint32_t> bytes(1100, 20);
  bytes.insert(bytes.end(), 6, 5 * dsm_test::LargeBytes);
  dsm::BlockDirectory directory(std::move(bytes), dsm::RoundRobinAssigner(messenger.GetSize()));
  dsm_test::PatternSource source(directory, messenger.GetRank(), messenger.GetSize(),
    dsm_test::Spread::EveryRankASlice, dsm_test::LargeBytes);
  dsm_test::PatternSink sink;
  try
  {
    before();
    segment = store.Publish("Loading", std::move(directory), source, sink);
    return {};
  }
  catch (const dsm::Error& error)
  {
    return error.what();
  }
}

/// Whether the last rank ran out of memory when it published for the first time, `passed` of its larger
/// allocations having succeeded.
bool FailsOnce(int ranks, dsm::MemoryOrganization organization, bool sharing, int passed)
{
  std::atomic<bool> happened{ false };
  dsm_test::RunRanks(ranks,
    [&](dsm::Messenger& messenger)
    {
      dsm::BlockStore store(
        messenger, dsm_test::MakeStoreSettings(organization, std::size_t(1) << 24, sharing));
      std::shared_ptr<dsm::BlockSegment> segment;
      messenger.GetHosts(); // found out once
      std::string text;
      {
        std::unique_ptr<FailingCall> failure;
        text = Publish(messenger, store, segment,
          [&]
          {
            if (messenger.GetRank() == ranks - 1)
            {
              failure = std::make_unique<FailingCall>(
                Call::AllocateMuch, FailingCall::Of::ThisThread, passed);
            }
          });
        if (failure && FailingCall::HasHappened())
        {
          happened = true; // the other ranks must not write what they read before
        }
      }
      // One text on all ranks, or none.
      const dsm::Status status = messenger.Agree(text);
      EXPECT_TRUE(status.IsOk() || status.IsEverywhere) << passed << ": " << text;
      if (!text.empty())
      {
        EXPECT_NE(text.find("out of memory"), std::string::npos) << passed << ": " << text;
        EXPECT_EQ(store.GetCounters().ResidentBytes, 0u) << "a failed publication leaves nothing";
        EXPECT_EQ(Publish(messenger, store, segment), "") << passed;
      }
      dsm_test::ReadEverything(messenger, store, *segment);
      store.Retire(segment);
    });
  return happened;
}

class PublishingMemoryShortage
  : public testing::TestWithParam<std::tuple<int, dsm::MemoryOrganization, bool>>
{
};

INSTANTIATE_TEST_SUITE_P(Stores, PublishingMemoryShortage,
  testing::Combine(testing::Values(1, 3),
    testing::Values(dsm::MemoryOrganization::Automatic, dsm::MemoryOrganization::Replicated,
      dsm::MemoryOrganization::ObjectBased, dsm::MemoryOrganization::PageBased),
    testing::Bool()));

/// Every larger allocation in turn: all ranks publish, or none does, and nobody waits for ever.
TEST_P(PublishingMemoryShortage, FailsEverywhereAndTheNextWorks)
{
  const auto [ranks, organization, sharing] = this->GetParam();
  int passed = 0;
  while (FailsOnce(ranks, organization, sharing, passed))
  {
    ++passed;
  }
  // Files that are read on the way do not count: with some libraries their buffers are not of operator new.
  EXPECT_GT(passed, 12) << "there is something to fail";
}

/// Yields `count` empty fragments.
class CountingSource final : public dsm::FragmentSource
{
public:
  bool Next(dsm::Fragment& fragment) override
  {
    fragment.Block = 0;
    fragment.Bytes.clear();
    return --this->Left >= 0;
  }
  double GetProgress() const override { return 0.5; }

private:
  int Left = 100;
};

TEST(ConcurrentFragmentSource, ThreadThatCannotBeStartedIsAnErrorOfNext)
{
  if (dsm_test::HasSanitizer)
  {
    GTEST_SKIP() << "a sanitizer takes more addresses than any limit leaves";
  }
  GTEST_FLAG_SET(death_test_style, "fast");
  const auto check = []
  {
    // Room for the stack of one thread, not of two.
    constexpr std::size_t stack = std::size_t(1) << 30;
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes, stack);
    pthread_setattr_default_np(&attributes);
    pthread_attr_destroy(&attributes);
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    rlimit limit{};
    limit.rlim_cur = limit.rlim_max = (pages * dsm_test::GetPage()) + stack + stack / 2;
    setrlimit(RLIMIT_AS, &limit);

    std::vector<std::unique_ptr<dsm::FragmentSource>> sources;
    sources.push_back(std::make_unique<CountingSource>());
    sources.push_back(std::make_unique<CountingSource>());
    dsm::ConcurrentFragmentSource source(std::move(sources));
    dsm::Fragment fragment;
    const std::string text = dsm_test::GetErrorText([&] { source.Next(fragment); });
    EXPECT_NE(text.find("Cannot start a thread"), std::string::npos) << text;
  };
  EXPECT_EXIT(dsm_test::RunAndExit(check), testing::ExitedWithCode(dsm_test::Good), "");
}

} // namespace
