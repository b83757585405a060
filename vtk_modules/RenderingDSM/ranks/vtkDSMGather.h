// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMGather_h
#define vtkDSMGather_h

#include "DSMCore/transport/Messenger.h"

#include <cstddef>
#include <cstring>
#include <type_traits>
#include <utility>
#include <vector>

/// Lists of plain values from all ranks.
class vtkDSMGather
{
public:
  /// Collective: every rank's items, in rank order; `first` is where this rank's begin.
  template <class T>
  static std::vector<T> Items(dsm::Messenger& messenger, const std::vector<T>& mine, int& first)
  {
    static_assert(std::is_trivially_copyable_v<T>, "only plain values travel");
    std::vector<std::byte> bytes(mine.size() * sizeof(T));
    if (!mine.empty())
    {
      std::memcpy(bytes.data(), mine.data(), bytes.size());
    }
    const auto parts = messenger.AllGather(std::move(bytes));
    std::vector<T> all;
    for (int rank = 0; rank < static_cast<int>(parts.size()); ++rank)
    {
      if (rank == messenger.GetRank())
      {
        first = static_cast<int>(all.size());
      }
      const std::size_t offset = all.size();
      const std::size_t count = parts[rank].size() / sizeof(T);
      all.resize(offset + count);
      if (count > 0)
      {
        std::memcpy(&all[offset], parts[rank].data(), count * sizeof(T));
      }
    }
    return all;
  }

  template <class T>
  static std::vector<T> Items(dsm::Messenger& messenger, const std::vector<T>& mine)
  {
    int first = 0;
    return Items(messenger, mine, first);
  }
};

#endif
