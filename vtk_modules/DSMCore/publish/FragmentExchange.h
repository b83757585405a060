// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_FragmentExchange_h
#define dsm_FragmentExchange_h

#include "DSMCore/publish/BlockDirectory.h"
#include "DSMCore/publish/Publication.h"
#include "DSMCore/transport/Messenger.h"

#include <functional>
#include <string>

namespace dsm
{

/// Moves the fragments of every rank to the owners of their blocks, in a bounded stream: a rank
/// takes the next fragment from its source only while few of its bytes wait for their receivers.
/// The same for every organisation of memory. Communication thread, one exchange at a time.
class FragmentExchange
{
public:
  /// Where a block that this rank owns lies.
  using Locate = std::function<std::byte*(BlockId)>;

  /// Bytes on their way out at which a rank stops to produce more.
  static constexpr std::size_t MaximumUnsentBytes = std::size_t(8) << 20;

  FragmentExchange(Messenger& messenger, const BlockDirectory& directory, Locate locate);
  ~FragmentExchange();
  FragmentExchange(const FragmentExchange&) = delete;
  FragmentExchange& operator=(const FragmentExchange&) = delete;

  /// Collective; the session must have been begun for it. Returns when every rank's fragments have
  /// been absorbed. When source, sink or progress throw on this rank, it contributes no more,
  /// discards what comes, and returns the cause (empty: success) when all others are done too; it
  /// is for the caller to let the ranks agree.
  std::string Run(
    FragmentSource& source, FragmentSink& sink, const std::function<void(double)>& progress);

private:
  bool Feed(FragmentSource& source, FragmentSink& sink);
  void Receive(Message&& message, FragmentSink& sink);
  void Absorb(FragmentSink& sink, BlockId id, const std::byte* bytes, std::size_t count);
  /// Runs a step of the caller's code; its first failure becomes the cause.
  void Try(const std::function<void()>& step);
  void Fail(const std::string& cause);

  Messenger& Messages;
  const BlockDirectory& Directory;
  Locate Find;
  std::uint32_t Session = 0;
  bool SourceIsDry = false;
  int Finished = 0; ///< ranks, this one included, that have no more fragments
  std::string Cause;
};

} // namespace dsm

#endif
