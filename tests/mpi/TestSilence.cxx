// SPDX-License-Identifier: BSD-3-Clause
// Over real MPI ranks: a rank that is stopped, or whose workers are, is given up by all after a time, with
// its name; one that only takes long is not.
#include "tests/support/SphereScene.h"

#include "DSMCore/transport/MpiTransport.h"
#include "DSMRayTracing/frame/FrameRenderer.h"

#include <gtest/gtest.h>

#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace
{

using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void Sleep(double seconds)
{
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

/// Stops this process as a whole; another one lets it go on.
void StopFor(double seconds)
{
  const pid_t own = getpid();
  const pid_t child = fork();
  if (child == 0)
  {
    usleep(static_cast<useconds_t>(1e6 * seconds));
    kill(own, SIGCONT);
    _exit(0);
  }
  kill(own, SIGSTOP);
  waitpid(child, nullptr, 0);
}

/// Another transport, which may do something before it sends a message of a kind, or looks for messages.
class WatchedTransport final : public dsm::Transport
{
public:
  explicit WatchedTransport(std::unique_ptr<dsm::Transport> carrier)
    : Carrier(std::move(carrier))
  {
  }
  int GetRank() const override { return this->Carrier->GetRank(); }
  int GetSize() const override { return this->Carrier->GetSize(); }
  void Post(int destination, dsm::Message message) override
  {
    if (message.Kind == this->Kind)
    {
      this->DoOnce();
    }
    this->Carrier->Post(destination, std::move(message));
  }
  bool Progress(const Deliver& deliver) override
  {
    if (Clock::now() > this->Time)
    {
      this->DoOnce();
    }
    return this->Carrier->Progress(deliver);
  }
  std::size_t GetUnsentBytes() const override { return this->Carrier->GetUnsentBytes(); }
  bool HasUnsent(dsm::MessageKind kind) const override { return this->Carrier->HasUnsent(kind); }

  /// Once, before a message of the kind is sent, or messages are looked for after the time.
  std::function<void()> Deed;
  dsm::MessageKind Kind{};
  Clock::time_point Time = Clock::time_point::max();

private:
  void DoOnce()
  {
    if (const auto deed = std::exchange(this->Deed, nullptr))
    {
      deed();
    }
  }
  std::unique_ptr<dsm::Transport> Carrier;
};

class Silence : public testing::Test
{
protected:
  Silence()
    : Carrier(new WatchedTransport(dsm::MpiTransport::Create(nullptr)))
    , Messenger(std::unique_ptr<dsm::Transport>(this->Carrier))
    , Store(this->Messenger, SphereScene::CreateSettings(std::size_t(1) << 20, 2))
    , Renderer(this->Messenger)
    , Scene(SphereScene::CreateScene(SphereScene::Publish(this->Messenger, this->Store), 1.0f))
  {
  }
  void SetUp() override
  {
    if (this->Messenger.GetSize() == 1)
    {
      GTEST_SKIP() << "nobody waits";
    }
  }

  dsm::Status TraceFrame()
  {
    return this->Messenger.RunStep(
      [&]
      {
        const rt::FrameRequest request = SphereScene::CreateRequest(64, 48);
        EXPECT_FALSE(this->Renderer.Render(this->Store, this->Scene, request).IsAborted);
      });
  }

  /// The frame fails because of the rank, and so do all further ones, at once.
  void ExpectLost(const dsm::Status& outcome, int rank)
  {
    EXPECT_EQ(outcome.FailedRank, rank);
    EXPECT_NE(outcome.Cause.find("Rank " + std::to_string(rank) + " "), std::string::npos)
      << outcome.Cause;
    EXPECT_NE(outcome.Cause.find("DSMSilenceLimit"), std::string::npos) << outcome.Cause;
    const auto start = Clock::now();
    EXPECT_EQ(this->TraceFrame().Cause, outcome.Cause);
    EXPECT_LT(SecondsSince(start), 0.5);
  }

  int GetLast() const { return this->Messenger.GetSize() - 1; }
  bool Am(int rank) const { return this->Messenger.GetRank() == rank; }

  WatchedTransport* Carrier; ///< the messenger's
  dsm::Messenger Messenger;
  dsm::BlockStore Store;
  rt::FrameRenderer Renderer;
  rt::Scene Scene;
};

constexpr double Limit = 1.0;
constexpr double LongStop = 5.0;

TEST_F(Silence, OfARankThatIsStoppedInAFrameEndsItOnAll)
{
  this->Messenger.SetSilenceLimit(Limit);
  if (this->Am(this->GetLast()))
  {
    this->Carrier->Kind = dsm::MessageKind::FrameDone;
    this->Carrier->Deed = [] { StopFor(LongStop); };
  }
  const auto start = Clock::now();
  const dsm::Status outcome = this->TraceFrame();
  if (!this->Am(this->GetLast()))
  {
    EXPECT_GT(SecondsSince(start), Limit);
    EXPECT_LT(SecondsSince(start), LongStop - 1.0);
  }
  this->ExpectLost(outcome, this->GetLast());
}

TEST_F(Silence, OfRankZeroEndsTheFrameOnAll)
{
  this->Messenger.SetSilenceLimit(Limit);
  if (this->Am(0))
  {
    this->Carrier->Kind = dsm::MessageKind::FrameEnd;
    this->Carrier->Deed = [] { StopFor(LongStop); };
  }
  this->ExpectLost(this->TraceFrame(), 0);
}

TEST_F(Silence, OfARankThatWaitsForOthersIsNoticed)
{
  this->Messenger.SetSilenceLimit(Limit);
  if (this->Am(this->GetLast()))
  {
    this->Carrier->Time = Clock::now() + std::chrono::seconds(1);
    this->Carrier->Deed = [] { StopFor(LongStop); };
  }
  const dsm::Status outcome = this->Messenger.RunStep(
    [&]
    {
      if (this->Am(0))
      {
        Sleep(2.0);
      }
      this->Messenger.Barrier();
    });
  // Rank 0 has what it waits for, and notices at the end of the step, or in the next one.
  this->ExpectLost(outcome.IsOk() ? this->TraceFrame() : outcome, this->GetLast());
}

TEST_F(Silence, WithoutALimitIsWaitedFor)
{
  this->Messenger.SetSilenceLimit(0.0);
  if (this->Am(this->GetLast()))
  {
    this->Carrier->Kind = dsm::MessageKind::FrameDone;
    this->Carrier->Deed = [] { StopFor(2.0); };
  }
  EXPECT_EQ(this->TraceFrame().Cause, "");
}

TEST_F(Silence, OfARankThatComputesIsNotCounted)
{
  this->Messenger.SetSilenceLimit(0.4);
  EXPECT_EQ(this->TraceFrame().Cause, "");
  for (int rank = 0; rank < this->Messenger.GetSize(); ++rank)
  {
    // Before, it has waited for others, and told so.
    const dsm::Status outcome = this->Messenger.RunStep(
      [&]
      {
        this->Messenger.RunTogether("Reading a file",
          [&]
          {
            if (this->Am(rank))
            {
              Sleep(1.2);
            }
          });
      });
    EXPECT_EQ(outcome.Cause, "");
    EXPECT_EQ(this->TraceFrame().Cause, "");
  }
}

/// Yields fragments for a while, then takes its time for the last one.
class SlowSource final : public dsm::FragmentSource
{
public:
  explicit SlowSource(bool isSlow)
    : Left(isSlow ? 8 : 0)
  {
  }
  bool Next(dsm::Fragment& fragment) override
  {
    if (this->Left == 0)
    {
      return false;
    }
    Sleep(--this->Left > 0 ? 0.06 : 1.2);
    fragment.Block = static_cast<dsm::BlockId>(this->Left);
    fragment.Bytes.assign(1, std::byte{ 1 });
    return true;
  }
  double GetProgress() const override { return 0.5; }

private:
  int Left;
};

class NoSink final : public dsm::FragmentSink
{
public:
  void Begin(dsm::BlockId, std::byte*, std::size_t) override {}
  void Absorb(dsm::BlockId, std::byte*, std::size_t, const std::byte*, std::size_t) override {}
  void Finish(dsm::BlockId, std::byte*, std::size_t) override {}
};

TEST_F(Silence, OfASourceOfFragmentsIsNotCounted)
{
  this->Messenger.SetSilenceLimit(0.4);
  EXPECT_EQ(this->TraceFrame().Cause, "");
  const dsm::Status outcome = this->Messenger.RunStep(
    [&]
    {
      SlowSource source(this->Am(this->GetLast()));
      NoSink sink;
      this->Store.Retire(this->Store.Publish("slow",
        { std::vector<std::uint32_t>(8, 100), dsm::RoundRobinAssigner(this->Messenger.GetSize()) },
        source, sink));
    });
  EXPECT_EQ(outcome.Cause, "");
  EXPECT_EQ(this->TraceFrame().Cause, "");
}

/// Where threads stand still, in a signal's handler, until it is closed.
int gate[2] = { -1, -1 };

void StandStill(int)
{
  char byte;
  [[maybe_unused]] const ssize_t count = read(gate[0], &byte, 1);
}

std::set<pid_t> GetThreads()
{
  std::set<pid_t> threads;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/task"))
  {
    threads.insert(static_cast<pid_t>(std::stoi(entry.path().filename())));
  }
  return threads;
}

TEST_F(Silence, OfAllWorkersOfARankEndsTheFrameOnTheOthers)
{
  const std::set<pid_t> before = GetThreads();
  EXPECT_EQ(this->TraceFrame().Cause, "");
  this->Messenger.SetSilenceLimit(Limit);
  std::thread opener;
  if (this->Am(this->GetLast()))
  {
    ASSERT_EQ(pipe(gate), 0);
    struct sigaction action = {};
    action.sa_handler = StandStill;
    ASSERT_EQ(sigaction(SIGUSR1, &action, nullptr), 0);
    for (const pid_t thread : GetThreads())
    {
      if (before.count(thread) == 0)
      {
        syscall(SYS_tgkill, getpid(), thread, SIGUSR1);
      }
    }
    opener = std::thread(
      []
      {
        Sleep(LongStop);
        close(gate[1]);
      });
  }
  const auto start = Clock::now();
  const dsm::Status outcome = this->TraceFrame();
  if (opener.joinable())
  {
    opener.join();
  }
  else
  {
    EXPECT_LT(SecondsSince(start), LongStop - 1.0);
    EXPECT_NE(outcome.Cause.find("stuck"), std::string::npos) << outcome.Cause;
  }
  this->ExpectLost(outcome, this->GetLast());
}

} // namespace
