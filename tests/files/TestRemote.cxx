// SPDX-License-Identifier: BSD-3-Clause
// Zarr on a server that misbehaves by script (http_server.py): the bytes of the folder, or an error that names address
// and cause, in bounded time.
#include "VolumeManifest.h"

#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/ReadingManner.h"
#include "DSMVolumeFiles/base/SmallFile.h"
#include "DSMVolumeFiles/base/Url.h"
#include "DSMVolumeFiles/remote/HttpClient.h"
#include "DSMVolumeFiles/remote/HttpHead.h"
#include "DSMVolumeFiles/remote/KeptAnswers.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include <sys/wait.h>
#include <unistd.h>

namespace
{

using namespace dsm_test;

/// The server, as long as the program runs.
class Server
{
public:
  static Server& Get()
  {
    static Server server;
    return server;
  }

  std::string GetUrl(const std::string& behavior, const std::string& name) const
  {
    return "http://127.0.0.1:" + this->Port + "/" + behavior + "/" + name;
  }
  const std::string& GetPort() const { return this->Port; }

  /// Requests since the last call: [method, path, range, credentials, status].
  Json TakeLog() const
  {
    const vol::RemotePlace place(this->GetUrl("log", "x"));
    vol::HttpClient::Request request;
    request.Path = this->GetUrl("log", "x");
    request.Most = 1 << 24;
    const vol::ByteBuffer body = vol::HttpClient::Get(place, request).Body;
    const char* const text = reinterpret_cast<const char*>(body.data());
    return Json::parse(text, text + body.size());
  }

private:
  Server()
  {
    int to[2];
    int from[2];
    if (pipe(to) != 0 || pipe(from) != 0)
    {
      std::abort();
    }
    this->Process = fork();
    if (this->Process == 0)
    {
      dup2(to[0], 0);
      dup2(from[1], 1);
      for (const int end : { to[0], to[1], from[0], from[1] })
      {
        close(end);
      }
      execl(DSM_TEST_PYTHON, DSM_TEST_PYTHON, DSM_TEST_SERVER, DSM_TEST_FILES, nullptr);
      _exit(127);
    }
    close(to[0]);
    close(from[1]);
    this->Input = to[1];
    for (char letter = 0; read(from[0], &letter, 1) == 1 && letter != '\n';)
    {
      this->Port += letter;
    }
    close(from[0]);
  }
  ~Server()
  {
    close(this->Input); // it ends by itself
    waitpid(this->Process, nullptr, 0);
  }

  pid_t Process = -1;
  int Input = -1;
  std::string Port;
};

class Remote : public testing::Test
{
protected:
  void SetUp() override
  {
    vol::HttpLimits limits;
    limits.Seconds = 2;
    limits.Attempts = 4;
    limits.FirstPause = 0.01;
    vol::HttpLimits::Set(limits);
  }
};

/// All chunks of all arrays.
std::vector<std::vector<std::byte>> ReadAll(const vol::VolumeFile& file)
{
  std::vector<std::vector<std::byte>> chunks;
  for (std::size_t array = 0; array < file.GetArrays().size(); ++array)
  {
    const vol::FileArray& what = file.GetArrays()[array];
    for (int step = 0; step < file.GetSteps(); ++step)
    {
      bricks::ForEachIndex({ bricks::Index3(0), what.Grid.GetCounts() },
        [&](const bricks::Index3& chunk)
        {
          chunks.emplace_back(
            static_cast<std::size_t>(what.Grid.GetBox(chunk).GetCount()) * what.GetSampleBytes());
          file.ReadChunk(array, step, chunk, chunks.back().data());
        });
    }
  }
  return chunks;
}

/// What is wrong with a volume on the server; empty: it opens, and has the bytes of the folder.
std::string FindFault(const std::string& behavior, const std::string& name)
{
  try
  {
    const auto there = vol::OpenVolumeFile(Server::Get().GetUrl(behavior, name));
    const auto here = vol::OpenVolumeFile((GetFolder() / name).string());
    return ReadAll(*there) == ReadAll(*here) ? "" : "other bytes";
  }
  catch (const dsm::Error& error)
  {
    return error.what();
  }
}

TEST_F(Remote, HasTheVolumesOfTheFolder)
{
  int count = 0;
  for (const Json& entry : ReadManifest())
  {
    const std::string name = entry.at("file");
    if (name.find(".zarr") == std::string::npos || fs::path(name).extension() == ".zattrs")
    {
      continue;
    }
    SCOPED_TRACE(name);
    ++count;
    try
    {
      const auto here = Open(entry);
      const auto there =
        vol::OpenVolumeFile(Server::Get().GetUrl("consolidated", name), GetOptions(entry));
      ASSERT_EQ(there->GetArrays().size(), here->GetArrays().size());
      EXPECT_TRUE(vol::IsSamePlace(there->GetGeometry(), here->GetGeometry()));
      EXPECT_EQ(there->GetCoordinates(), here->GetCoordinates());
      EXPECT_EQ(there->GetSteps(), here->GetSteps());
      EXPECT_EQ(there->GetLevels(), here->GetLevels());
      EXPECT_EQ(there->GetWarnings(), here->GetWarnings());
      for (std::size_t array = 0; array < here->GetArrays().size(); ++array)
      {
        EXPECT_EQ(there->GetArrays()[array].Name, here->GetArrays()[array].Name);
      }
      EXPECT_TRUE(ReadAll(*there) == ReadAll(*here));
    }
    catch (const dsm::Error& error)
    {
      ADD_FAILURE() << error.what();
    }
  }
  EXPECT_GT(count, 40);
}

/// Version 2 and 3, and shards, of which parts are read.
const char* const Volumes[] = { "blosc_lz4_float32.zarr", "three_sharded.zarr" };

TEST_F(Remote, ComesThroughWhatPasses)
{
  for (const char* behavior :
    { "ok", "drop_twice", "503_twice", "cut_once", "slow", "redirect", "no_tag", "nothing_said" })
  {
    for (const char* name : Volumes)
    {
      EXPECT_EQ(FindFault(behavior, name), "") << behavior << " " << name;
    }
  }
}

TEST_F(Remote, SaysWhatTheServerDoesAndWhere)
{
  struct Case
  {
    const char* Behavior;
    const char* Whole; ///< what is said of a chunk in a key of its own
    const char* Part;  ///< likewise, in a shard
  };
  const Case cases[] = {
    { "403", "403 Forbidden", "403 Forbidden" },
    { "401", "401 Unauthorized", "401 Unauthorized" },
    { "410", "410 Gone", "410 Gone" },
    { "500", "500 Internal Server Error (4 attempts)", "500 Internal Server Error (4 attempts)" },
    { "503", "503 Service Unavailable", "503 Service Unavailable" },
    { "drop", "attempts", "attempts" },
    { "cut", "transfer closed", "transfer closed" },
    { "more_declared", "transfer closed", "transfer closed" },
    { "less_declared", "cannot be read", "that were asked for" },
    { "longer", "cannot be read", "bytes that it may have" },
    { "endless", "bytes that it may have", "bytes that it may have" },
    { "other_bytes", "cannot be read", "invalid index" },
    { "encoded", "in the encoding 'gzip'", "in the encoding 'gzip'" },
    { "garbage", "HTTP/0.9", "HTTP/0.9" },
    { "redirect_loop", "without end", "without end" },
    { "redirect_file", "not http or https", "not http or https" },
    { "no_ranges", "", "that knows byte ranges" },
    { "wrong_range", "", "but others were asked for" },
    { "no_content_range", "", "does not say which one" },
    { "other_total", "", "changed or was replaced" },
    { "new_tag", "", "changed or was replaced" },
  };
  for (const Case& one : cases)
  {
    for (const bool inShard : { false, true })
    {
      const char* const expected = inShard ? one.Part : one.Whole;
      const auto begin = std::chrono::steady_clock::now();
      const std::string fault = FindFault(one.Behavior, Volumes[inShard ? 1 : 0]);
      const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
      EXPECT_LT(taken.count(), 8.0) << one.Behavior;
      if (!*expected)
      {
        EXPECT_EQ(fault, "") << one.Behavior;
        continue;
      }
      EXPECT_NE(fault.find(expected), std::string::npos) << one.Behavior << ": " << fault;
      EXPECT_NE(fault.find("'" + Server::Get().GetUrl(one.Behavior, "")), std::string::npos)
        << fault;
    }
  }
}

} // namespace
