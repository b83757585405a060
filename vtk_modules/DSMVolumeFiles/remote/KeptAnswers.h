// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_KeptAnswers_h
#define vol_KeptAnswers_h

#include "DSMVolumeFiles/base/ByteBuffer.h"
#include "DSMVolumeFiles/base/Descriptor.h"
#include "DSMVolumeFiles/remote/HttpHead.h"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>

namespace vol
{

/// Bodies of answers in the user's cache folder ("http" in it), for all processes of all hosts that share it. The
/// files that were asked for the longest ago leave when they exceed a limit. Any thread; nothing here is an error: what
/// cannot be kept is asked for again.
class KeptAnswers
{
public:
  /// Returns the process's cache, of $DSM_HTTP_CACHE_MIB (4096) MiB. 0: nothing is kept.
  static KeptAnswers& GetShared();

  /// `folder`: empty: nothing is kept.
  KeptAnswers(std::filesystem::path folder, std::uint64_t most);

  using Time = std::filesystem::file_time_type;
  struct Kept
  {
    HttpValidator Validator;
    std::uint64_t Total = 0; ///< bytes of the key
    ByteBuffer Body;
    Time Checked; ///< when the server said last that it is so
  };
  /// `name`: an address, and which part of it. Nothing where there is no such file, it is damaged, or its body is
  /// longer than `most`.
  std::optional<Kept> Find(const std::string& name, std::uint64_t most) const;
  /// Keeps an answer, if the server will tell when it changes.
  void Keep(const std::string& name, const HttpValidator& validator, std::uint64_t total,
    const ByteBuffer& body);
  /// The server says that it is still so.
  void Confirm(const std::string& name) const;
  /// The bytes are not what they should be.
  void Drop(const std::string& name) const;

  /// As long as it is in scope, no other thread or process has a claim to the same name: the second one finds what the
  /// first one keeps. Who waits for longer than `limit` continues without.
  class Claim
  {
  public:
    Claim(const KeptAnswers& answers, const std::string& name, std::chrono::seconds limit);

  private:
    Descriptor File;
  };

private:
  std::filesystem::path GetPath(const std::string& name) const;
  void MakeRoom();

  std::filesystem::path Folder;
  std::uint64_t Most;
  std::mutex Guard;
  std::uint64_t Written; ///< since there was room last
};

} // namespace vol

#endif
