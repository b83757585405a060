// SPDX-License-Identifier: BSD-3-Clause
// What the page store shares with the process: crashes, and its children.
#include "tests/unit/dsmcore/PagedStoreInProcess.h"

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <functional>

namespace
{

using dsm_test::Way;

/// Calls `step` on rank 0 of two, in an open frame and beside a thread that was served a fault.
/// Block 1 is the other rank's and was fetched, block 3 was not.
void InFrame(const Way& way,
  const std::function<void(dsm::PagedStore&, const dsm::BlockSegment&,
    const std::byte* (*)(dsm::PagedStore&, dsm::PagedStore::Worker&, const dsm::BlockSegment&,
      dsm::BlockId))>& step)
{
  dsm_test::RunRanks(2,
    [&](dsm::Messenger& messenger)
    {
      const auto locate = [](dsm::PagedStore& store, dsm::PagedStore::Worker& worker,
                            const dsm::BlockSegment& segment, dsm::BlockId id)
      { return store.Acquire(worker, segment, id).GetData(); };
      dsm::PagedStore store(messenger, way.GetSettings(1 << 20, 1));
      const auto segment =
        dsm_test::PublishPattern(messenger, store, dsm_test::MakeDirectory(2, 8, 5000));
      dsm_test::RunFrame(messenger, store,
        [&](dsm::PagedStore::Worker& worker, int)
        {
          EXPECT_EQ(dsm_test::Visit(store, worker, *segment, 0), 0u);
          EXPECT_EQ(dsm_test::Visit(store, worker, *segment, 1), 0u);
          if (messenger.GetRank() == 0)
          {
            step(store, *segment, locate);
          }
        });
    });
}

using dsm_test::Good;

class PagedStoreFaults : public dsm_test::PagedStoreInProcess
{
};

INSTANTIATE_TEST_SUITE_P(Ways, PagedStoreFaults, testing::ValuesIn(dsm_test::GetAllWays()),
  [](const testing::TestParamInfo<Way>& way) { return way.param.GetName(); });

TEST_P(PagedStoreFaults, WritingToABlockIsACrash)
{
  const auto check = [&]
  {
    std::signal(SIGSEGV, SIG_DFL);
    InFrame(this->GetParam(),
      [](dsm::PagedStore& store, const dsm::BlockSegment& segment, auto locate)
      {
        const std::byte* const block = locate(store, store.GetWorker(0), segment, 1);
        *const_cast<volatile std::byte*>(block) = std::byte{ 1 };
      });
    std::_Exit(EXIT_FAILURE);
  };
  EXPECT_EXIT(check(), testing::KilledBySignal(SIGSEGV), "");
}

TEST_P(PagedStoreFaults, WritingToAnOwnBlockIsACrash)
{
  const auto check = [&]
  {
    std::signal(SIGSEGV, SIG_DFL);
    InFrame(this->GetParam(),
      [](dsm::PagedStore& store, const dsm::BlockSegment& segment, auto locate)
      {
        const std::byte* const block = locate(store, store.GetWorker(0), segment, 0);
        *const_cast<volatile std::byte*>(block) = std::byte{ 1 };
      });
    std::_Exit(EXIT_FAILURE);
  };
  EXPECT_EXIT(check(), testing::KilledBySignal(SIGSEGV), "");
}

/// Where a block of the other rank of two lies, for blocks of two pages, four a rank; without asking
/// the store for it.
const std::byte* FindRemote(const dsm::BlockSegment& segment, int rank, dsm::BlockId id)
{
  const std::byte* mine = nullptr;
  segment.ForEachResident(
    [&](dsm::BlockId, const std::byte* block, std::size_t) { mine = mine ? mine : block; });
  const std::ptrdiff_t pages = static_cast<std::ptrdiff_t>(2 * (id / 2)) + (rank == 0 ? 8 : -8);
  return mine + pages * static_cast<std::ptrdiff_t>(dsm_test::GetPage());
}

void Touch(const std::byte* address)
{
  static_cast<void>(*const_cast<const volatile std::byte*>(address));
}

TEST_P(PagedStoreFaults, ReadingOutsideOfAFrameIsACrashNotAHang)
{
  const auto check = [&]
  {
    std::signal(SIGSEGV, SIG_DFL);
    dsm_test::RunRanks(2,
      [&](dsm::Messenger& messenger)
      {
        const int rank = messenger.GetRank();
        dsm::PagedStore store(messenger, this->GetParam().GetSettings(1 << 20));
        const auto segment =
          dsm_test::PublishPattern(messenger, store, dsm_test::MakeDirectory(2, 8, 5000));
        dsm_test::RunFrame(messenger, store, [](dsm::PagedStore::Worker&, int) {});
        // On a thread that would be served within a frame.
        std::thread([&] { Touch(FindRemote(*segment, rank, 3)); }).join();
        messenger.Barrier();
      });
    std::_Exit(EXIT_FAILURE);
  };
  EXPECT_EXIT(check(), testing::KilledBySignal(SIGSEGV), "");
}

TEST_P(PagedStoreFaults, CommunicationThreadThatFaultsIsACrashNotAHang)
{
  const auto check = [&]
  {
    std::signal(SIGSEGV, SIG_DFL);
    dsm_test::RunRanks(2,
      [&](dsm::Messenger& messenger)
      {
        dsm::PagedStore store(messenger, this->GetParam().GetSettings(1 << 20));
        const auto segment =
          dsm_test::PublishPattern(messenger, store, dsm_test::MakeDirectory(2, 8, 5000));
        dsm_test::RunFrame(
          messenger, store, [](dsm::PagedStore::Worker&, int) {},
          [&] { Touch(FindRemote(*segment, messenger.GetRank(), 3)); });
      });
    std::_Exit(EXIT_FAILURE);
  };
  EXPECT_EXIT(check(), testing::KilledBySignal(SIGSEGV), "");
}

TEST_P(PagedStoreFaults, ThreadThatDidNotEnterIsServedToo)
{
  dsm_test::RunRanks(2,
    [&](dsm::Messenger& messenger)
    {
      dsm::PagedStore store(messenger, this->GetParam().GetSettings(1 << 20, 1));
      const auto segment =
        dsm_test::PublishPattern(messenger, store, dsm_test::MakeDirectory(2, 8, 5000));
      const bool reads = messenger.GetRank() == 0;
      std::size_t wrong = 0;
      dsm_test::RunFrame(messenger, store,
        [&](dsm::PagedStore::Worker& worker, int)
        {
          wrong = dsm_test::Visit(store, worker, *segment, 0);
          if (reads)
          {
            wrong += dsm_test::Visit(store, worker, *segment, 1);
            std::thread(
              [&] { wrong += dsm_test::CountWrongBytes(5, FindRemote(*segment, 0, 5), 5000); })
              .join();
          }
        });
      EXPECT_EQ(wrong, 0u);
      EXPECT_EQ(store.GetCounters().Workers.Misses, reads ? 2u : 1u);
    });
}

TEST_P(PagedStoreFaults, ThreadThatBlocksTheSignalIsServed)
{
  dsm_test::RunRanks(2,
    [&](dsm::Messenger& messenger)
    {
      dsm::PagedStore store(messenger, this->GetParam().GetSettings(1 << 20));
      const auto segment =
        dsm_test::PublishPattern(messenger, store, dsm_test::MakeDirectory(2, 8, 5000));
      sigset_t all;
      sigset_t before;
      sigfillset(&all);
      pthread_sigmask(SIG_SETMASK, &all, &before); // inherited by the workers
      dsm_test::RunFrame(messenger, store,
        [&](dsm::PagedStore::Worker& worker, int)
        {
          for (dsm::BlockId id = 0; id < 8; ++id)
          {
            EXPECT_EQ(dsm_test::Visit(store, worker, *segment, id), 0u);
          }
        });
      pthread_sigmask(SIG_SETMASK, &before, nullptr);
    });
}

/// What a child does with the store: what this rank owns can be read, the rest is a crash, and
/// nothing that it does reaches the parent.
TEST_P(PagedStoreFaults, ForkLeavesTheParentAlone)
{
  const Way way = this->GetParam();
  dsm_test::RunRanks(2,
    [&](dsm::Messenger& messenger)
    {
      const int rank = messenger.GetRank();
      const dsm::BlockId own = static_cast<dsm::BlockId>(rank);
      const dsm::BlockId other = 1 - own;
      auto store = std::make_unique<dsm::PagedStore>(messenger, way.GetSettings(1 << 20));
      auto segment =
        dsm_test::PublishPattern(messenger, *store, dsm_test::MakeDirectory(2, 8, 5000));
      const std::byte* mine = nullptr;
      const std::byte* theirs = nullptr;
      dsm_test::RunFrame(messenger, *store,
        [&](dsm::PagedStore::Worker& worker, int)
        {
          mine = store->Acquire(worker, *segment, own).GetData();
          theirs = store->Acquire(worker, *segment, other).GetData();
          EXPECT_EQ(dsm_test::Visit(*store, worker, *segment, other), 0u);
        });
      messenger.Barrier();
      if (rank == 0)
      {
        const pid_t reader = fork();
        if (reader == 0)
        {
          std::signal(SIGSEGV, SIG_DFL);
          if (dsm_test::CountWrongBytes(own, mine, 5000) == 0)
          {
            Touch(theirs);
          }
          std::_Exit(EXIT_FAILURE);
        }
        const pid_t destroyer = fork();
        if (destroyer == 0)
        {
          // Cleans up as a process that ends would.
          store->Retire(segment);
          segment.reset();
          store.reset();
          std::_Exit(Good);
        }
        int status = 0;
        EXPECT_EQ(waitpid(reader, &status, 0), reader);
        EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGSEGV) << status;
        EXPECT_EQ(waitpid(destroyer, &status, 0), destroyer);
        EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == Good) << status;
      }
      messenger.Barrier();
      dsm_test::RunFrame(messenger, *store,
        [&](dsm::PagedStore::Worker& worker, int)
        {
          for (dsm::BlockId id = 0; id < 8; ++id)
          {
            EXPECT_EQ(dsm_test::Visit(*store, worker, *segment, id), 0u);
          }
        });
      EXPECT_EQ(store->GetCounters().Workers.Misses, 3u); // one of four was here
    });
}

TEST_P(PagedStoreFaults, ChildThatGoesOnWithTheStoreIsTold)
{
  dsm_test::RunRanks(1,
    [&](dsm::Messenger& messenger)
    {
      dsm::PagedStore store(messenger, this->GetParam().GetSettings(1 << 20));
      const pid_t child = fork();
      if (child == 0)
      {
        const std::string text = dsm_test::GetErrorText([&] { store.BeginFrame(); });
        std::_Exit(text.find("forked process") != std::string::npos ? Good : EXIT_FAILURE);
      }
      int status = 0;
      EXPECT_EQ(waitpid(child, &status, 0), child);
      EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == Good) << status;
    });
}

} // namespace
