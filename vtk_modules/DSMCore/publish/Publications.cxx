// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/publish/Publications.h"

#include <algorithm>
#include <cstddef>
#include <cstring>

namespace dsm
{

std::shared_ptr<const void> Publications::FindAny(
  Messenger& messenger, std::type_index type, std::uint64_t content)
{
  const auto all = messenger.GatherTogether("Finding published data",
    [&]
    {
      this->Entries.erase(std::remove_if(this->Entries.begin(), this->Entries.end(),
                            [](const Entry& entry) { return entry.Published.expired(); }),
        this->Entries.end());
      std::vector<std::byte> mine;
      for (const Entry& entry : this->Entries)
      {
        if (entry.Type == type && entry.Content == content)
        {
          AttachTail(mine, entry.Number);
        }
      }
      return mine;
    });
  const auto isEverywhere = [&](std::uint64_t number)
  {
    return std::all_of(all.begin(), all.end(),
      [=](const std::vector<std::byte>& numbers)
      {
        bool found = false;
        for (std::size_t at = 0; at + sizeof(number) <= numbers.size(); at += sizeof(number))
        {
          found = found || std::memcmp(&numbers[at], &number, sizeof(number)) == 0;
        }
        return found;
      });
  };
  for (const Entry& entry : this->Entries)
  {
    if (entry.Type == type && entry.Content == content && isEverywhere(entry.Number))
    {
      return entry.Published.lock();
    }
  }
  return nullptr;
}

void Publications::Forget()
{
  this->Entries.clear();
  this->Next = 0;
}

} // namespace dsm
