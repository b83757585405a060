// SPDX-License-Identifier: BSD-3-Clause
#ifndef LimitedCluster_h
#define LimitedCluster_h

#include "DSMCore/base/Error.h"
#include "DSMCore/transport/Messenger.h"
#include "tests/support/LoopbackCluster.h"

#include <cstddef>
#include <memory>
#include <string>
#include <utility>

/// What a collective sends is limited as MPI limits it, only to much less.
class LimitedTransport final : public dsm::Transport
{
public:
  LimitedTransport(std::unique_ptr<dsm::Transport> carrier, std::size_t limit)
    : Carrier(std::move(carrier))
    , Limit(limit)
  {
  }
  int GetRank() const override { return this->Carrier->GetRank(); }
  int GetSize() const override { return this->Carrier->GetSize(); }
  void Post(int destination, dsm::Message message) override
  {
    if (message.Kind == dsm::MessageKind::Collective && message.Payload.size() > this->Limit)
    {
      throw dsm::Error("A message of " + std::to_string(message.Payload.size()) + " bytes");
    }
    this->Carrier->Post(destination, std::move(message));
  }
  bool Progress(const Deliver& deliver) override { return this->Carrier->Progress(deliver); }
  std::size_t GetUnsentBytes() const override { return this->Carrier->GetUnsentBytes(); }
  bool HasUnsent(dsm::MessageKind kind) const override { return this->Carrier->HasUnsent(kind); }

private:
  std::unique_ptr<dsm::Transport> Carrier;
  std::size_t Limit;
};

/// RunOnCluster with collectives in pieces of at most `pieceBytes`; a message may have as much again for
/// what goes with them.
inline void RunOnLimitedCluster(
  int ranks, std::size_t pieceBytes, const std::function<void(dsm::Messenger&)>& program)
{
  RunOnCluster(ranks, program,
    [pieceBytes](std::unique_ptr<dsm::Transport> transport)
    {
      return std::make_unique<dsm::Messenger>(
        std::make_unique<LimitedTransport>(std::move(transport), 2 * pieceBytes), pieceBytes);
    });
}

#endif
