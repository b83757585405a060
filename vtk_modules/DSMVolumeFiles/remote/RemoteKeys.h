// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_RemoteKeys_h
#define vol_RemoteKeys_h

#include "DSMBricks/base/ByteHash.h"
#include "DSMVolumeFiles/base/ByteSource.h"
#include "DSMVolumeFiles/remote/HttpClient.h"
#include "DSMVolumeFiles/remote/KeptAnswers.h"
#include "DSMVolumeFiles/remote/RemotePlace.h"

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>

namespace vol
{

/// The keys of a store that a server has, as they are while a volume is open: one that changes meanwhile is an error.
/// Bodies come from KeptAnswers where the server says that they are still right, or said so, to any process, since the
/// volume was opened. Any thread; throws WouldWait (WithoutWaiting).
class RemoteKeys : public std::enable_shared_from_this<RemoteKeys>
{
public:
  /// `goesOn`: see HttpClient::Get; until EndOpening. `openedAt`: when the volume was opened, of which this is another
  /// level; none: now.
  RemoteKeys(const std::string& url, std::function<bool()> goesOn,
    const std::optional<KeptAnswers::Time>& openedAt);
  void EndOpening() { this->GoesOn = nullptr; }

  const std::string& GetRoot() const { return this->Place.GetRoot(); }

  /// Returns all bytes of a key, of at most so many; null where the server says that there is none. Throws dsm::Error,
  /// which names the address.
  std::shared_ptr<const StampedSource> Fetch(const std::string& path, std::uint64_t most) const;
  /// Returns a key of which parts are read when they are asked for; null likewise. `first`: what is asked for first.
  std::shared_ptr<const StampedSource> Open(const std::string& path, const HttpRange& first) const;
  /// Throws dsm::Error when a key is gone, or was changed, since it was read. Asks the server at most once a second.
  void CheckThere(const std::string& path) const;
  /// Adds what the server said of a key that was fetched, the time of its last change included: what is written anew
  /// may have other things beside it.
  void AddStamp(const std::string& path, bricks::ByteHash& hash) const;

private:
  struct Known
  {
    HttpValidator Validator;
    std::uint64_t Total;
  };
  class Parts;

  /// Returns what was there when the key was read first, in this opening; none: it was not read yet, or long ago.
  std::optional<Known> Find(const std::string& path) const;
  /// Throws dsm::Error where something else was there before.
  void Note(const std::string& path, const Known& now) const;
  struct Answer
  {
    Known Of;
    ByteBuffer Body;
  };
  /// Returns a key, or a part of it, of at most so many bytes: what is kept of it, where that is right, or what the
  /// server sends; nothing where it says that there is none.
  std::optional<Answer> Ask(
    const std::string& path, const std::optional<HttpRange>& range, std::uint64_t most) const;
  /// Returns the name of what is kept of a key: the address that is asked, as one bucket may be on several servers.
  std::string NameKept(const std::string& path, const std::optional<HttpRange>& range) const;
  static std::uint64_t GetStampOf(const Known& known);

  RemotePlace Place;
  std::function<bool()> GoesOn;
  KeptAnswers& Kept;
  KeptAnswers::Time OpenedAt;

  mutable std::mutex Guard;
  mutable std::unordered_map<std::string, Known> Keys; ///< by path
  mutable std::chrono::steady_clock::time_point CheckedAt;
};

} // namespace vol

#endif
