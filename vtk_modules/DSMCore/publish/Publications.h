// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_Publications_h
#define dsm_Publications_h

#include "DSMCore/transport/Messenger.h"

#include <cstdint>
#include <memory>
#include <typeindex>
#include <vector>

namespace dsm
{

/// Publications of a group's ranks, by the data that they were made of. A publisher of the same
/// data shares the existing publication, so that two views of a dataset share its bricks. Keeps
/// nothing alive. Communication thread only.
class Publications
{
public:
  /// Collective. Returns the publication that was added for `content` on every rank and is still used; null if
  /// there is none. `content` identifies the data of this rank's part, so it differs from rank to rank.
  template <class T>
  std::shared_ptr<const T> Find(Messenger& messenger, std::uint64_t content)
  {
    return std::static_pointer_cast<const T>(this->FindAny(messenger, typeid(T), content));
  }

  /// Local, in the same order on every rank.
  template <class T>
  void Add(std::uint64_t content, const std::shared_ptr<const T>& published)
  {
    this->Entries.push_back({ this->Next++, typeid(T), content, published });
  }

  /// Local: nothing is found any more. For when the ranks may have added different things.
  void Forget();

private:
  std::shared_ptr<const void> FindAny(
    Messenger& messenger, std::type_index type, std::uint64_t content);

  struct Entry
  {
    std::uint64_t Number; ///< the same on every rank
    std::type_index Type;
    std::uint64_t Content;
    std::weak_ptr<const void> Published;
  };
  std::vector<Entry> Entries;
  std::uint64_t Next = 0;
};

} // namespace dsm

#endif
