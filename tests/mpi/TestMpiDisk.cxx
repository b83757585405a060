// SPDX-License-Identifier: BSD-3-Clause
// Blocks on a disk, over MPI; see TestReadingSource for what they do within a process.
#include "DSMCore/transport/MpiTransport.h"

#include "tests/unit/dsmcore/DiskScenarios.h"

#include <memory>
#include <vector>

namespace
{

class DiskOverMpi : public testing::TestWithParam<dsm::MemoryOrganization>
{
};

INSTANTIATE_TEST_SUITE_P(Organizations, DiskOverMpi,
  testing::Values(dsm::MemoryOrganization::ObjectBased, dsm::MemoryOrganization::PageBased,
    dsm::MemoryOrganization::Replicated));

TEST_P(DiskOverMpi, RandomAccess)
{
  dsm::Messenger messenger(dsm::MpiTransport::Create(nullptr));
  for (const std::size_t blocks : { 2, 5, 100 })
  {
    for (const bool shares : { false, true })
    {
      dsm_test::RandomAccessToADisk(messenger, this->GetParam(), blocks, 4, shares);
    }
  }
}

TEST_P(DiskOverMpi, FailureIsTheFramesErrorAndTheNextFrameWorks)
{
  dsm::Messenger messenger(dsm::MpiTransport::Create(nullptr));
  dsm_test::DiskStore disks(messenger, this->GetParam(), 6);
  const int last = messenger.GetSize() - 1;
  disks.Disk->Bad = static_cast<dsm::BlockId>(5 * messenger.GetSize() + last);
  const std::string text = dsm_test::GetErrorText([&] { disks.ReadAll(); });
  EXPECT_NE(text.find("of the file is damaged"), std::string::npos) << text;
  disks.Disk->Bad = dsm_test::NoBlock;
  disks.ReadAll();
}

/// A network file system that does not answer: the frame's error, before anybody is given up; and when it answers
/// again, the next frame works.
TEST_P(DiskOverMpi, DiskThatDoesNotAnswerFailsTheFrameOnly)
{
  dsm::Messenger messenger(dsm::MpiTransport::Create(nullptr));
  messenger.SetSilenceLimit(2.0);
  dsm_test::DiskStore disks(messenger, this->GetParam(), 6);
  const auto stuck = static_cast<dsm::BlockId>(messenger.GetSize() - 1);
  disks.Disk->SetStuck(stuck);
  const std::string text = dsm_test::GetErrorText([&] { disks.ReadAll(); });
  const std::string brick = "Brick " + std::to_string(stuck) + " of the test's disk ";
  EXPECT_NE(text.find(brick + "did not arrive within 1.5 s"), std::string::npos) << text;
  disks.Disk->SetStuck(dsm_test::NoBlock);
  disks.ReadAll();
}

/// As from one time step to the next: it is the next one's that is named.
TEST_P(DiskOverMpi, DiskThatDoesNotAnswerIsNamedAsItIsNow)
{
  dsm::Messenger messenger(dsm::MpiTransport::Create(nullptr));
  messenger.SetSilenceLimit(2.0);
  dsm_test::DiskStore disks(messenger, this->GetParam(), 6);
  const auto next = std::make_shared<dsm_test::PatternDisk>();
  disks.Source->SetReader(next, "the next disk");
  disks.Store.Refresh("The next step", disks.Segment,
    std::vector<bool>(disks.Segment->GetDirectory().GetCount(), true));
  next->SetStuck(0);
  const std::string text = dsm_test::GetErrorText([&] { disks.ReadAll(); });
  EXPECT_NE(text.find("Brick 0 of the next disk did not arrive within 1.5 s"), std::string::npos)
    << text;
  next->SetStuck(dsm_test::NoBlock);
  disks.ReadAll();
}

} // namespace
