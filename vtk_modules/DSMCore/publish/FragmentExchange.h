// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_FragmentExchange_h
#define dsm_FragmentExchange_h

#include "DSMCore/base/FirstFailure.h"
#include "DSMCore/base/FunctionRef.h"
#include "DSMCore/publish/BlockSegment.h"
#include "DSMCore/publish/Publication.h"
#include "DSMCore/publish/StreamEnd.h"
#include "DSMCore/transport/Messenger.h"

namespace dsm
{

/// Moves the fragments of every rank to the owners of their blocks, in a bounded stream: a rank
/// takes the next fragment from its source only while few of its bytes wait for their receivers.
/// The same for every organisation of memory. Communication thread, one exchange at a time.
class FragmentExchange
{
public:
  /// Bytes on their way out at which a rank stops to produce more.
  static constexpr std::size_t MaximumUnsentBytes = std::size_t(8) << 20;

  FragmentExchange(Messenger& messenger, const BlockSegment& segment, FragmentSink& sink);
  ~FragmentExchange();
  FragmentExchange(const FragmentExchange&) = delete;
  FragmentExchange& operator=(const FragmentExchange&) = delete;

  /// Collective; the session must have been begun for it. Returns when every rank's fragments have
  /// been absorbed. When source, sink or progress throw on this rank, it contributes no more and
  /// discards what comes, until all others are done too; it is for the caller to let the ranks agree.
  void Run(FragmentSource& source, FunctionRef<void(double)> progress);
  /// Throws what went wrong on this rank, if anything did.
  void ThrowFailure() const { this->Failure.Throw(); }

private:
  bool Feed(FragmentSource& source);
  void Send(Fragment& fragment);
  void Receive(Message&& message);
  void Absorb(BlockId id, const std::byte* bytes, std::size_t count);

  Messenger& Messages;
  const BlockSegment& Segment;
  FragmentSink& Sink;
  StreamEnd End;
  bool SourceIsDry = false;
  FirstFailure Failure;
};

} // namespace dsm

#endif
