// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_Attendance_h
#define dsm_Attendance_h

#include <algorithm>
#include <cstddef>
#include <vector>

namespace dsm
{

/// Records which ranks must send messages, and how long each has been silent. A rank must if it has reported that
/// it waits for others, until it reports that it does something else; in a step in which all serve one another, all
/// ranks must. A rank that computes need not, however long it takes. One thread.
class Attendance
{
public:
  explicit Attendance(int ranks)
    : Ranks(static_cast<std::size_t>(ranks))
  {
  }

  /// Any message from a rank ends its silence.
  void Hear(int rank) { this->Get(rank).Silence = 0.0; }

  /// Sets whether the rank must send messages from now on.
  void Expect(int rank, bool isExpected) { this->Get(rank) = { isExpected, 0.0 }; }
  void ExpectAll(bool areExpected)
  {
    std::fill(this->Ranks.begin(), this->Ranks.end(), Rank{ areExpected, 0.0 });
  }

  /// This rank has listened to ranks [first, last) for so many seconds more. Returns the first of them
  /// that has been silent for more than `limit` seconds, or a negative number.
  int Listen(double seconds, double limit, int first, int last)
  {
    int silent = -1;
    for (int rank = first; rank < last; ++rank)
    {
      Rank& each = this->Get(rank);
      each.Silence += each.IsExpected ? seconds : 0.0;
      silent = silent < 0 && each.Silence > limit ? rank : silent;
    }
    return silent;
  }

private:
  struct Rank
  {
    bool IsExpected = false;
    double Silence = 0.0; ///< seconds
  };
  Rank& Get(int rank) { return this->Ranks[static_cast<std::size_t>(rank)]; }

  std::vector<Rank> Ranks;
};

} // namespace dsm

#endif
