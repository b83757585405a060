// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_LoopbackTransport_h
#define dsm_LoopbackTransport_h

#include "DSMCore/transport/Transport.h"

#include <memory>
#include <vector>

namespace dsm
{

/// Ranks within one process. A group of one serves the application without MPI; a larger group,
/// each member driven by a thread of its own, lets tests play a cluster.
class LoopbackTransport final : public Transport
{
public:
  /// `size` transports that reach one another; they may be used from different threads, each from
  /// one at a time.
  static std::vector<std::unique_ptr<Transport>> CreateGroup(int size);

  ~LoopbackTransport() override;
  int GetRank() const override;
  int GetSize() const override;
  void Post(int destination, Message message) override;
  bool Progress(const Deliver& deliver) override;
  std::size_t GetUnsentBytes() const override;
  /// Always false: a posted message lies with its receiver already.
  bool HasUnsent(MessageKind kind) const override;

private:
  struct Group;
  LoopbackTransport(std::shared_ptr<Group> group, int rank);

  std::shared_ptr<Group> Members;
  int Rank;
};

} // namespace dsm

#endif
