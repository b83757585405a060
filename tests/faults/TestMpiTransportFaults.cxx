// SPDX-License-Identifier: BSD-3-Clause
// Over real MPI: a rank that gets no memory within a call of the transport has sent the message, or
// has not and says so, and loses none that comes.
#include "tests/faults/FaultInjection.h"

#include "DSMCore/transport/MpiTransport.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <new>
#include <thread>
#include <vector>

namespace
{

/// More than any eager limit: MPI reads it after Post has returned.
constexpr std::size_t LargeBytes = std::size_t(1) << 18;
constexpr int Last = -1;

bool HoldsOnly(const std::vector<std::byte>& bytes, int number)
{
  return std::all_of(bytes.begin(), bytes.end(),
    [=](std::byte byte) { return byte == static_cast<std::byte>(number); });
}

dsm::Message MakeMessage(int number, bool isLarge)
{
  dsm::Message message;
  message.Kind = dsm::MessageKind::BlockReply;
  message.Session = 5;
  message.Payload.assign(isLarge ? LargeBytes : 100, static_cast<std::byte>(number));
  dsm::AttachTail(message.Payload, number);
  return message;
}

TEST(MpiTransportFaults, WhatAPostThatThrowsWasToSendIsNotSent)
{
  const auto transport = dsm::MpiTransport::Create(nullptr);
  const int next = (transport->GetRank() + 1) % transport->GetSize();
  const int before = (transport->GetRank() + transport->GetSize() - 1) % transport->GetSize();
  FaultInjection faults;
  faults.Join();
  std::vector<int> sent;
  std::vector<int> received;
  std::vector<int> sentToHere;
  int failures = 0;
  bool isOver = false;
  const auto deliver = [&](dsm::Message&& message)
  {
    const int number = dsm::DetachTail<int>(message, dsm::MessageKind::BlockReply);
    EXPECT_EQ(message.Source, before);
    isOver = number == Last;
    if (isOver)
    {
      sentToHere.resize(message.Payload.size() / sizeof(int));
      std::memcpy(sentToHere.data(), message.Payload.data(), message.Payload.size());
    }
    else
    {
      EXPECT_TRUE(HoldsOnly(message.Payload, number)) << number;
      received.push_back(number);
    }
  };
  for (int number = 0; number < 100; ++number)
  {
    dsm::Message message = MakeMessage(number, number % 2 == 0);
    faults.Arm(FaultInjection::Kind::Memory,
      number % 5); // Post asks for the tail's room, then its books', then MPI's calls
    try
    {
      transport->Post(next, std::move(message));
      faults.Disarm();
      sent.push_back(number);
    }
    catch (const std::bad_alloc&)
    {
      faults.Disarm();
      ++failures;
    }
    if (number % 16 == 15)
    {
      transport->Progress(deliver);
    }
  }
  EXPECT_GT(failures, 0);
  dsm::Message last = MakeMessage(Last, false);
  last.Payload.resize(sent.size() * sizeof(int));
  std::memcpy(last.Payload.data(), sent.data(), last.Payload.size());
  dsm::AttachTail(last.Payload, Last);
  transport->Post(next, std::move(last));
  while (!isOver || transport->GetUnsentBytes() > 0)
  {
    if (!transport->Progress(deliver))
    {
      std::this_thread::yield();
    }
  }
  EXPECT_EQ(received, sentToHere);
  FaultInjection::Leave();
}

TEST(MpiTransportFaults, ARankThatGetsNoMemoryLosesNoMessage)
{
  const auto transport = dsm::MpiTransport::Create(nullptr);
  const int next = (transport->GetRank() + 1) % transport->GetSize();
  FaultInjection faults;
  faults.Join();
  constexpr int count = 150;
  int posted = 0;
  int failures = 0;
  std::vector<int> received;
  std::vector<int> expected;
  const auto deliver = [&](dsm::Message&& message)
  {
    // Who takes it may not get memory either; what is written keeps compilers from doing without it.
    std::vector<int> room(1);
    *const_cast<volatile int*>(room.data()) = 1;
    const int number = dsm::DetachTail<int>(message, dsm::MessageKind::BlockReply);
    EXPECT_TRUE(HoldsOnly(message.Payload, number)) << number;
    received.push_back(number);
  };
  received.reserve(count);
  while (
    posted < count || static_cast<int>(received.size()) < count || transport->GetUnsentBytes() > 0)
  {
    if (posted < count)
    {
      expected.push_back(posted);
      transport->Post(next, MakeMessage(posted, posted % 50 == 0));
      ++posted;
    }
    bool any = true;
    faults.Arm(FaultInjection::Kind::Memory, posted % 7);
    try
    {
      any = transport->Progress(deliver);
      faults.Disarm();
    }
    catch (const std::bad_alloc&)
    {
      faults.Disarm();
      ++failures;
    }
    if (!any)
    {
      std::this_thread::yield();
    }
  }
  EXPECT_EQ(received, expected);
  EXPECT_GT(failures, 0);
  FaultInjection::Leave();
}

} // namespace
