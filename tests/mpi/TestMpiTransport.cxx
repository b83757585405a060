// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/transport/MpiTransport.h"

#include "DSMCore/base/Error.h"

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace
{

using dsm::MessageKind;

dsm::Message MakeMessage(MessageKind kind, std::size_t bytes, int seed)
{
  dsm::Message message;
  message.Kind = kind;
  message.Session = static_cast<std::uint32_t>(100 + seed);
  message.Payload.assign(bytes, static_cast<std::byte>(seed));
  return message;
}

class MpiTransport : public testing::Test
{
protected:
  MpiTransport()
    : Own(dsm::MpiTransport::Create(nullptr))
  {
  }

  /// Progress until `done` holds here, then until it holds everywhere.
  void Pump(const dsm::Transport::Deliver& deliver, const std::function<bool()>& done)
  {
    int finished = 0;
    bool told = false;
    const auto dispatch = [&](dsm::Message&& message)
    {
      if (message.Kind == MessageKind::FrameEnd)
      {
        ++finished;
      }
      else
      {
        deliver(std::move(message));
      }
    };
    while (finished < this->Own->GetSize() || this->Own->GetUnsentBytes() > 0)
    {
      if (!this->Own->Progress(dispatch))
      {
        std::this_thread::yield();
      }
      if (!told && done())
      {
        told = true;
        for (int rank = 0; rank < this->Own->GetSize(); ++rank)
        {
          this->Own->Post(rank, MakeMessage(MessageKind::FrameEnd, 0, 0));
        }
      }
    }
  }

  std::unique_ptr<dsm::Transport> Own;
};

TEST_F(MpiTransport, ExistsUnderMpi)
{
  EXPECT_NE(this->Own, nullptr);
  EXPECT_GE(this->Own->GetSize(), 1);
  EXPECT_LT(this->Own->GetRank(), this->Own->GetSize());
}

TEST_F(MpiTransport, EmptySmallAndLargeMessagesArriveWithTheirHeaders)
{
  const int size = this->Own->GetSize();
  const std::vector<std::size_t> sizes = { 0, 1, 17, 4096, 70000, std::size_t(5) << 20 };
  for (int rank = 0; rank < size; ++rank)
  {
    for (std::size_t i = 0; i < sizes.size(); ++i)
    {
      const MessageKind kind = i % 2 == 0 ? MessageKind::Fragment : MessageKind::BlockReply;
      this->Own->Post(rank, MakeMessage(kind, sizes[i], static_cast<int>(i)));
    }
  }
  std::vector<std::size_t> next(static_cast<std::size_t>(size), 0);
  std::size_t total = 0;
  this->Pump(
    [&](dsm::Message&& message)
    {
      const std::size_t i = next[static_cast<std::size_t>(message.Source)]++;
      EXPECT_EQ(message.Kind, i % 2 == 0 ? MessageKind::Fragment : MessageKind::BlockReply);
      EXPECT_EQ(message.Session, 100 + i);
      EXPECT_EQ(message.Payload, std::vector<std::byte>(sizes[i], static_cast<std::byte>(i)));
      ++total;
    },
    [&] { return total == sizes.size() * static_cast<std::size_t>(size); });
}

TEST_F(MpiTransport, FragmentsCountAsUnsentUntilTheReceiverTakesThem)
{
  const int size = this->Own->GetSize();
  const int next = (this->Own->GetRank() + 1) % size;
  // Small enough to be sent eagerly, were it not for the synchronous mode.
  this->Own->Post(next, MakeMessage(MessageKind::Fragment, 100, 1));
  if (size > 1)
  {
    EXPECT_EQ(this->Own->GetUnsentBytes(), 100u);
    EXPECT_TRUE(this->Own->HasUnsent(MessageKind::Fragment));
    EXPECT_FALSE(this->Own->HasUnsent(MessageKind::BlockReply));
  }
  int count = 0;
  this->Pump([&](dsm::Message&&) { ++count; },
    [&] { return count == 1 && !this->Own->HasUnsent(MessageKind::Fragment); });
  EXPECT_EQ(this->Own->GetUnsentBytes(), 0u);
}

TEST_F(MpiTransport, MoreThanTheReceiverTakesAtOnce)
{
  // 12 x 4 MiB from every rank to every rank; no more than 16 MiB are received at a time.
  const int size = this->Own->GetSize();
  const std::size_t bytes = std::size_t(4) << 20;
  for (int i = 0; i < 12; ++i)
  {
    for (int rank = 0; rank < size; ++rank)
    {
      this->Own->Post(rank, MakeMessage(MessageKind::Fragment, bytes, i));
    }
  }
  int count = 0;
  this->Pump(
    [&](dsm::Message&& message)
    {
      EXPECT_EQ(message.Payload.size(), bytes);
      EXPECT_EQ(message.Payload.back(), static_cast<std::byte>(message.Session - 100));
      ++count;
    },
    [&] { return count == 12 * size; });
}

TEST_F(MpiTransport, TransportsDoNotHearOneAnother)
{
  auto other = dsm::MpiTransport::Create(nullptr);
  const int next = (this->Own->GetRank() + 1) % this->Own->GetSize();
  other->Post(next, MakeMessage(MessageKind::TileGrant, 10, 2));
  this->Own->Post(next, MakeMessage(MessageKind::TileGrant, 10, 1));
  int count = 0;
  this->Pump(
    [&](dsm::Message&& message)
    {
      EXPECT_EQ(message.Session, 101u);
      ++count;
    },
    [&] { return count == 1; });
  int others = 0;
  while (others == 0)
  {
    other->Progress(
      [&](dsm::Message&& message)
      {
        EXPECT_EQ(message.Session, 102u);
        ++others;
      });
  }
  EXPECT_EQ(others, 1);
}

TEST_F(MpiTransport, DestructorDoesNotWaitAndTheNextTakesWhatNobodyReceived)
{
  auto other = dsm::MpiTransport::Create(nullptr);
  for (int rank = 0; rank < other->GetSize(); ++rank)
  {
    other->Post(rank, MakeMessage(MessageKind::Fragment, std::size_t(3) << 20, 1));
    other->Post(rank, MakeMessage(MessageKind::BlockReply, 5, 1));
  }
  // The other ranks keep theirs until rank 0 has ended its own, as a session does that deletes a view rank by rank.
  const auto start = std::chrono::steady_clock::now();
  if (this->Own->GetRank() == 0)
  {
    other.reset();
  }
  this->Pump([](dsm::Message&&) {}, [] { return true; });
  other.reset();
  other = dsm::MpiTransport::Create(nullptr);
  // Nobody gave up after the time limit for what is under way.
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(4));
}

TEST_F(MpiTransport, NoSuchRankIsAnErrorWithMpisOwnText)
{
  try
  {
    this->Own->Post(this->Own->GetSize(), MakeMessage(MessageKind::TileGrant, 10, 2));
    ADD_FAILURE() << "no error";
  }
  catch (const dsm::Error& error)
  {
    const std::string text = error.what();
    EXPECT_NE(text.find("MPI_Isend failed on rank " + std::to_string(this->Own->GetRank())),
      std::string::npos)
      << text;
    EXPECT_NE(text.find("MPI_ERR_RANK"), std::string::npos) << text;
  }
}

} // namespace
