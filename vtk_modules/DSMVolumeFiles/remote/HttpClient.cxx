// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/remote/HttpClient.h"

#include "DSMVolumeFiles/base/BytesFromServers.h"
#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/SmallFile.h"
#include "DSMVolumeFiles/base/Url.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <map>
#include <mutex>
#include <new>
#include <random>
#include <thread>
#include <utility>
#include <vector>

#ifdef DSM_HAS_CURL
#include <curl/curl.h>
#endif

namespace vol
{

namespace
{

using HttpClock = std::chrono::steady_clock;

std::mutex LimitsGuard;

HttpLimits& GetLimitsOfProcess()
{
  static HttpLimits limits = []
  {
    HttpLimits made;
    const char* const seconds = std::getenv("DSM_HTTP_SECONDS");
    const int given = seconds ? std::atoi(seconds) : 0;
    made.Seconds = given > 0 ? std::min(given, 3600) : made.Seconds;
    return made;
  }();
  return limits;
}

#ifdef DSM_HAS_CURL

constexpr long LeastBytesPerSecond = 100;
/// However fast it is; a chunk has at most some hundred MiB.
constexpr long MostSecondsOfTransfer = 600;
constexpr int MostRedirects = 5;
constexpr double LongestPause = 10.0; ///< that a server may ask for
constexpr std::size_t MostKeptPools = 32;
constexpr long MostIdleConnections = 4; ///< of each
constexpr int PollMilliseconds = 100;   ///< from one look at the caller's wishes to the next

/// Connections, and what they share. Each transfer has a handle of its own: up to libcurl 8.2, one that is used again
/// reads freed memory when a server's first header begins with a blank.
class ConnectionPool
{
public:
  static ConnectionPool& GetShared()
  {
    static auto* const pool =
      new ConnectionPool; // threads may be at a transfer when the process ends
    return *pool;
  }

  /// Open connections of former transfers, for one at a time.
  CURLM* Take()
  {
    {
      const std::lock_guard<std::mutex> lock(this->Guard);
      if (!this->Free.empty())
      {
        CURLM* const taken = this->Free.back();
        this->Free.pop_back();
        return taken;
      }
    }
    CURLM* const made = curl_multi_init();
    if (!made)
    {
      throw std::bad_alloc();
    }
    curl_multi_setopt(made, CURLMOPT_MAXCONNECTS, MostIdleConnections);
    return made;
  }

  void Return(CURLM* connections)
  {
    {
      const std::lock_guard<std::mutex> lock(this->Guard);
      if (this->Free.size() < MostKeptPools)
      {
        this->Free.push_back(connections);
        return;
      }
    }
    curl_multi_cleanup(connections);
  }

  CURLSH* GetNames() const { return this->Share; }

private:
  ConnectionPool()
  {
    curl_global_init(CURL_GLOBAL_DEFAULT);
    this->Free.reserve(MostKeptPools);
    this->Share = curl_share_init();
    curl_share_setopt(this->Share, CURLSHOPT_USERDATA, this);
    curl_share_setopt(
      this->Share, CURLSHOPT_LOCKFUNC,
      +[](CURL*, curl_lock_data data, curl_lock_access, void* self)
      { static_cast<ConnectionPool*>(self)->Locks[data].lock(); });
    curl_share_setopt(
      this->Share, CURLSHOPT_UNLOCKFUNC,
      +[](CURL*, curl_lock_data data, void* self)
      { static_cast<ConnectionPool*>(self)->Locks[data].unlock(); });
    curl_share_setopt(this->Share, CURLSHOPT_SHARE, CURL_LOCK_DATA_DNS);
    curl_share_setopt(this->Share, CURLSHOPT_SHARE, CURL_LOCK_DATA_SSL_SESSION);
  }

  std::mutex Guard;
  std::vector<CURLM*> Free;
  CURLSH* Share = nullptr;
  std::mutex Locks[CURL_LOCK_DATA_LAST];
};

/// One request to one address, without what it may lead to.
class Transfer
{
public:
  Transfer(const RemotePlace& place, const HttpClient::Request& request, std::string address,
    bool withCredentials, const std::function<bool()>& goesOn)
    : Wanted(request)
    , GoesOn(goesOn)
    , Address(std::move(address))
    , Handle(curl_easy_init())
  {
    if (!this->Handle)
    {
      throw std::bad_alloc();
    }
    this->SetOptions(withCredentials ? &place.GetSignature() : nullptr);
  }
  ~Transfer()
  {
    curl_easy_cleanup(this->Handle);
    curl_slist_free_all(this->Lines);
  }
  Transfer(const Transfer&) = delete;
  Transfer& operator=(const Transfer&) = delete;

  /// How it went. Any of the texts is empty where it does not apply.
  struct Result
  {
    std::string Failure;
    bool MayPass = false;   ///< another attempt may go well
    bool IsRefusal = false; ///< 401 or 403
    std::string Redirect;
  };
  Result Run()
  {
    const CURLcode code = this->Perform();
    Result result;
    if (this->IsAborted)
    {
      throw dsm::Error("Opening '" + this->Wanted.Path + "' was aborted.");
    }
    if (this->IsOutOfMemory)
    {
      throw std::bad_alloc();
    }
    if (this->IsTooLong)
    {
      result.Failure =
        "it has more than the " + std::to_string(this->Wanted.Most) + " bytes that it may have";
      return result;
    }
    if (code != CURLE_OK && !this->IsEnough)
    {
      result.Failure = *this->Text ? this->Text : curl_easy_strerror(code);
      while (
        !result.Failure.empty() && (result.Failure.back() == '.' || result.Failure.back() == '\n'))
      {
        result.Failure.pop_back();
      }
      result.MayPass = MayPass(code);
      if (code == CURLE_COULDNT_RESOLVE_HOST)
      {
        result.Failure += ". Is this computer online, and is the name right?";
      }
      return result;
    }
    this->Judge(result);
    return result;
  }

  HttpHead Head;
  ByteBuffer Body;

private:
  CURLcode Perform()
  {
    ConnectionPool& pool = ConnectionPool::GetShared();
    CURLM* const connections = pool.Take();
    CURLcode code = CURLE_FAILED_INIT;
    CURLMcode state = curl_multi_add_handle(connections, this->Handle);
    for (int running = 1; state == CURLM_OK && running > 0;)
    {
      state = curl_multi_perform(connections, &running);
      if (state == CURLM_OK && running > 0)
      {
        this->Ask();
        if (this->IsAborted)
        {
          break;
        }
        state = curl_multi_poll(connections, nullptr, 0, PollMilliseconds, nullptr);
      }
    }
    int left = 0;
    while (const CURLMsg* const told = curl_multi_info_read(connections, &left))
    {
      code = told->msg == CURLMSG_DONE ? told->data.result : code;
    }
    curl_multi_remove_handle(connections, this->Handle);
    pool.Return(connections);
    return code;
  }

  static bool MayPass(CURLcode code)
  {
    constexpr CURLcode passing[] = { CURLE_COULDNT_RESOLVE_PROXY, CURLE_COULDNT_RESOLVE_HOST,
      CURLE_COULDNT_CONNECT, CURLE_OPERATION_TIMEDOUT, CURLE_GOT_NOTHING, CURLE_SEND_ERROR,
      CURLE_RECV_ERROR, CURLE_PARTIAL_FILE, CURLE_SSL_CONNECT_ERROR, CURLE_HTTP2,
      CURLE_HTTP2_STREAM, CURLE_AGAIN };
    return std::count(std::begin(passing), std::end(passing), code) > 0;
  }

  static std::string NameStatus(int status)
  {
    static const std::map<int, const char*> names = { { 400, "Bad Request" },
      { 401, "Unauthorized" }, { 403, "Forbidden" }, { 404, "Not Found" },
      { 405, "Method Not Allowed" }, { 408, "Request Timeout" }, { 410, "Gone" },
      { 416, "Range Not Satisfiable" }, { 429, "Too Many Requests" },
      { 500, "Internal Server Error" }, { 501, "Not Implemented" }, { 502, "Bad Gateway" },
      { 503, "Service Unavailable" }, { 504, "Gateway Timeout" } };
    const auto known = names.find(status);
    return std::to_string(status) + (known == names.end() ? "" : std::string(" ") + known->second);
  }

  void Judge(Result& result)
  {
    const int status = this->Head.Status;
    char* redirect = nullptr;
    curl_easy_getinfo(this->Handle, CURLINFO_REDIRECT_URL, &redirect);
    if (redirect)
    {
      result.Redirect = redirect;
      return;
    }
    if (status == 404 || (status == 304 && !this->Wanted.If.IsEmpty()))
    {
      return;
    }
    if (status == 200 || status == 206)
    {
      result.Failure = this->Head.Check(this->Wanted.Range, this->Body.size());
      return;
    }
    result.Failure = "the server answers " + NameStatus(status);
    result.MayPass = status >= 500 || status == 408 || status == 425 || status == 429;
    if (status == 401 || status == 403)
    {
      result.IsRefusal = true;
      result.Failure += ". It wants credentials, or others than it gets; S3 says so, too, where a "
                        "key is missing and its bucket may not be listed";
    }
    if (!this->Head.Region.empty())
    {
      result.Failure +=
        ". The bucket is in the region " + Quote(this->Head.Region) + ": set AWS_REGION";
    }
  }

  void AddLine(const std::string& line)
  {
    curl_slist* const longer = curl_slist_append(this->Lines, line.c_str());
    if (!longer)
    {
      throw std::bad_alloc();
    }
    this->Lines = longer;
  }

  template <class Value>
  void Set(CURLoption option, Value value)
  {
    curl_easy_setopt(this->Handle, option, value);
  }

  void SetOptions(const RemotePlace::Signature* credentials)
  {
    const HttpLimits limits = HttpLimits::Get();
    this->Set(CURLOPT_SHARE, ConnectionPool::GetShared().GetNames());
    this->Set(CURLOPT_URL, this->Address.c_str());
#if LIBCURL_VERSION_NUM >= 0x075500
    this->Set(CURLOPT_PROTOCOLS_STR, "http,https");
    this->Set(CURLOPT_REDIR_PROTOCOLS_STR, "http,https");
#else
    this->Set(CURLOPT_PROTOCOLS, long(CURLPROTO_HTTP | CURLPROTO_HTTPS));
    this->Set(CURLOPT_REDIR_PROTOCOLS, long(CURLPROTO_HTTP | CURLPROTO_HTTPS));
#endif
    this->Set(CURLOPT_FOLLOWLOCATION, 0L);
    this->Set(CURLOPT_NOSIGNAL, 1L);
    this->Set(CURLOPT_CONNECTTIMEOUT, long(limits.Seconds));
    this->Set(CURLOPT_LOW_SPEED_TIME, long(limits.Seconds));
    this->Set(CURLOPT_LOW_SPEED_LIMIT, LeastBytesPerSecond);
    this->Set(CURLOPT_TIMEOUT, MostSecondsOfTransfer);
    this->Set(CURLOPT_SUPPRESS_CONNECT_HEADERS, 1L);
    this->Set(CURLOPT_USERAGENT, "dsm-ray-tracer");
    this->Set(CURLOPT_ERRORBUFFER, this->Text);
    this->Set(CURLOPT_HEADERDATA, this);
    this->Set(
      CURLOPT_HEADERFUNCTION,
      +[](char* bytes, std::size_t size, std::size_t count, void* self) -> std::size_t
      { return static_cast<Transfer*>(self)->TakeLine(bytes, size * count); });
    this->Set(CURLOPT_WRITEDATA, this);
    this->Set(
      CURLOPT_WRITEFUNCTION,
      +[](char* bytes, std::size_t size, std::size_t count, void* self) -> std::size_t
      { return static_cast<Transfer*>(self)->TakeBytes(bytes, size * count); });
    // As the program curl has them.
    for (const char* name : { "CURL_CA_BUNDLE", "SSL_CERT_FILE" })
    {
      const char* const file = std::getenv(name);
      if (file && *file)
      {
        this->Set(CURLOPT_CAINFO, file);
        break;
      }
    }
    this->SetRequest(credentials);
  }

  void SetRequest(const RemotePlace::Signature* credentials)
  {
    if (this->Wanted.Range)
    {
      this->Set(CURLOPT_RANGE, this->Wanted.Range->Write().c_str());
    }
    const HttpValidator& known = this->Wanted.If;
    if (!known.IsEmpty())
    {
      this->AddLine(
        known.Tag.empty() ? "If-Modified-Since: " + known.Modified : "If-None-Match: " + known.Tag);
    }
    if (credentials && credentials->Key.empty())
    {
      this->Set(CURLOPT_NETRC, long(CURL_NETRC_OPTIONAL));
    }
    else if (credentials)
    {
      const std::string provider = "aws:amz:" + credentials->Region + ":s3";
      this->Set(CURLOPT_AWS_SIGV4, provider.c_str());
      this->Set(CURLOPT_USERNAME, credentials->Key.c_str());
      this->Set(CURLOPT_PASSWORD, credentials->Secret.c_str());
      // Of no bytes.
      this->AddLine("x-amz-content-sha256: "
                    "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
      if (!credentials->Token.empty())
      {
        this->AddLine("x-amz-security-token: " + credentials->Token);
      }
    }
    this->Set(CURLOPT_HTTPHEADER, this->Lines);
  }

  /// Returns so many that libcurl goes on, or others.
  std::size_t TakeLine(const char* bytes, std::size_t count)
  {
    try
    {
      this->Head.Add(bytes, count);
      const bool isLast = count <= 2 && (count == 0 || *bytes == '\r' || *bytes == '\n');
      if (isLast && this->Head.Status == 200)
      {
        if (this->Wanted.Range && this->Head.Length.value_or(1) > 0)
        {
          this->Head.Length.reset(); // of what does not come any more
          this->IsEnough = true;
          return count + 1;
        }
        const std::uint64_t length = this->Head.Length.value_or(0);
        if (length > this->Wanted.Most)
        {
          this->IsTooLong = true;
          return count + 1;
        }
        this->Body.reserve(static_cast<std::size_t>(length));
      }
      return count;
    }
    catch (const std::bad_alloc&)
    {
      this->IsOutOfMemory = true;
      return count + 1;
    }
  }

  std::size_t TakeBytes(const char* bytes, std::size_t count)
  {
    if (this->Head.Status != 200 && this->Head.Status != 206)
    {
      // What an error says at length. A short one leaves the connection as it is.
      this->Left += count;
      this->IsEnough = this->Left > (1 << 16);
      return this->IsEnough ? 0 : count;
    }
    if (count > this->Wanted.Most - this->Body.size())
    {
      this->IsTooLong = true;
      return 0;
    }
    try
    {
      const auto* const first = reinterpret_cast<const std::byte*>(bytes);
      this->Body.insert(this->Body.end(), first, first + count);
      return count;
    }
    catch (const std::bad_alloc&)
    {
      this->IsOutOfMemory = true;
      return 0;
    }
  }

  void Ask()
  {
    try
    {
      this->IsAborted = this->GoesOn && !this->GoesOn();
    }
    catch (...)
    {
      this->IsAborted = true;
    }
  }

  const HttpClient::Request& Wanted;
  const std::function<bool()>& GoesOn;
  std::string Address;
  CURL* Handle;
  curl_slist* Lines = nullptr;
  char Text[CURL_ERROR_SIZE] = "";
  std::size_t Left = 0;
  bool IsTooLong = false;
  bool IsEnough = false; ///< it was ended here, and the answer is clear
  bool IsAborted = false;
  bool IsOutOfMemory = false;
};

/// Returns scheme, host and port of an address, as it is written.
std::string GetOriginOf(const std::string& address)
{
  const std::size_t host = address.find("://");
  return host == std::string::npos ? std::string()
                                   : ToLower(address.substr(0, address.find('/', host + 3)));
}

/// Errors of a moment ago: a reader that opens again soon fails at once.
class RecentErrors
{
public:
  /// Throws dsm::Error where the same request failed a moment ago.
  static void Check(const std::string& key, double seconds)
  {
    const std::lock_guard<std::mutex> lock(Guard);
    const auto known = Errors.find(key);
    if (known != Errors.end() &&
      HttpClock::now() - known->second.At < std::chrono::duration<double>(seconds))
    {
      throw FileError(known->second.Error);
    }
  }
  static void Note(const std::string& key, const FileError& error)
  {
    const std::lock_guard<std::mutex> lock(Guard);
    if (Errors.size() > 1000)
    {
      Errors.clear();
    }
    Errors.insert_or_assign(key, Entry{ error, HttpClock::now() });
  }

private:
  struct Entry
  {
    FileError Error;
    HttpClock::time_point At;
  };
  static inline std::mutex Guard;
  static inline std::map<std::string, Entry> Errors;
};

/// Returns why the server may not lead from one address to another; empty: it may.
std::string CheckRedirect(const std::string& from, const std::string& to)
{
  const std::string before = GetOriginOf(from);
  const std::string after = GetOriginOf(to);
  const bool isSafe = after.compare(0, 8, "https://") == 0;
  const std::string leads = "the server leads to '" + HideCredentials(to) + "'";
  return !isSafe && after.compare(0, 7, "http://") != 0 ? leads + ", which is not http or https"
    : !isSafe && before.compare(0, 8, "https://") == 0  ? leads + ", which is not safe as https is"
    : after.find('@') != std::string::npos              ? leads + ", which has a password in it"
                                                        : std::string();
}

/// Waits for so long; throws dsm::Error when the caller gives up.
void Wait(double seconds, const std::string& path, const std::function<bool()>& goesOn)
{
  const auto end = HttpClock::now() + std::chrono::duration<double>(seconds);
  for (auto now = HttpClock::now(); now < end; now = HttpClock::now())
  {
    std::this_thread::sleep_for(
      std::min<std::chrono::duration<double>>(end - now, std::chrono::milliseconds(100)));
    if (goesOn && !goesOn())
    {
      throw dsm::Error("Opening '" + path + "' was aborted.");
    }
  }
}

/// Up to twice a pause: those who failed together do not all come back together.
double Spread(double pause)
{
  thread_local std::minstd_rand random(std::random_device{}());
  return pause * std::uniform_real_distribution<double>(1.0, 2.0)(random);
}

/// A request, and those that the server leads to.
Transfer::Result Follow(const RemotePlace& place, const HttpClient::Request& request,
  const std::function<bool()>& goesOn, HttpClient::Answer& answer, double& retryAfter)
{
  const std::string first = place.GetAddress(request.Path);
  std::string address = first;
  for (int redirects = 0;; ++redirects)
  {
    const bool isSame = GetOriginOf(address) == GetOriginOf(first);
    Transfer transfer(place, request, address, isSame, goesOn);
    Transfer::Result result = transfer.Run();
    retryAfter = transfer.Head.RetryAfter;
    if (!isSame && !result.Failure.empty())
    {
      result.Failure += " (at '" + HideCredentials(address) + "', where the server leads)";
    }
    if (result.Redirect.empty())
    {
      using HttpClient::Outcome;
      const int status = transfer.Head.Status;
      answer.How = status == 404 ? Outcome::Missing
        : status == 304          ? Outcome::Unchanged
                                 : Outcome::Here;
      answer.Validator = transfer.Head.Validator;
      answer.Total = transfer.Head.GetTotal(transfer.Body.size());
      answer.Body = std::move(transfer.Body);
      BytesFromServers += answer.Body.size();
      return result;
    }
    const std::string refused = redirects >= MostRedirects
      ? "the server leads from one address to another without end"
      : CheckRedirect(address, result.Redirect);
    if (!refused.empty())
    {
      return { refused, false, false, {} };
    }
    address = result.Redirect;
  }
}

#endif

} // namespace

HttpLimits HttpLimits::Get()
{
  const std::lock_guard<std::mutex> lock(LimitsGuard);
  return GetLimitsOfProcess();
}

void HttpLimits::Set(const HttpLimits& limits)
{
  const std::lock_guard<std::mutex> lock(LimitsGuard);
  GetLimitsOfProcess() = limits;
}

#ifdef DSM_HAS_CURL
HttpClient::Answer HttpClient::Get(
  const RemotePlace& place, const Request& request, const std::function<bool()>& goesOn)
{
  const HttpLimits limits = HttpLimits::Get();
  const std::string address = place.GetAddress(request.Path);
  const std::string key = address + (request.Range ? "#" + request.Range->Write() : "");
  RecentErrors::Check(key, limits.ErrorSeconds);
  const auto begin = HttpClock::now();
  double pause = limits.FirstPause;
  for (int attempt = 1;; ++attempt)
  {
    Answer answer;
    double retryAfter = 0.0;
    const Transfer::Result result = Follow(place, request, goesOn, answer, retryAfter);
    if (result.Failure.empty())
    {
      return answer;
    }
    const double wait = std::max(Spread(pause), std::min(retryAfter, LongestPause));
    const std::chrono::duration<double> taken = HttpClock::now() - begin;
    if (!result.MayPass || attempt >= limits.Attempts || taken.count() + wait > limits.Seconds)
    {
      const FileError error(HideCredentials(request.Path),
        "cannot be read: " + result.Failure +
          (attempt > 1 ? " (" + std::to_string(attempt) + " attempts)." : "."));
      if (result.IsRefusal)
      {
        throw Refusal(error.what());
      }
      if (result.MayPass)
      {
        RecentErrors::Note(key, error);
      }
      throw error;
    }
    Wait(wait, request.Path, goesOn);
    pause *= 2.0;
  }
}
#else
HttpClient::Answer HttpClient::Get(
  const RemotePlace&, const Request& request, const std::function<bool()>&)
{
  throw FileError(HideCredentials(request.Path),
    "cannot be read: this build has no libcurl, which http, https and s3 need. Install the package "
    "libcurl4-openssl-dev and build again.");
}
#endif

} // namespace vol
