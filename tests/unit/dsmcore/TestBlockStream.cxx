// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/publish/BlockStream.h"

#include "tests/unit/dsmcore/StoreScenarios.h"

#include <algorithm>
#include <chrono>
#include <thread>

namespace
{

TEST(BlockStream, FragmentForABlockOutOfRangeIsAnError)
{
  dsm_test::RunRanks(2,
    [](dsm::Messenger& messenger)
    {
      dsm::ObjectStore store(messenger, dsm_test::MakeSettings(1 << 16, 1));
      // The source believes in one block more than there are.
      dsm_test::PatternSource source(dsm_test::MakeDirectory(2, 5, 100), messenger.GetRank(), 2,
        dsm_test::Spread::EveryRankASlice, 100);
      dsm_test::PatternSink sink;
      const std::string text = dsm_test::GetErrorText(
        [&] { store.Publish("Loading", dsm_test::MakeDirectory(2, 4, 100), source, sink); });
      EXPECT_NE(text.find("Loading: A fragment was produced for block 4"), std::string::npos)
        << text;
    });
}

/// Notes how much lies in front of the receivers whenever the next fragment is produced.
class WatchingSource final : public dsm_test::PatternSource
{
public:
  WatchingSource(const dsm::Messenger& messenger, const dsm::BlockDirectory& directory)
    : PatternSource(directory, messenger.GetRank(), messenger.GetSize(),
        dsm_test::Spread::OnlyRankZero, std::size_t(1) << 20)
    , Messages(messenger)
  {
  }
  bool Next(dsm::Fragment& fragment) override
  {
    this->MostUnsent = std::max(this->MostUnsent, this->Messages.GetUnsentBytes());
    return this->PatternSource::Next(fragment);
  }
  std::size_t MostUnsent = 0;

private:
  const dsm::Messenger& Messages;
};

class SlowSink final : public dsm_test::PatternSink
{
public:
  void Absorb(dsm::BlockId id, std::byte* block, std::size_t bytes, const std::byte* fragment,
    std::size_t fragmentBytes) override
  {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    this->PatternSink::Absorb(id, block, bytes, fragment, fragmentBytes);
  }
};

TEST(BlockStream, SourceWaitsForSlowReceivers)
{
  dsm_test::RunRanks(2,
    [](dsm::Messenger& messenger)
    {
      dsm::ObjectStore store(messenger, dsm_test::MakeSettings(0));
      const auto directory = dsm_test::MakeDirectory(2, 12, std::uint32_t(4) << 20);
      WatchingSource source(messenger, directory);
      SlowSink slow;
      dsm_test::PatternSink quick;
      dsm::FragmentSink& sink =
        messenger.GetRank() == 1 ? static_cast<dsm::FragmentSink&>(slow) : quick;
      store.Publish("Loading", directory, source, sink);
      EXPECT_LT(source.MostUnsent, dsm::BlockStream::MaximumUnsentBytes);
      EXPECT_EQ(source.MostUnsent > 0, messenger.GetRank() == 0);
      EXPECT_EQ(slow.Absorbed, slow.Expected);
    });
}

/// Aborts, as a user does in a progress dialog.
TEST(BlockStream, ProgressThatThrowsEndsThePublicationForAll)
{
  dsm_test::RunRanks(3,
    [](dsm::Messenger& messenger)
    {
      dsm::ObjectStore store(messenger, dsm_test::MakeSettings(0));
      const auto directory = dsm_test::MakeDirectory(3, 30, 5000);
      dsm_test::PatternSource source(
        directory, messenger.GetRank(), 3, dsm_test::Spread::EveryRankASlice, 100);
      dsm_test::PatternSink sink;
      const std::string text = dsm_test::GetErrorText(
        [&]
        {
          store.Publish("Loading", directory, source, sink,
            [&](double part)
            {
              if (messenger.GetRank() == 1 && part > 0.3)
              {
                throw dsm::Error("aborted");
              }
            });
        });
      EXPECT_EQ(text, "Loading: Rank 1: aborted");
    });
}

} // namespace
