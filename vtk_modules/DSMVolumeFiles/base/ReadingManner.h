// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_ReadingManner_h
#define vol_ReadingManner_h

#include <algorithm>

namespace vol
{

/// How the calling thread reads from volume files, as long as one is in scope; of several the strictest holds.
class ReadingManner
{
public:
  ReadingManner(const ReadingManner&) = delete;
  ReadingManner& operator=(const ReadingManner&) = delete;

protected:
  enum class Kind
  {
    InOrder, ///< unless something else is said: the system may read ahead
    Scattered,
    WithoutWaiting
  };

  explicit ReadingManner(Kind kind)
    : Before(Now)
  {
    Now = std::max(Now, kind);
  }
  ~ReadingManner() { Now = this->Before; }

  static Kind Get() { return Now; }

private:
  Kind Before;
  static inline thread_local Kind Now = Kind::InOrder;
};

/// Here and there: the system reads from the disk what is asked for, and nothing on top.
class ScatteredReads : private ReadingManner
{
public:
  ScatteredReads()
    : ReadingManner(Kind::Scattered)
  {
  }
  static bool AreInForce() { return Get() >= Kind::Scattered; }
};

/// Likewise, but the data have to be in memory already, including the system's cache: if the read had to wait
/// for a disk, or for another thread, it throws WouldWait.
class WithoutWaiting : private ReadingManner
{
public:
  WithoutWaiting()
    : ReadingManner(Kind::WithoutWaiting)
  {
  }
  static bool IsInForce() { return Get() == Kind::WithoutWaiting; }
};

/// Not an error: it is not reported.
struct WouldWait
{
  bool Always = false; ///< whatever is in memory: the file system cannot tell
};

} // namespace vol

#endif
