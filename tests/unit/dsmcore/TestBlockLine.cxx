// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/table/BlockLine.h"

#include <gtest/gtest.h>

#include <vector>

namespace
{

using dsm::LineState;

TEST(BlockLine, LifeOfARemoteBlock)
{
  dsm::BlockLine line;
  for (const LineState next : { LineState::Wanted, LineState::Pending, LineState::Cached,
         LineState::Absent, LineState::Wanted, LineState::Absent })
  {
    line.MoveTo(next);
    EXPECT_EQ(line.State, next);
  }
}

TEST(BlockLine, LifeOfAForeseenBlock)
{
  dsm::BlockLine line;
  for (const LineState next :
    { LineState::Foreseen, LineState::Absent, LineState::Foreseen, LineState::Wanted,
      LineState::Absent, LineState::Foreseen, LineState::Pending, LineState::Cached })
  {
    line.MoveTo(next);
    EXPECT_EQ(line.State, next);
  }
  EXPECT_THROW(line.MoveTo(LineState::Foreseen), dsm::Error);
}

TEST(BlockLine, LifeOfABlockThatAWorkerReads)
{
  dsm::BlockLine line;
  for (const LineState next : { LineState::Pending, LineState::Absent, LineState::Foreseen,
         LineState::Pending, LineState::Cached, LineState::Absent })
  {
    line.MoveTo(next);
    EXPECT_EQ(line.State, next);
  }
}

TEST(BlockLine, IllegalTransitionsFailLoudly)
{
  dsm::BlockLine absent;
  EXPECT_THROW(absent.MoveTo(LineState::Cached), dsm::Error);
  EXPECT_THROW(absent.MoveTo(LineState::Absent), dsm::Error);
  EXPECT_EQ(absent.State, LineState::Absent);
  dsm::BlockLine owned;
  owned.MoveTo(LineState::Owned);
  for (const LineState next : { LineState::Absent, LineState::Wanted, LineState::Pending,
         LineState::Cached, LineState::Owned })
  {
    EXPECT_THROW(owned.MoveTo(next), dsm::Error);
  }
}

} // namespace
