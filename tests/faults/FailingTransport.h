// SPDX-License-Identifier: BSD-3-Clause
#ifndef FailingTransport_h
#define FailingTransport_h

#include "tests/faults/FaultInjection.h"

#include "DSMCore/base/Error.h"
#include "DSMCore/transport/Transport.h"

#include <memory>
#include <utility>

/// Another transport, whose Post can be made to fail (FaultInjection::Kind::Message).
class FailingTransport final : public dsm::Transport
{
public:
  explicit FailingTransport(std::unique_ptr<dsm::Transport> carrier)
    : Carrier(std::move(carrier))
  {
  }
  int GetRank() const override { return this->Carrier->GetRank(); }
  int GetSize() const override { return this->Carrier->GetSize(); }
  void Post(int destination, dsm::Message message) override
  {
    if (FaultInjection::Strikes(FaultInjection::Kind::Message))
    {
      throw dsm::Error("the network is down");
    }
    this->Carrier->Post(destination, std::move(message));
  }
  bool Progress(const Deliver& deliver) override { return this->Carrier->Progress(deliver); }
  std::size_t GetUnsentBytes() const override { return this->Carrier->GetUnsentBytes(); }
  bool HasUnsent(dsm::MessageKind kind) const override { return this->Carrier->HasUnsent(kind); }

private:
  std::unique_ptr<dsm::Transport> Carrier;
};

#endif
