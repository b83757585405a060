// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_SharedProgress_h
#define bricks_SharedProgress_h

#include "DSMCore/base/FunctionRef.h"

#include <atomic>
#include <cstddef>

namespace bricks
{

/// Reports the progress of work that several threads share (ParallelFor). Only the thread that called ParallelFor
/// reports, each hundredth once.
class SharedProgress
{
public:
  /// `report` receives the completed part, above `begin` and up to `end`; it may be empty, and may throw, which ends
  /// the work. `steps`: of all threads together.
  SharedProgress(dsm::FunctionRef<void(double)> report, double begin, double end, std::size_t steps)
    : Report(report)
    , Begin(begin)
    , Length(end - begin)
    , Steps(steps)
  {
  }

  /// `thread`: as ParallelFor numbers them.
  void Add(int thread, std::size_t steps = 1)
  {
    const std::size_t done = this->Done.fetch_add(steps, std::memory_order_relaxed) + steps;
    if (thread == 0 && this->Report)
    {
      const double part = static_cast<double>(done) / static_cast<double>(this->Steps);
      if (part >= this->Shown + LeastStep)
      {
        this->Shown = part;
        this->Report(this->Begin + this->Length * part);
      }
    }
  }

private:
  static constexpr double LeastStep = 0.01;

  dsm::FunctionRef<void(double)> Report;
  double Begin;
  double Length;
  std::size_t Steps;
  double Shown = 0.0;
  std::atomic<std::size_t> Done{ 0 };
};

} // namespace bricks

#endif
