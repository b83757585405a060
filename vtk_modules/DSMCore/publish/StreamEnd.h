// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_StreamEnd_h
#define dsm_StreamEnd_h

#include "DSMCore/transport/Messenger.h"

#include <cstdint>
#include <utility>

namespace dsm
{

/// Tells when every rank has sent all that it had to send in this session, and all of it has come:
/// each says so to every other, behind its last message. Communication thread.
class StreamEnd
{
public:
  /// Of messages of this kind; the session must have begun.
  StreamEnd(Messenger& messenger, MessageKind kind)
    : Messages(messenger)
    , Kind(kind)
    , Session(messenger.GetSession())
  {
    this->Messages.SetHandler(MessageKind::PublishDone,
      [this](Message&& message) { this->Finished += message.Session == this->Session ? 1 : 0; });
  }
  ~StreamEnd()
  {
    this->Messages.SetHandler(this->Kind, {});
    this->Messages.SetHandler(MessageKind::PublishDone, {});
  }
  StreamEnd(const StreamEnd&) = delete;
  StreamEnd& operator=(const StreamEnd&) = delete;

  std::uint32_t GetSession() const { return this->Session; }

  /// This rank has sent all. Called again after it has thrown, it tells those who do not know yet;
  /// returns whether there was anything to do.
  bool Tell()
  {
    const int size = this->Messages.GetSize();
    if (this->Told == size)
    {
      return false;
    }
    for (; this->Told < size; ++this->Told)
    {
      if (this->Told != this->Messages.GetRank())
      {
        this->Messages.Post(this->Told, MessageKind::PublishDone, {});
      }
    }
    ++this->Finished;
    return true;
  }

  /// The own messages must have left, too: whoever waits for them gets no help from this rank while it
  /// goes about something else.
  bool IsReached() const
  {
    return this->Finished == this->Messages.GetSize() && !this->Messages.HasUnsent(this->Kind) &&
      !this->Messages.HasUnsent(MessageKind::PublishDone);
  }

private:
  Messenger& Messages;
  MessageKind Kind;
  std::uint32_t Session;
  int Told = 0;     ///< ranks below know that this one has sent all
  int Finished = 0; ///< ranks, this one included, that have sent all
};

} // namespace dsm

#endif
