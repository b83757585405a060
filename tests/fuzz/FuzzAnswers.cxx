// SPDX-License-Identifier: BSD-3-Clause
// What a server sends. The first byte of the input chooses what it is asked for: the others are all that comes back.
// All hosts are this server, which is the proxy, too: an answer may lead anywhere.
#include "InputFolder.h"

#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/remote/HttpClient.h"

#include <algorithm>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace
{

/// Sends the same to all who come.
class Server
{
public:
  Server()
  {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    this->Socket = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    auto* const generic = reinterpret_cast<sockaddr*>(&address);
    if (this->Socket < 0 || bind(this->Socket, generic, size) != 0 ||
      listen(this->Socket, 16) != 0 || getsockname(this->Socket, generic, &size) != 0)
    {
      fuzz::Fail("no socket");
    }
    const std::string proxy = "http://127.0.0.1:" + std::to_string(ntohs(address.sin_port));
    for (const char* name : { "http_proxy", "https_proxy", "HTTPS_PROXY", "all_proxy" })
    {
      setenv(name, proxy.c_str(), 1);
    }
    setenv("no_proxy", "", 1);
    setenv("HOME", fuzz::GetInputFolder().c_str(), 1);
    std::thread([this] { this->Run(); }).detach();
  }

  void SetAnswer(const std::uint8_t* bytes, std::size_t count)
  {
    const std::lock_guard<std::mutex> lock(this->Guard);
    this->Answer.assign(reinterpret_cast<const char*>(bytes), count);
  }

private:
  void Run()
  {
    for (;;)
    {
      const int client = accept4(this->Socket, nullptr, nullptr, SOCK_CLOEXEC);
      if (client < 0)
      {
        continue;
      }
      std::string request;
      char bytes[4096];
      while (request.find("\r\n\r\n") == std::string::npos)
      {
        pollfd ready{ client, POLLIN, 0 };
        const ssize_t count = poll(&ready, 1, 1000) == 1 ? read(client, bytes, sizeof(bytes)) : 0;
        if (count <= 0)
        {
          break;
        }
        request.append(bytes, static_cast<std::size_t>(count));
      }
      const std::string answer =
        this->GetAnswer(); // who asked may be gone, and the next one be here
      for (std::size_t done = 0; done < answer.size();)
      {
        const ssize_t count =
          send(client, answer.data() + done, answer.size() - done, MSG_NOSIGNAL);
        if (count <= 0)
        {
          break;
        }
        done += static_cast<std::size_t>(count);
      }
      close(client);
    }
  }

  std::string GetAnswer()
  {
    const std::lock_guard<std::mutex> lock(this->Guard);
    return this->Answer;
  }

  int Socket = -1;
  std::mutex Guard;
  std::string Answer;
};

vol::HttpClient::Request MakeRequest(std::uint8_t kind)
{
  vol::HttpClient::Request request;
  request.Path = "http://host/x.zarr/0.0";
  request.Most = 1000;
  if (kind % 4 == 1)
  {
    request.Range = vol::HttpRange{ 10, 20, false };
  }
  else if (kind % 4 == 2)
  {
    request.Range = vol::HttpRange{ 0, 16, true };
  }
  else if (kind % 4 == 3)
  {
    request.If = { "\"tag\"", "" };
  }
  if (request.Range)
  {
    request.Most = request.Range->Bytes;
  }
  return request;
}

void Check(const vol::HttpClient::Request& request, const vol::HttpClient::Answer& answer)
{
  using vol::HttpClient::Outcome;
  if (answer.How == Outcome::Unchanged && request.If.IsEmpty())
  {
    fuzz::Fail("it is unchanged, but nobody knew it");
  }
  if (answer.How != Outcome::Here)
  {
    return;
  }
  if (answer.Body.size() > request.Most)
  {
    fuzz::Fail("the body is longer than it may be");
  }
  const std::optional<vol::HttpRange>& range = request.Range;
  const bool isRight = !range ? answer.Total == answer.Body.size()
    : range->FromEnd ? answer.Body.size() == std::min<std::uint64_t>(range->Bytes, answer.Total)
                     : answer.Total > range->Offset &&
      answer.Body.size() == std::min(range->Bytes, answer.Total - range->Offset);
  if (!isRight)
  {
    fuzz::Fail("the body is not what was asked for");
  }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count)
{
  static auto* const server = new Server;
  if (count == 0)
  {
    return 0;
  }
  vol::HttpLimits limits;
  limits.Seconds = 2;
  limits.Attempts = 1;
  limits.ErrorSeconds = 0.0;
  vol::HttpLimits::Set(limits);
  const vol::HttpClient::Request request = MakeRequest(bytes[0]);
  server->SetAnswer(bytes + 1, count - 1);
  try
  {
    Check(request, vol::HttpClient::Get(vol::RemotePlace("http://host/x.zarr"), request));
  }
  catch (const dsm::Error& error)
  {
    if (std::string(error.what()).find(request.Path) == std::string::npos)
    {
      fuzz::Fail(std::string("the address is not named: ") + error.what());
    }
  }
  return 0;
}
