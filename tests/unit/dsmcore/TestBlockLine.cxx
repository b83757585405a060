// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/table/BlockLine.h"

#include <gtest/gtest.h>

#include <vector>

namespace
{

using dsm::LineState;

void ExpectLife(dsm::BlockLine& line, const std::vector<LineState>& states)
{
  for (const LineState next : states)
  {
    line.MoveTo(next);
    EXPECT_EQ(line.State, next);
  }
}

TEST(BlockLine, LifeOfARemoteBlock)
{
  dsm::BlockLine line;
  ExpectLife(line,
    { LineState::Wanted, LineState::Pending, LineState::Cached, LineState::Absent,
      LineState::Wanted, LineState::Absent });
}

TEST(BlockLine, LifeOfAForeseenBlock)
{
  dsm::BlockLine line;
  ExpectLife(line,
    { LineState::Foreseen, LineState::Absent, LineState::Foreseen, LineState::Wanted,
      LineState::Absent, LineState::Foreseen, LineState::Pending, LineState::Cached });
  EXPECT_THROW(line.MoveTo(LineState::Foreseen), dsm::Error);
}

TEST(BlockLine, LifeOfABlockThatAWorkerReads)
{
  dsm::BlockLine line;
  ExpectLife(line,
    { LineState::Pending, LineState::Absent, LineState::Foreseen, LineState::Pending,
      LineState::Cached, LineState::Absent });
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
