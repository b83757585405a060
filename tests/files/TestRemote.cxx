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
#include <map>
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
    limits.FirstPause = 0.003;
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

/// Also a server that says nothing, or next to nothing, ends in an error, and in a moment where it was so before.
TEST_F(Remote, WaitsNoLongerThanItMay)
{
  vol::HttpLimits limits = vol::HttpLimits::Get();
  limits.Seconds = 1;
  vol::HttpLimits::Set(limits);
  for (const char* behavior : { "silent", "trickle", "all_silent" })
  {
    const auto begin = std::chrono::steady_clock::now();
    const std::string fault = FindFault(behavior, Volumes[0]);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
    EXPECT_NE(fault.find("Operation too slow"), std::string::npos) << behavior << ": " << fault;
    EXPECT_LT(taken.count(), 6.0) << behavior;
  }
  // Nobody is there.
  const auto begin = std::chrono::steady_clock::now();
  for (int time = 0; time < 2; ++time)
  {
    try
    {
      vol::OpenVolumeFile("http://127.0.0.1:1/x.zarr");
      ADD_FAILURE();
    }
    catch (const dsm::Error& error)
    {
      const std::string what = error.what();
      EXPECT_EQ(what.find("'http://127.0.0.1:1/x.zarr/zarr.json' cannot be read: "), 0u) << what;
      EXPECT_NE(what.find("connect"), std::string::npos) << what;
      EXPECT_NE(what.find("(4 attempts)"), std::string::npos) << what;
      EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(2));
    }
  }
  // Who opens again at once is told the same at once.
  const std::string fault = FindFault("all_silent", Volumes[1]);
  const auto now = std::chrono::steady_clock::now();
  EXPECT_EQ(FindFault("all_silent", Volumes[1]), fault);
  const std::chrono::duration<double> again = std::chrono::steady_clock::now() - now;
  EXPECT_LT(again.count(), 0.5);
}

/// What an opening says; "" where it succeeds.
std::string FindRefusal(const std::string& url)
{
  try
  {
    vol::OpenVolumeFile(url);
    return "";
  }
  catch (const dsm::Error& error)
  {
    return error.what();
  }
}

TEST_F(Remote, RefusesWhatItDoesNotSpeakAndHidesPasswords)
{
  for (const char* url : { "file:///etc/passwd", "ftp://host/x.zarr", "gs://bucket/x.zarr" })
  {
    EXPECT_NE(FindRefusal(url).find("only http, https and s3"), std::string::npos) << url;
  }
  for (const char* url : { "https://me:geheim@host/x.zarr", "https://host/x.zarr?sig=geheim",
         "s3://me:gehe/im@bucket/x", "https://host/x.zarr#geheim" })
  {
    const std::string refusal = FindRefusal(url);
    EXPECT_NE(refusal.find("cannot be opened"), std::string::npos) << url;
    EXPECT_EQ(refusal.find("gehe"), std::string::npos) << refusal;
  }
  const std::string file = FindRefusal("https://host/volume.h5");
  EXPECT_NE(file.find("Copy the file"), std::string::npos) << file;
  const std::string none = FindRefusal(Server::Get().GetUrl("ok", "nothing.zarr"));
  EXPECT_NE(none.find("is not a Zarr store: the server answers 404"), std::string::npos) << none;
  const std::string forbidden = FindRefusal(Server::Get().GetUrl("all_403", "group.zarr"));
  EXPECT_NE(forbidden.find("403 Forbidden"), std::string::npos) << forbidden;
  const std::string group = FindRefusal(Server::Get().GetUrl("ok", "group.zarr"));
  EXPECT_NE(group.find("zarr.consolidate_metadata"), std::string::npos) << group;
  vol::OpenOptions options;
  options.Dataset = "b";
  EXPECT_EQ(vol::OpenVolumeFile(Server::Get().GetUrl("ok", "group.zarr"), options)
              ->GetArrays()
              .front()
              .Type,
    bricks::ScalarType::Float32);
  EXPECT_TRUE(vol::MayBeVolumeFile("https://host/x.zarr"));
  EXPECT_FALSE(vol::IsBareFile("https://host/x.raw"));
}

/// Credentials of ~/.netrc are for the host that they name; those of the environment sign requests to S3.
TEST_F(Remote, GivesCredentialsToNoOtherHost)
{
  const fs::path home = GetFolder() / "home";
  fs::create_directories(home);
  std::ofstream(home / ".netrc") << "machine 127.0.0.1 login me password geheim\n";
  const std::string before = std::getenv("HOME") ? std::getenv("HOME") : "";
  setenv("HOME", home.c_str(), 1);
  Server::Get().TakeLog();
  EXPECT_EQ(FindFault("all_redirect", "three_raw.zarr"), "");
  setenv("HOME", before.c_str(), 1);
  int leads = 0;
  int follows = 0;
  for (const Json& request : Server::Get().TakeLog())
  {
    const std::string path = request[1];
    const std::string credentials = request[3];
    const bool isFirst = path.find("/all_redirect/") == 0;
    EXPECT_EQ(credentials.empty(), !isFirst) << path;
    isFirst ? ++leads : ++follows;
  }
  EXPECT_GT(leads, 1);
  EXPECT_EQ(leads, follows);
}

TEST_F(Remote, SignsRequestsToS3)
{
  setenv("AWS_ENDPOINT_URL", Server::Get().GetUrl("all_signed", "").c_str(), 1);
  const auto open = []
  {
    const auto there = vol::OpenVolumeFile("s3://three_sharded.zarr");
    const auto here = vol::OpenVolumeFile((GetFolder() / "three_sharded.zarr").string());
    EXPECT_TRUE(ReadAll(*there) == ReadAll(*here));
  };
  EXPECT_NE(FindRefusal("s3://three_sharded.zarr")
              .find("'s3://three_sharded.zarr/zarr.json' cannot "
                    "be read: the server answers 403 Forbidden"),
    std::string::npos);
  setenv("AWS_ACCESS_KEY_ID", "KEY", 1);
  setenv("AWS_SECRET_ACCESS_KEY", "se/cr+et", 1);
  setenv("AWS_SESSION_TOKEN", "TOKEN", 1);
  setenv("AWS_REGION", "eu-north-1", 1);
  EXPECT_NO_THROW(open());
  setenv("AWS_SECRET_ACCESS_KEY", "geheim", 1);
  const std::string refusal = FindRefusal("s3://three_sharded.zarr");
  EXPECT_NE(refusal.find("403 Forbidden"), std::string::npos) << refusal;
  EXPECT_EQ(refusal.find("geheim"), std::string::npos) << refusal;
  // Without keys.
  for (const char* name : { "AWS_ACCESS_KEY_ID", "AWS_SECRET_ACCESS_KEY", "AWS_SESSION_TOKEN" })
  {
    unsetenv(name);
  }
  setenv("AWS_ENDPOINT_URL", Server::Get().GetUrl("ok", "").c_str(), 1);
  EXPECT_NO_THROW(open());
  // Another server's bucket of the same name is another one.
  setenv("AWS_ENDPOINT_URL", Server::Get().GetUrl("other_bytes", "").c_str(), 1);
  EXPECT_THROW(open(), dsm::Error);
  for (const char* name : { "AWS_ENDPOINT_URL", "AWS_REGION" })
  {
    unsetenv(name);
  }
  EXPECT_EQ(vol::RemotePlace("s3://bucket/a b/c.zarr").GetAddress("s3://bucket/a b/c.zarr/0.0?"),
    "https://bucket.s3.us-east-1.amazonaws.com/a%20b/c.zarr/0.0%3F");
}

/// How many answers had a status.
int CountAnswers(const Json& log, int status)
{
  return static_cast<int>(std::count_if(
    log.begin(), log.end(), [=](const Json& request) { return request[4] == status; }));
}

TEST_F(Remote, AsksOnceForAChunkThatSeveralWant)
{
  for (const char* behavior : { "slow", "ok" })
  {
    for (const char* name : { "zlib_float32.zarr", "three_sharded_gzip.zarr" })
    {
      Server::Get().TakeLog();
      const std::string url = Server::Get().GetUrl(behavior, name);
      // As ranks do: each opens the volume.
      std::vector<std::shared_ptr<const vol::VolumeFile>> files;
      for (int rank = 0; rank < 4; ++rank)
      {
        files.push_back(vol::OpenVolumeFile(url));
      }
      std::vector<std::thread> ranks;
      for (const auto& file : files)
      {
        ranks.emplace_back([&file] { ReadAll(*file); });
      }
      for (std::thread& rank : ranks)
      {
        rank.join();
      }
      const auto here = vol::OpenVolumeFile((GetFolder() / name).string());
      const Json log = Server::Get().TakeLog();
      std::map<std::string, int> bodies;
      for (const Json& request : log)
      {
        if (request[4] == 200 || request[4] == 206)
        {
          ++bodies[request[1].get<std::string>() + request[2].get<std::string>()];
        }
      }
      EXPECT_GT(bodies.size(), 20u);
      for (const auto& [key, count] : bodies)
      {
        EXPECT_EQ(count, 1) << key;
      }
      // Later, the server is asked whether it is still so, and sends nothing.
      EXPECT_EQ(FindFault(behavior, name), "");
      const Json later = Server::Get().TakeLog();
      EXPECT_GT(CountAnswers(later, 304), 0);
      EXPECT_EQ(CountAnswers(later, 200) + CountAnswers(later, 206), 0) << later;
    }
  }
}

TEST_F(Remote, SaysThatAVolumeChangedWhileItWasOpen)
{
  const fs::path folder = GetFolder() / "changing.zarr";
  fs::remove_all(folder);
  fs::copy(GetFolder() / "zlib_float32.zarr", folder, fs::copy_options::recursive);
  const std::string url = Server::Get().GetUrl("ok", "changing.zarr");
  const auto read = [&](const vol::VolumeFile& file, const bricks::Index3& chunk) -> std::string
  {
    const vol::FileArray& array = file.GetArrays().front();
    std::vector<std::byte> out(
      static_cast<std::size_t>(array.Grid.GetBox(chunk).GetCount()) * array.GetSampleBytes());
    try
    {
      file.ReadChunk(0, 0, chunk, out.data());
      return "";
    }
    catch (const dsm::Error& error)
    {
      return error.what();
    }
  };
  const auto file = vol::OpenVolumeFile(url);
  EXPECT_EQ(read(*file, { 0, 0, 0 }), "");
  std::ofstream(folder / "0.0.0", std::ios::app) << "more";
  EXPECT_EQ(read(*file, { 0, 0, 0 }), "") << "as it was";
  vol::KeptAnswers::GetShared().Drop(url + "/0.0.0");
  EXPECT_EQ(read(*file, { 0, 0, 0 }),
    "'" + url + "/0.0.0' changed or was replaced after it was opened. Reload it.");
  fs::remove(folder / "0.0.0");
  vol::KeptAnswers::GetShared().Drop(url + "/0.0.0");
  EXPECT_EQ(read(*file, { 0, 0, 0 }), "'" + url + "/0.0.0' was deleted after it was opened.");
  // A chunk that was not read is missing; then all of the store is.
  fs::remove(folder / "0.0.1");
  EXPECT_EQ(read(*file, { 1, 0, 0 }), "");
  fs::remove_all(folder);
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));
  EXPECT_EQ(read(*file, { 0, 1, 0 }), "'" + url + "/.zarray' was deleted after it was opened.");
  EXPECT_EQ(read(*file, { 1, 0, 0 }), "") << "known to be missing";
}

TEST_F(Remote, MeetsNoStoreThatChangedBetweenOpenings)
{
  const fs::path folder = GetFolder() / "renewed.zarr";
  for (const char* name : { "zlib_float32.zarr", "zstd_float32.zarr" })
  {
    fs::remove_all(folder);
    fs::copy(GetFolder() / name, folder, fs::copy_options::recursive);
    EXPECT_EQ(FindFault("ok", "renewed.zarr"), "");
  }
}

TEST_F(Remote, DoesNotWaitWhereAThreadMayNot)
{
  const auto file = vol::OpenVolumeFile(Server::Get().GetUrl("ok", Volumes[0]));
  std::vector<std::byte> out(1 << 16);
  const vol::WithoutWaiting scope;
  EXPECT_THROW(file->ReadChunk(0, 0, { 0, 0, 0 }, out.data()), vol::WouldWait);
}

TEST(KeptAnswers, StayWithinTheirLimitAndAreChecked)
{
  const fs::path folder = GetFolder() / "kept_answers";
  fs::remove_all(folder);
  constexpr std::uint64_t most = 1 << 16;
  vol::KeptAnswers answers(folder, most);
  const vol::HttpValidator tag{ "\"tag\"", "" };
  const vol::ByteBuffer body(1000, std::byte(7));
  for (int number = 0; number < 300; ++number)
  {
    answers.Keep("name" + std::to_string(number), tag, 5000, body);
  }
  std::uint64_t bytes = 0;
  for (const auto& entry : fs::directory_iterator(folder))
  {
    bytes += entry.file_size();
  }
  EXPECT_LE(bytes, most);
  EXPECT_GT(bytes, most / 2);
  const auto kept = answers.Find("name299", 1000);
  ASSERT_TRUE(kept);
  EXPECT_TRUE(kept->Validator == tag && kept->Total == 5000 && kept->Body == body);
  EXPECT_FALSE(answers.Find("name0", 1000));
  EXPECT_FALSE(answers.Find("name299", 999));
  answers.Keep("said nothing", {}, 1000, body);
  EXPECT_FALSE(answers.Find("said nothing", 1000));
  answers.Keep("large", tag, most, vol::ByteBuffer(most, std::byte(1)));
  EXPECT_FALSE(answers.Find("large", most));
  // Any byte may be damaged.
  answers.Drop("name299");
  EXPECT_FALSE(answers.Find("name299", 1000));
  fs::remove_all(folder);
  answers.Keep("one", tag, 1000, body);
  const fs::path path = fs::directory_iterator(folder)->path();
  const std::string whole = vol::ReadWhole(path.string(), 1 << 16);
  for (std::size_t place = 0; place < whole.size(); place += place < 200 ? 1 : 97)
  {
    std::string damaged = whole;
    damaged[place] = static_cast<char>(damaged[place] ^ 0x20);
    std::ofstream(path) << damaged;
    EXPECT_FALSE(answers.Find("one", 1000)) << place;
  }
  std::ofstream(path) << whole;
  EXPECT_TRUE(answers.Find("one", 1000));
}

TEST(HttpHead, TakesWhatServersWrite)
{
  const auto add = [](vol::HttpHead& head, const std::string& line)
  { head.Add(line.data(), line.size()); };
  vol::HttpHead head;
  add(head, "HTTP/2 206\r\n");
  add(head, "ETAG:   \"a b\"  \r\n");
  add(head, "Content-Range: bytes 10-19/100\r\n");
  add(head, "content-length: 10\r\n");
  EXPECT_EQ(head.Status, 206);
  EXPECT_EQ(head.Validator.Tag, "\"a b\"");
  EXPECT_EQ(head.Check(vol::HttpRange{ 10, 10, false }, 10), "");
  EXPECT_NE(head.Check(vol::HttpRange{ 10, 10, false }, 9), "");
  EXPECT_NE(head.Check(vol::HttpRange{ 10, 9, false }, 10), "");
  EXPECT_NE(head.Check(vol::HttpRange{ 0, 10, true }, 10), "");
  EXPECT_NE(head.Check({}, 10), "");
  for (const char* range : { "bytes 10-19/*", "bytes 19-10/100", "bytes 10-100/100", "10-19/100",
         "bytes 10-19/100x", "bytes -1-19/100", "bytes 99999999999999999999-1/2", "" })
  {
    add(head, std::string("Content-Range: ") + range);
    EXPECT_FALSE(head.Content) << range;
  }
  add(head, "HTTP/1.1 200 OK");
  EXPECT_TRUE(head.Validator.IsEmpty());
  EXPECT_EQ(head.Check({}, 5), "");
}

} // namespace
