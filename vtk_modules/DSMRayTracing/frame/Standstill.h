// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_Standstill_h
#define rt_Standstill_h

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <utility>

namespace rt
{

/// Detects that a rank's workers have neither computed nor received a brick for too long. One thread.
class Standstill
{
public:
  /// `limit`: seconds; 0: never.
  explicit Standstill(double limit)
    : Limit(limit)
  {
  }
  /// `getWork`: processor time and bytes so far, any growth of which shows that the workers are alive. To be called
  /// often.
  template <class GetWork>
  bool IsOver(const GetWork& getWork)
  {
    const double interval = this->Limit / Looks;
    const Clock::time_point now = Clock::now();
    const double passed = std::chrono::duration<double>(now - this->LastLook).count();
    if (this->Limit == 0.0 || passed < interval)
    {
      return false;
    }
    this->LastLook = now;
    const std::pair<double, std::uint64_t> work = getWork();
    const bool hasWorked =
      work.first > this->Work.first + LeastSeconds || work.second != this->Work.second;
    // Not more than that: this process may have been stopped.
    this->Silence = hasWorked ? 0.0 : this->Silence + std::min(passed, 2.0 * interval);
    this->Work = work;
    return this->Silence > this->Limit;
  }

private:
  using Clock = std::chrono::steady_clock;
  static constexpr double Looks = 8.0;
  static constexpr double LeastSeconds = 1e-5;

  double Limit;
  double Silence = 0.0;
  Clock::time_point LastLook = Clock::now();
  std::pair<double, std::uint64_t> Work{ 0.0, 0 };
};

} // namespace rt

#endif
