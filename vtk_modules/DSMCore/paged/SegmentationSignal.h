// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_SegmentationSignal_h
#define dsm_SegmentationSignal_h

#include <cstddef>

namespace dsm
{

/// The process's handler of SIGSEGV, shared by all page stores: a fault in one of their ranges goes
/// to its resolver; any other goes to whoever had the signal before, with all that belongs to it, so
/// that a crash elsewhere is the crash that it was. The handler takes no lock and no memory.
///
/// Installed while there are ranges. When the application sets a handler later, that one gets the
/// faults first until the next Reclaim, which puts ours in front again and it behind; handlers that
/// pass a signal on to one another in a circle are recognised.
class SegmentationSignal
{
public:
  class Resolver
  {
  public:
    /// On the thread that faulted, in a signal handler. Returns whether the access shall be tried
    /// again.
    virtual bool Resolve(std::byte* address) noexcept = 0;

  protected:
    ~Resolver() = default;
  };

  /// Any thread; so are the others. Throws Error when the system refuses the handler.
  static void Add(std::byte* begin, std::size_t bytes, Resolver& resolver);
  /// Nobody is about to fault there.
  static void Remove(std::byte* begin) noexcept;
  static void Reclaim();
  /// A thread may have been started with the signal blocked; then a fault would end the process.
  /// Quick after the first time on a thread.
  static void Unblock() noexcept;
};

} // namespace dsm

#endif
