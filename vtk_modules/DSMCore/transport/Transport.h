// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_Transport_h
#define dsm_Transport_h

#include "DSMCore/transport/Message.h"

#include <cstddef>
#include <functional>

namespace dsm
{

/// Carries messages between ranks. Two messages from one rank to another arrive in the order they
/// were posted. Only the thread that renders (the communication thread of the frame) may call it:
/// ParaView initializes MPI with MPI_THREAD_SINGLE.
class Transport
{
public:
  using Deliver = std::function<void(Message&&)>;

  virtual ~Transport() = default;

  virtual int GetRank() const = 0;
  virtual int GetSize() const = 0;

  /// Starts to send; never waits. A message to the own rank is delivered by the next Progress.
  virtual void Post(int destination, Message message) = 0;

  /// Moves what can be moved without waiting, and hands every message that has arrived to
  /// `deliver`, which may Post; what it does not take, because it throws, comes again. Returns whether
  /// anything was sent or received.
  virtual bool Progress(const Deliver& deliver) = 0;

  /// Bytes posted that the receivers have not begun to take; what flow control watches.
  virtual std::size_t GetUnsentBytes() const = 0;

  /// Returns whether a message of this kind, or the acknowledgment for its sender, still needs this
  /// rank's Progress to be sent. A rank that ends a collective step and then computes for long
  /// would delay the others.
  virtual bool HasUnsent(MessageKind kind) const = 0;
};

} // namespace dsm

#endif
