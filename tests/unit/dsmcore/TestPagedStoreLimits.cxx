// SPDX-License-Identifier: BSD-3-Clause
// What the process or the system denies the page store: addresses, locked memory, mappings, userfaultfd.
#include "tests/unit/dsmcore/PagedStoreInProcess.h"
#include "tests/unit/dsmcore/SharingScenarios.h"

#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>

#include <array>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <fstream>

namespace
{

using dsm_test::Good;
using dsm_test::HasSanitizer;
using dsm_test::RunAndExit;
using dsm_test::Way;

class PagedStoreLimits : public dsm_test::PagedStoreInProcess
{
};

INSTANTIATE_TEST_SUITE_P(Ways, PagedStoreLimits, testing::ValuesIn(dsm_test::GetAllWays()),
  [](const testing::TestParamInfo<Way>& way) { return way.param.GetName(); });

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

TEST_P(PagedStoreLimits, LimitOfTheAddressSpaceIsNamed)
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
TEST_P(PagedStoreLimits, AllMemoryIsLocked)
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

TEST_P(PagedStoreLimits, FewMappingsAreLeft)
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
        dsm::PagedStore store(messenger, this->GetParam().GetSettings(std::size_t(64) << 20));
        const auto evictions = VisitEverySecond(messenger, store, 2000);
        EXPECT_EQ(evictions[0], 0u) << "userfaultfd needs but one mapping";
        EXPECT_EQ(store.GetCounters().CachedBytes, 1000 * dsm_test::GetPage());
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

TEST(PagedStore, RefusalOfTheSystemIsAnErrorOfAllRanksWithARemedy)
{
  const auto check = []
  {
    dsm_test::RunRanks(2,
      [](dsm::Messenger& messenger)
      {
        if (messenger.GetRank() == 1)
        {
          DenyUserFaultFd(); // of this thread
        }
        auto settings = dsm_test::MakeStoreSettings(
          dsm::MemoryOrganization::PageBased, std::size_t(1) << 24, true);
        dsm::BlockStore store(messenger, settings);
        const auto directory = dsm_test::MakeDirectory(2, 4, 100);
        NullSource source;
        NullSink sink;
        const std::string text =
          dsm_test::GetErrorText([&] { store.Publish("Loading", directory, source, sink); });
        EXPECT_EQ(
          text.find(
            "Loading: Rank 1: Page based memory requires the system call userfaultfd, "
            "which failed (Operation not permitted): allow it in the container's seccomp profile"),
          0u)
          << text;
        EXPECT_NE(text.find("Choose Object based or Automatic"), std::string::npos) << text;
        settings.Organization = dsm::MemoryOrganization::ObjectBased;
        store.SetSettings(settings);
        const auto segment = dsm_test::PublishPattern(messenger, store, directory);
        dsm_test::ReadEverything(messenger, store, *segment);
      });
  };
  EXPECT_EXIT(RunAndExit(check), testing::ExitedWithCode(Good), "");
}

} // namespace
