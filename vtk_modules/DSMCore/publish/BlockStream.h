// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_BlockStream_h
#define dsm_BlockStream_h

#include "DSMCore/base/Block.h"
#include "DSMCore/base/FirstFailure.h"
#include "DSMCore/base/FunctionRef.h"
#include "DSMCore/transport/Messenger.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace dsm
{

/// Moves bytes of blocks between the ranks while they are published, in a bounded stream: a rank posts
/// the next only while few of its bytes wait for their receivers. Communication thread, once, one
/// stream at a time.
class BlockStream
{
public:
  /// Bytes on their way out at which a rank stops to post more.
  static constexpr std::size_t MaximumUnsentBytes = std::size_t(8) << 20;

  /// Called for what has come from another rank; may throw.
  using Take = FunctionRef<void(int source, BlockId id, const std::byte* bytes, std::size_t count)>;

  /// The session must have been begun for it.
  BlockStream(Messenger& messenger, Take take);
  ~BlockStream();
  BlockStream(const BlockStream&) = delete;
  BlockStream& operator=(const BlockStream&) = delete;

  /// Within `feed`.
  void Post(int destination, BlockId id, std::vector<std::byte>&& bytes);

  /// Collective. `feed` posts a little, and returns false when there is nothing left. Returns when every rank has
  /// posted all, and all of it has come. When anything throws on this rank, the rank stops posting and discards
  /// what comes, until all others are done too. Returns the failure of this rank; the caller has to let the ranks
  /// agree.
  FirstFailure Run(FunctionRef<bool()> feed);

private:
  bool Work(FunctionRef<bool()> feed);
  bool TellEnd();
  bool IsOver() const;
  void Receive(Message&& message);

  Messenger& Messages;
  Take Sink;
  std::uint32_t Session;
  bool IsDry = false; ///< all is posted that there is on this rank
  int Told = 0;       ///< ranks below know so
  int Finished = 0;   ///< ranks, this one included, that have posted all
  FirstFailure Failure;
};

} // namespace dsm

#endif
