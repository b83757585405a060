// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_HttpClient_h
#define vol_HttpClient_h

#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/ByteBuffer.h"
#include "DSMVolumeFiles/remote/HttpHead.h"
#include "DSMVolumeFiles/remote/RemotePlace.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace vol
{

/// How long a server may take. Any thread may change them, for requests that begin afterwards.
struct HttpLimits
{
  /// To connect, and, from then on, without more than a trickle of bytes: at most 100 in a second.
  int Seconds = 15;
  /// Attempts in all, where a failure may pass; none begins later than Seconds after the first one.
  int Attempts = 5;
  double ErrorSeconds = 3.0; ///< how long an error is the answer to the same request
  double FirstPause = 0.25;  ///< in seconds; each further pause is twice as long

  /// The process's limits. $DSM_HTTP_SECONDS replaces Seconds.
  static HttpLimits Get();
  static void Set(const HttpLimits& limits);
};

/// Asks servers for keys, by libcurl, with its settings for proxies and certificates ($https_proxy, $SSL_CERT_FILE)
/// and ~/.netrc. Any thread, several at the same time: each waits for its own answer.
namespace HttpClient
{

struct Request
{
  std::string Path;               ///< for messages, and for Place
  std::optional<HttpRange> Range; ///< none: all of the key
  HttpValidator If;       ///< the body is wanted only where the key differs; empty: in any case
  std::uint64_t Most = 0; ///< a longer body is an error
};

enum class Outcome
{
  Here,
  Unchanged,
  Missing ///< the server says 404
};

struct Answer
{
  Outcome How = Outcome::Here;
  HttpValidator Validator;
  std::uint64_t Total = 0; ///< bytes of the key
  ByteBuffer Body;
};

/// The server answers 401 or 403.
class Refusal final : public dsm::Error
{
public:
  using dsm::Error::Error;
};

/// Returns the server's answer. Throws dsm::Error, which names the address and the cause, for everything else: after
/// some attempts with growing pauses where it may pass. `goesOn`, which may be empty, is called now and then; if it
/// returns false, that is an error, too. No other host gets credentials, wherever the server leads.
Answer Get(
  const RemotePlace& place, const Request& request, const std::function<bool()>& goesOn = {});

} // namespace HttpClient

} // namespace vol

#endif
