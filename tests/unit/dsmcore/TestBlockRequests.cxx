// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/fetch/BlockRequests.h"
#include "DSMCore/transport/LoopbackTransport.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace
{

/// A segment of blocks of four bytes, each its own number, for a store that is not there.
class PlainSegment final : public dsm::BlockSegment
{
public:
  explicit PlainSegment(int ranks)
    : BlockSegment(
        1, dsm::BlockDirectory(std::vector<std::uint32_t>(12, 4), dsm::RoundRobinAssigner(ranks)))
  {
    for (std::uint32_t id = 0; id < 12; ++id)
    {
      this->Numbers.push_back(id);
    }
  }
  void ForEachResident(const Visit&) const override {}
  std::uint64_t GetResidentBytes() const override { return 0; }
  std::byte* GetOwned(dsm::BlockId) const override { return nullptr; }
  void Seal() override {}

  std::vector<std::uint32_t> Numbers;
};

/// Counts what is posted.
class CountingTransport final : public dsm::Transport
{
public:
  CountingTransport(std::unique_ptr<dsm::Transport> carrier, int& requests)
    : Carrier(std::move(carrier))
    , Requests(requests)
  {
  }
  int GetRank() const override { return this->Carrier->GetRank(); }
  int GetSize() const override { return this->Carrier->GetSize(); }
  void Post(int destination, dsm::Message message) override
  {
    this->Requests += message.Kind == dsm::MessageKind::BlockRequest ? 1 : 0;
    this->Carrier->Post(destination, std::move(message));
  }
  bool Progress(const Deliver& deliver) override { return this->Carrier->Progress(deliver); }
  std::size_t GetUnsentBytes() const override { return this->Carrier->GetUnsentBytes(); }
  bool HasUnsent(dsm::MessageKind kind) const override { return this->Carrier->HasUnsent(kind); }

private:
  std::unique_ptr<dsm::Transport> Carrier;
  int& Requests;
};

/// Three ranks, driven by turns.
class BlockRequestsTest : public testing::Test
{
protected:
  BlockRequestsTest()
  {
    auto group = dsm::LoopbackTransport::CreateGroup(3);
    for (auto& transport : group)
    {
      this->Messengers.push_back(std::make_unique<dsm::Messenger>(
        std::make_unique<CountingTransport>(std::move(transport), this->Posted)));
      dsm::BlockRequests::Callbacks callbacks;
      callbacks.Find = [this](std::uint32_t number)
      { return number == 1 ? &this->Segment : nullptr; };
      callbacks.FindOwned = [this](const dsm::BlockWant& block)
      { return reinterpret_cast<const std::byte*>(&this->Segment.Numbers[block.Id]); };
      callbacks.Take = [this](const dsm::BlockWant& block, const std::byte* bytes)
      {
        EXPECT_EQ(std::memcmp(bytes, &this->Segment.Numbers[block.Id], 4), 0);
        this->Taken.push_back(block.Id);
      };
      this->Requests.push_back(
        std::make_unique<dsm::BlockRequests>(*this->Messengers.back(), std::move(callbacks)));
      this->Requests.back()->BeginFrame();
    }
  }

  void Progress()
  {
    for (int turn = 0; turn < 4; ++turn)
    {
      for (const auto& messenger : this->Messengers)
      {
        messenger->Progress();
      }
    }
  }

  int Posted = 0;
  std::vector<dsm::BlockId> Taken;
  PlainSegment Segment{ 3 };
  std::vector<std::unique_ptr<dsm::Messenger>> Messengers;
  std::vector<std::unique_ptr<dsm::BlockRequests>> Requests;
};

TEST_F(BlockRequestsTest, OneMessageForEachOwner)
{
  dsm::BlockRequests& asker = *this->Requests[0];
  EXPECT_FALSE(asker.Submit());
  for (const dsm::BlockId id : { 1, 2, 4, 7, 10 }) // owners 1, 2, 1, 1, 1
  {
    asker.Begin({ &this->Segment, id });
  }
  EXPECT_EQ(asker.GetPendingCount(), 5u);
  EXPECT_TRUE(asker.Submit());
  EXPECT_FALSE(asker.Submit());
  EXPECT_EQ(this->Posted, 2);
  this->Progress();
  std::sort(this->Taken.begin(), this->Taken.end());
  EXPECT_EQ(this->Taken, (std::vector<dsm::BlockId>{ 1, 2, 4, 7, 10 }));
  EXPECT_EQ(asker.GetPendingCount(), 0u);
  EXPECT_EQ(asker.GetBytesReceived(), 20u);
  EXPECT_EQ(this->Requests[1]->GetBytesSent(), 16u);
  EXPECT_EQ(this->Requests[2]->GetBytesSent(), 4u);
}

TEST_F(BlockRequestsTest, RepliesWaitForOthersToLeave)
{
  dsm::BlockRequests& owner = *this->Requests[1];
  owner.SetReplyBytes(2 * 20); // two, with what is behind their bytes
  for (const int asker : { 0, 2 })
  {
    for (const dsm::BlockId id : { 1, 4, 7 })
    {
      this->Requests[asker]->Begin({ &this->Segment, id });
    }
    this->Requests[asker]->Submit();
  }
  this->Messengers[1]->Progress();
  std::size_t replies = 0;
  while (this->Taken.size() < 6 && replies < 10)
  {
    EXPECT_LE(this->Messengers[1]->GetUnsentBytes(), 2 * 20u);
    EXPECT_GT(this->Messengers[1]->GetUnsentBytes(), 0u);
    EXPECT_FALSE(owner.AnswerLater());
    this->Progress();
    ++replies;
    EXPECT_EQ(this->Taken.size(), 2 * replies);
    EXPECT_EQ(owner.AnswerLater(), this->Taken.size() < 6);
  }
  EXPECT_EQ(owner.GetBytesSent(), 24u);
}

/// One at a time is sent whatever its size; what has been abandoned is not.
TEST_F(BlockRequestsTest, RepliesThatWaitAreAbandoned)
{
  dsm::BlockRequests& owner = *this->Requests[1];
  owner.SetReplyBytes(0);
  for (const dsm::BlockId id : { 1, 4, 7 })
  {
    this->Requests[0]->Begin({ &this->Segment, id });
  }
  this->Requests[0]->Submit();
  this->Progress();
  EXPECT_EQ(this->Taken, (std::vector<dsm::BlockId>{ 1 }));
  EXPECT_TRUE(owner.AnswerLater());
  this->Progress();
  EXPECT_EQ(this->Taken, (std::vector<dsm::BlockId>{ 1, 4 }));
  owner.Abandon();
  EXPECT_FALSE(owner.AnswerLater());
  this->Progress();
  EXPECT_EQ(this->Taken.size(), 2u);
}

TEST_F(BlockRequestsTest, WhatIsAbandonedIsNotTaken)
{
  dsm::BlockRequests& asker = *this->Requests[0];
  asker.Begin({ &this->Segment, 1 });
  asker.Submit();
  EXPECT_EQ(asker.GetPendingCount(), 1u);
  asker.Abandon();
  EXPECT_EQ(asker.GetPendingCount(), 0u);
  this->Progress();
  EXPECT_TRUE(this->Taken.empty());
}

TEST_F(BlockRequestsTest, RequestsOfNoWholeNumberOfNamesAreRejected)
{
  for (const std::size_t bytes : { std::size_t(0), std::size_t(1), std::size_t(25) })
  {
    this->Messengers[0]->Post(
      1, dsm::MessageKind::BlockRequest, std::vector<std::byte>(bytes, std::byte{ 0 }));
    try
    {
      this->Progress();
      ADD_FAILURE() << bytes << " bytes were accepted";
    }
    catch (const dsm::Error& error)
    {
      EXPECT_NE(std::string(error.what()).find("rejected"), std::string::npos) << error.what();
    }
  }
}

TEST_F(BlockRequestsTest, BlocksOfOtherOwnersAreNotHandedOut)
{
  const std::uint32_t frame = this->Messengers[0]->GetSession();
  const auto post = [&](std::uint32_t segment, dsm::BlockId id)
  {
    std::vector<std::byte> name = dsm::Encode(segment);
    dsm::AttachTail(name, frame);
    dsm::AttachTail(name, id);
    this->Messengers[0]->Post(1, dsm::MessageKind::BlockRequest, std::move(name));
  };
  for (const auto& [segment, id, words] : { std::tuple(1u, 2u, "rank 2 owns it"),
         std::tuple(1u, 12u, "has no such block"), std::tuple(2u, 1u, "has no such block") })
  {
    post(segment, id);
    try
    {
      this->Progress();
      ADD_FAILURE() << "block " << id << " of segment " << segment << " was handed out";
    }
    catch (const dsm::Error& error)
    {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  }
}

} // namespace
