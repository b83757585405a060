// SPDX-License-Identifier: BSD-3-Clause
// What the page store shares with the process: the signal, its children, its limits.
#include "DSMCore/PagedStore.h"

#include "tests/unit/dsmcore/PagedScenarios.h"

#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>

namespace
{

using dsm_test::Way;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool HasSanitizer = true;
#else
constexpr bool HasSanitizer = false;
#endif

constexpr int Good = 7;

/// In a death test: runs `check`, and ends the process with Good when nothing failed in it.
void RunAndExit(const std::function<void()>& check)
{
  check();
  std::fflush(nullptr);
  std::_Exit(testing::Test::HasFailure() ? EXIT_FAILURE : Good);
}

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

class PagedStoreInProcess : public testing::TestWithParam<Way>
{
protected:
  void SetUp() override
  {
    GTEST_FLAG_SET(death_test_style, "fast");
    const std::string refusal = this->GetParam().GetRefusal();
    if (!refusal.empty())
    {
      GTEST_SKIP() << refusal;
    }
  }
};

INSTANTIATE_TEST_SUITE_P(Ways, PagedStoreInProcess, testing::ValuesIn(dsm_test::GetAllWays()),
  [](const testing::TestParamInfo<Way>& way) { return way.param.GetName(); });

void DereferenceNull()
{
  static volatile int* volatile nowhere = nullptr; // the compiler must not know better
  *nowhere = 1;
}

/// Ends the process as a debugger's or a logger's would, if it is called as it should be.
void ExitGood(int number, siginfo_t* info, void*)
{
  std::_Exit(number == SIGSEGV && info->si_addr == nullptr ? Good : EXIT_FAILURE);
}

void SetAction(void (*handler)(int, siginfo_t*, void*))
{
  struct sigaction action
  {
  };
  action.sa_sigaction = handler;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGSEGV, &action, nullptr);
}

using Step = void (*)();
void CrashInFrame(const Way& way, Step before, Step inFrame)
{
  before();
  InFrame(way, [&](auto&, const auto&, auto) { inFrame(); });
  std::_Exit(EXIT_FAILURE); // survived
}

TEST_P(PagedStoreInProcess, RealCrashIsTheDefaultAction)
{
  EXPECT_EXIT(CrashInFrame(
                this->GetParam(), [] { std::signal(SIGSEGV, SIG_DFL); }, DereferenceNull),
    testing::KilledBySignal(SIGSEGV), "");
}

TEST_P(PagedStoreInProcess, RealCrashCannotBeIgnored)
{
  EXPECT_EXIT(CrashInFrame(
                this->GetParam(), [] { std::signal(SIGSEGV, SIG_IGN); }, DereferenceNull),
    testing::KilledBySignal(SIGSEGV), "");
}

TEST_P(PagedStoreInProcess, SignalThatSomebodySendsEndsTheProcess)
{
  EXPECT_EXIT(CrashInFrame(
                this->GetParam(), [] { std::signal(SIGSEGV, SIG_DFL); },
                []
                {
                  raise(SIGSEGV);
                  pause();
                }),
    testing::KilledBySignal(SIGSEGV), "");
}

TEST_P(PagedStoreInProcess, HandlerOfTheApplicationGetsTheCrash)
{
  EXPECT_EXIT(CrashInFrame(
                this->GetParam(), [] { SetAction(ExitGood); }, DereferenceNull),
    testing::ExitedWithCode(Good), "");
}

/// Set when the store's was there; the next frame must work, and the crash must still be theirs.
TEST_P(PagedStoreInProcess, HandlerThatIsSetLaterGetsTheCrashButNotTheFaults)
{
  const Way way = this->GetParam();
  const auto check = [&]
  {
    dsm_test::RunRanks(2,
      [&](dsm::Messenger& messenger)
      {
        dsm::PagedStore store(messenger, way.GetSettings(1 << 20));
        const auto segment =
          dsm_test::PublishPattern(messenger, store, dsm_test::MakeDirectory(2, 8, 5000));
        messenger.Barrier();
        SetAction(ExitGood);
        messenger.Barrier();
        dsm_test::RunFrame(messenger, store,
          [&](dsm::PagedStore::Worker& worker, int)
          {
            for (dsm::BlockId id = 0; id < 8; ++id)
            {
              EXPECT_EQ(dsm_test::Visit(store, worker, *segment, id), 0u);
            }
          });
        if (testing::Test::HasFailure())
        {
          std::_Exit(EXIT_FAILURE);
        }
        DereferenceNull();
      });
  };
  EXPECT_EXIT(check(), testing::ExitedWithCode(Good), "");
}

struct sigaction ActionBeforeCircle;
volatile sig_atomic_t CircleCalls = 0;

/// Passes on to whom it found, which may be our handler.
void PassOnInCircle(int number, siginfo_t* info, void* context)
{
  ++CircleCalls;
  if (CircleCalls > 3)
  {
    std::_Exit(EXIT_FAILURE);
  }
  if ((ActionBeforeCircle.sa_flags & SA_SIGINFO) != 0)
  {
    ActionBeforeCircle.sa_sigaction(number, info, context);
  }
  else
  {
    std::signal(SIGSEGV, SIG_DFL);
  }
}

TEST_P(PagedStoreInProcess, HandlersThatPassOnInACircleEndInTheFirstOne)
{
  const Way way = this->GetParam();
  const auto check = [&]
  {
    SetAction(ExitGood);
    dsm_test::RunRanks(2,
      [&](dsm::Messenger& messenger)
      {
        dsm::PagedStore store(messenger, way.GetSettings(1 << 20));
        const auto segment =
          dsm_test::PublishPattern(messenger, store, dsm_test::MakeDirectory(2, 8, 5000));
        messenger.Barrier();
        if (messenger.GetRank() == 0)
        {
          sigaction(SIGSEGV, nullptr, &ActionBeforeCircle);
          SetAction(PassOnInCircle);
        }
        messenger.Barrier();
        dsm_test::RunFrame(messenger, store,
          [&](dsm::PagedStore::Worker& worker, int)
          { EXPECT_EQ(dsm_test::Visit(store, worker, *segment, 1), 0u); });
        messenger.Barrier();
        if (messenger.GetRank() == 0)
        {
          CircleCalls = 0;
          DereferenceNull();
        }
        messenger.Barrier();
      });
  };
  EXPECT_EXIT(check(), testing::ExitedWithCode(Good), "");
}

TEST_P(PagedStoreInProcess, HandlerIsPutBackWhenTheStoreGoes)
{
  struct sigaction before
  {
  };
  sigaction(SIGSEGV, nullptr, &before);
  InFrame(this->GetParam(), [](auto&, const auto&, auto) {});
  struct sigaction after
  {
  };
  sigaction(SIGSEGV, nullptr, &after);
  EXPECT_EQ(before.sa_sigaction, after.sa_sigaction);
}

TEST_P(PagedStoreInProcess, WritingToABlockIsACrash)
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

TEST_P(PagedStoreInProcess, WritingToAnOwnBlockIsACrash)
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

TEST_P(PagedStoreInProcess, ReadingOutsideOfAFrameIsACrashNotAHang)
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

TEST_P(PagedStoreInProcess, CommunicationThreadThatFaultsIsACrashNotAHang)
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

TEST_P(PagedStoreInProcess, ThreadThatDidNotEnterIsServedToo)
{
  InFrame(this->GetParam(),
    [](dsm::PagedStore& store, const dsm::BlockSegment& segment, auto)
    {
      std::size_t wrong = 1;
      std::thread([&] { wrong = dsm_test::CountWrongBytes(5, FindRemote(segment, 0, 5), 5000); })
        .join();
      EXPECT_EQ(wrong, 0u);
      EXPECT_EQ(store.GetCounters().Workers.Misses, 2u);
    });
}

TEST_P(PagedStoreInProcess, ThreadThatBlocksTheSignalIsServed)
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
TEST_P(PagedStoreInProcess, ForkLeavesTheParentAlone)
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

TEST_P(PagedStoreInProcess, ChildThatGoesOnWithTheStoreIsTold)
{
  dsm_test::RunRanks(1,
    [&](dsm::Messenger& messenger)
    {
      dsm::PagedStore store(messenger, this->GetParam().GetSettings(1 << 20));
      const pid_t child = fork();
      if (child == 0)
      {
        const std::string text = dsm_test::GetErrorText([&] { store.BeginFrame(); });
        std::_Exit(text.find("made by fork") != std::string::npos ? Good : EXIT_FAILURE);
      }
      int status = 0;
      EXPECT_EQ(waitpid(child, &status, 0), child);
      EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == Good) << status;
    });
}

/// Takes fragments of nothing.
class NullSource final : public dsm::FragmentSource
{
public:
  bool Next(dsm::Fragment&) override { return false; }
  double GetProgress() const override { return 1.0; }
};

class NullSink final : public dsm::FragmentSink
{
public:
  void Begin(dsm::BlockId, std::byte*, std::size_t) override {}
  void Absorb(dsm::BlockId, std::byte*, std::size_t, const std::byte*, std::size_t) override {}
  void Finish(dsm::BlockId, std::byte*, std::size_t) override {}
};

TEST_P(PagedStoreInProcess, LimitOfTheAddressSpaceIsNamed)
{
  if (HasSanitizer)
  {
    GTEST_SKIP() << "a sanitizer takes more addresses than any limit leaves";
  }
  const auto check = [&]
  {
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    rlimit limit{};
    limit.rlim_cur = limit.rlim_max = (pages * dsm_test::GetPage()) + (std::size_t(300) << 20);
    setrlimit(RLIMIT_AS, &limit);
    dsm_test::RunRanks(2,
      [&](dsm::Messenger& messenger)
      {
        dsm::PagedStore store(messenger, this->GetParam().GetSettings(1 << 20));
        NullSource source;
        NullSink sink;
        const auto directory = dsm_test::MakeDirectory(2, 8, std::uint32_t(128) << 20);
        const std::string text =
          dsm_test::GetErrorText([&] { store.Publish("Loading", directory, source, sink); });
        EXPECT_NE(text.find("RLIMIT_AS"), std::string::npos) << text;
        EXPECT_NE(text.find(std::to_string(limit.rlim_cur)), std::string::npos) << text;
        const auto segment =
          dsm_test::PublishPattern(messenger, store, dsm_test::MakeDirectory(2, 8, 5000));
        dsm_test::RunFrame(messenger, store,
          [&](dsm::PagedStore::Worker& worker, int)
          { EXPECT_EQ(dsm_test::Visit(store, worker, *segment, 1), 0u); });
      });
  };
  EXPECT_EXIT(RunAndExit(check), testing::ExitedWithCode(Good), "");
}

/// A process that locks all it maps (real-time tools do): pages must come and go all the same.
TEST_P(PagedStoreInProcess, AllMemoryIsLocked)
{
  if (HasSanitizer)
  {
    GTEST_SKIP() << "a sanitizer's memory is too large to be locked";
  }
  const auto check = [&]
  {
    if (mlockall(MCL_FUTURE) != 0)
    {
      return; // not permitted: nothing to be seen
    }
    dsm_test::RunRanks(2,
      [&](dsm::Messenger& messenger)
      {
        dsm_test::PagedRandomAccess(messenger, this->GetParam(), 2, 200);
        dsm_test::PagedCancelWakesWaitingWorkers(messenger, this->GetParam());
      });
  };
  EXPECT_EXIT(RunAndExit(check), testing::ExitedWithCode(Good), "");
}

/// Splits memory into mappings until only `left` are allowed.
void ExhaustMappings(std::size_t left)
{
  std::size_t largest = 0;
  std::ifstream("/proc/sys/vm/max_map_count") >> largest;
  std::ifstream maps("/proc/self/maps");
  const std::size_t used = static_cast<std::size_t>(
    std::count(std::istreambuf_iterator<char>(maps), std::istreambuf_iterator<char>(), '\n'));
  const std::size_t page = dsm_test::GetPage();
  const std::size_t count = largest - used - left;
  auto* const memory = static_cast<std::byte*>(
    mmap(nullptr, count * page, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0));
  for (std::size_t index = 1; index < count; index += 2)
  {
    mprotect(memory + index * page, page, PROT_READ);
  }
}

/// First every second block of the other rank, so that each is a run of its own, then all. Returns
/// the evictions of either frame.
std::array<std::uint64_t, 2> VisitEverySecond(
  dsm::Messenger& messenger, dsm::PagedStore& store, std::size_t count)
{
  const auto segment =
    dsm_test::PublishPattern(messenger, store, dsm_test::MakeDirectory(2, count, 100));
  std::array<std::uint64_t, 2> evictions{};
  for (const unsigned frame : { 0u, 1u })
  {
    dsm_test::RunFrame(messenger, store,
      [&](dsm::PagedStore::Worker& worker, int)
      {
        std::size_t wrong = 0;
        for (dsm::BlockId id = static_cast<dsm::BlockId>(1 - messenger.GetRank()); id < count;
             id += frame == 0 ? 4 : 1)
        {
          wrong += dsm_test::Visit(store, worker, *segment, id);
        }
        EXPECT_EQ(wrong, 0u);
      });
    evictions[frame] = store.GetCounters().Evictions;
  }
  return evictions;
}

TEST_P(PagedStoreInProcess, FewMappingsAreLeft)
{
  if (HasSanitizer)
  {
    GTEST_SKIP() << "a sanitizer needs many mappings itself";
  }
  const auto check = [&]
  {
    ExhaustMappings(2048 + 200);
    dsm_test::RunRanks(2,
      [&](dsm::Messenger& messenger)
      {
        dsm::PagedStore store(messenger, this->GetParam().GetSettings(std::size_t(64) << 20));
        const auto evictions = VisitEverySecond(messenger, store, 2000);
        // Room for all in the cache, but not for so many mappings; userfaultfd needs but one.
        EXPECT_EQ(evictions[0] > 0, this->GetParam().Handling == dsm::FaultHandling::Signal);
        EXPECT_EQ(store.GetCounters().CachedBytes, 1000 * dsm_test::GetPage())
          << "neighbours share a mapping";
      });
  };
  EXPECT_EXIT(RunAndExit(check), testing::ExitedWithCode(Good), "");
}

TEST_P(PagedStoreInProcess, NoMappingsAreLeft)
{
  if (HasSanitizer)
  {
    GTEST_SKIP() << "a sanitizer needs many mappings itself";
  }
  const auto check = [&]
  {
    ExhaustMappings(1500);
    dsm_test::RunRanks(2,
      [&](dsm::Messenger& messenger)
      {
        dsm::PagedStore store(messenger, this->GetParam().GetSettings(1 << 20));
        if (this->GetParam().Handling == dsm::FaultHandling::Signal)
        {
          const std::string text =
            dsm_test::GetErrorText([&] { VisitEverySecond(messenger, store, 20); });
          EXPECT_NE(text.find("vm.max_map_count"), std::string::npos) << text;
        }
        else
        {
          VisitEverySecond(messenger, store, 20);
        }
      });
  };
  EXPECT_EXIT(RunAndExit(check), testing::ExitedWithCode(Good), "");
}

/// As a container's profile does.
void DenyUserFaultFd()
{
  const auto count = [](const auto& program)
  { return static_cast<unsigned short>(sizeof(program) / sizeof(program[0])); };
  sock_filter program[] = {
    BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
    BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_userfaultfd, 3, 0),
    BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_ioctl, 0, 3),
    BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, args[1])),
    BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, 0xAA00, 0, 1), // of /dev/userfaultfd
    BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EPERM),
    BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
  };
  const sock_fprog filter{ count(program), program };
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 ||
    prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter) != 0)
  {
    std::_Exit(Good); // not permitted: nothing to be seen
  }
}

TEST(PagedStore, WithoutUserFaultFdTheSignalIsTaken)
{
  const auto check = []
  {
    DenyUserFaultFd();
    dsm_test::RunRanks(2,
      [](dsm::Messenger& messenger)
      {
        const Way automatic;
        dsm::PagedStore store(messenger, automatic.GetSettings(1 << 20));
        EXPECT_EQ(store.GetFaultHandling(), dsm::FaultHandling::Signal);
        const std::string text = store.GetFaultHandlingText();
        EXPECT_NE(text.find("SIGSEGV"), std::string::npos) << text;
        EXPECT_NE(
          text.find("userfaultfd is not available (Operation not permitted)"), std::string::npos)
          << text;
        dsm_test::PagedEveryByteArrives(messenger, automatic);
      });
  };
  EXPECT_EXIT(RunAndExit(check), testing::ExitedWithCode(Good), "");
}

TEST(PagedStore, ForcedHandlingThatIsImpossibleIsAnErrorOfAllRanks)
{
  const auto check = []
  {
    DenyUserFaultFd();
    dsm_test::RunRanks(2,
      [](dsm::Messenger& messenger)
      {
        // Only rank 1 insists.
        Way way;
        way.Handling = messenger.GetRank() == 1 ? dsm::FaultHandling::UserFaultFd
                                                : dsm::FaultHandling::Automatic;
        dsm::PagedStore store(messenger, way.GetSettings(1 << 20));
        const auto directory = dsm_test::MakeDirectory(2, 4, 100);
        NullSource source;
        NullSink sink;
        const std::string text =
          dsm_test::GetErrorText([&] { store.Publish("Loading", directory, source, sink); });
        EXPECT_EQ(text.find("Loading: Rank 1: userfaultfd is not available"), 0u) << text;
        store.SetSettings(Way().GetSettings(1 << 20));
        const auto segment = dsm_test::PublishPattern(messenger, store, directory);
      });
  };
  EXPECT_EXIT(RunAndExit(check), testing::ExitedWithCode(Good), "");
}

} // namespace
