// SPDX-License-Identifier: BSD-3-Clause
// Runs a fuzz target where libFuzzer is not there: changes seeds at random and hands them to the target. The
// options are libFuzzer's (https://llvm.org/docs/LibFuzzer.html), so that one command line serves both:
//   -max_total_time=SECONDS  (default: without an end)     -runs=INPUTS     (default: without an end)
//   -dict=FILE                                             -seed=NUMBER     (default 1)
//   -timeout=SECONDS         of one input (default 5)      -max_len=BYTES   (default 64 KiB)
//   -malloc_limit_mb=MIB     of one allocation (default 256)
//   -artifact_prefix=PATH    what findings are named with  -ignore_crashes=1: go on after a finding
// Folders have seeds. Files instead are inputs: each is run once. A process of its own runs the inputs. When it
// ends in a crash, the input is kept, as PATHcrash-NUMBER; where the crash was in the HDF5 library (CrashNotes.h),
// as PATHlibrary-NUMBER, which does not count as a finding.
#include "CrashNotes.h"
#include "InputFolder.h"
#include "Mutator.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <stdexcept>
#include <string>

#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count);

namespace
{

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using fuzz::Input;

struct Options
{
  std::map<std::string, std::string> Given;
  std::vector<std::string> Paths;

  std::string GetText(const std::string& name) const
  {
    const auto found = this->Given.find(name);
    return found == this->Given.end() ? std::string() : found->second;
  }
  std::uint64_t GetNumber(const std::string& name, std::uint64_t other) const
  {
    const std::string text = this->GetText(name);
    return text.empty() ? other : std::stoull(text);
  }
};

Options Parse(int count, char** arguments)
{
  Options options;
  for (int index = 1; index < count; ++index)
  {
    const std::string text = arguments[index];
    const std::size_t equal = text.find('=');
    if (text[0] == '-' && equal != std::string::npos)
    {
      options.Given[text.substr(1, equal - 1)] = text.substr(equal + 1);
    }
    else
    {
      options.Paths.push_back(text);
    }
  }
  return options;
}

Input ReadFile(const fs::path& path)
{
  std::ifstream file(path, std::ios::binary);
  if (!file)
  {
    throw std::runtime_error("the file cannot be read: " + path.string());
  }
  return { std::istreambuf_iterator<char>(file), {} };
}

std::vector<Input> ReadSeeds(const std::vector<std::string>& folders, std::size_t mostBytes)
{
  std::vector<fs::path> paths;
  for (const std::string& folder : folders)
  {
    for (const auto& entry : fs::recursive_directory_iterator(folder))
    {
      if (entry.is_regular_file() && entry.file_size() <= mostBytes)
      {
        paths.push_back(entry.path());
      }
    }
  }
  std::sort(paths.begin(), paths.end());
  std::vector<Input> seeds;
  std::transform(paths.begin(), paths.end(), std::back_inserter(seeds), &ReadFile);
  if (seeds.empty())
  {
    throw std::runtime_error("there are no seeds: name a folder that has some");
  }
  return seeds;
}

/// What the two processes share.
struct Shared
{
  std::uint64_t Inputs; ///< that were begun
  std::size_t Bytes;    ///< of the one that runs
  std::uint8_t First[1];
};

class Run
{
public:
  explicit Run(const Options& options)
    : MostBytes(options.GetNumber("max_len", 1 << 16))
    , MostInputs(options.GetNumber("runs", UINT64_MAX))
    , Seconds(options.GetNumber("max_total_time", 0))
    , Timeout(static_cast<unsigned>(options.GetNumber("timeout", 5)))
    , MallocLimit(options.GetNumber("malloc_limit_mb", 256) << 20)
    , Number(options.GetNumber("seed", 1))
    , GoesOn(options.GetNumber("ignore_crashes", 0) != 0)
    , Prefix(options.GetText("artifact_prefix"))
    , Start(Clock::now())
  {
    const std::string dictionary = options.GetText("dict");
    this->Words = dictionary.empty() ? std::vector<Input>() : fuzz::ReadDictionary(dictionary);
  }

  /// Runs inputs without an end of their own, and returns how the program ends.
  int RunAll(const std::vector<std::string>& folders)
  {
    this->Seeds = ReadSeeds(folders, this->MostBytes);
    void* const memory = mmap(nullptr, sizeof(Shared) + this->MostBytes, PROT_READ | PROT_WRITE,
      MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED)
    {
      throw std::runtime_error("no memory to share");
    }
    this->Now = static_cast<Shared*>(memory);
    fuzz::GetInputFolder(); // one for all processes
    int crashes = 0;
    int inLibrary = 0;
    while (!this->IsOver() && (crashes == 0 || this->GoesOn))
    {
      const int code = this->RunProcess();
      const bool isLibrary = code == fuzz::EndedInLibrary;
      inLibrary += isLibrary ? 1 : 0;
      crashes += code != 0 && !isLibrary ? 1 : 0;
      if (code != 0)
      {
        this->Keep(isLibrary ? "library-" : "crash-");
      }
    }
    const std::chrono::duration<double> took = Clock::now() - this->Start;
    std::printf("stat::number_of_executed_units: %llu\n"
                "stat::average_exec_per_sec:     %.0f\n"
                "stat::crashes:                  %d\n"
                "stat::crashes_in_hdf5:          %d\n",
      static_cast<unsigned long long>(this->Now->Inputs),
      static_cast<double>(this->Now->Inputs) / took.count(), crashes, inLibrary);
    return crashes == 0 ? 0 : 1;
  }

  void RunOnce(const Input& input) const noexcept
  {
    this->SetLimits();
    fuzz::LimitTime(this->Timeout);
    LLVMFuzzerTestOneInput(input.data(), input.size());
    fuzz::LimitTime(0);
  }

private:
  bool IsOver() const
  {
    return this->Now->Inputs >= this->MostInputs ||
      (this->Seconds > 0 && Clock::now() - this->Start >= std::chrono::seconds(this->Seconds));
  }

  void SetLimits() const
  {
    fuzz::InstallCrashNotes(fuzz::EndedInLibrary);
    fuzz::LimitAllocations(this->MallocLimit);
#ifndef __SANITIZE_ADDRESS__
    // Many small allocations, too.
    const rlim_t bytes = rlim_t(2) << 30;
    const rlimit limit{ bytes, bytes };
    setrlimit(RLIMIT_DATA, &limit);
#endif
    const rlimit none{ 0, 0 };
    setrlimit(RLIMIT_CORE, &none);
  }

  /// Returns the exit code, or the number of the signal and 128.
  int RunProcess()
  {
    std::fflush(nullptr);
    const pid_t process = fork();
    if (process < 0)
    {
      throw std::runtime_error("no process can be started");
    }
    if (process == 0)
    {
      this->RunInputs();
      _exit(0);
    }
    int state = 0;
    while (waitpid(process, &state, 0) < 0)
    {
    }
    return WIFEXITED(state) ? WEXITSTATUS(state) : 128 + WTERMSIG(state);
  }

  /// What a target throws ends the process.
  void RunInputs() noexcept
  {
    this->SetLimits();
    // A process that takes over makes other inputs than the one before.
    fuzz::Mutator mutator(this->Seeds, this->Words, this->Number + this->Now->Inputs);
    while (!this->IsOver())
    {
      const std::uint64_t number = this->Now->Inputs++;
      const Input input =
        number < this->Seeds.size() ? this->Seeds[number] : mutator.Make(this->MostBytes);
      this->Now->Bytes = input.size();
      std::copy(input.begin(), input.end(), this->Now->First);
      fuzz::LimitTime(this->Timeout);
      LLVMFuzzerTestOneInput(input.data(), input.size());
      fuzz::LimitTime(0);
    }
  }

  void Keep(const std::string& kind) const
  {
    const std::string path =
      this->Prefix + kind + std::to_string(this->Number) + "-" + std::to_string(this->Now->Inputs);
    std::ofstream file(path, std::ios::binary);
    file.write(reinterpret_cast<const char*>(this->Now->First),
      static_cast<std::streamsize>(this->Now->Bytes));
    std::fprintf(stderr, "The input is kept in %s%s\n", path.c_str(),
      file.flush() ? "" : ", but it cannot be written");
  }

  std::size_t MostBytes;
  std::uint64_t MostInputs;
  std::uint64_t Seconds; ///< 0: without an end
  unsigned Timeout;
  std::size_t MallocLimit;
  std::uint64_t Number;
  bool GoesOn;
  std::string Prefix;
  Clock::time_point Start;
  std::vector<Input> Seeds;
  std::vector<Input> Words;
  Shared* Now = nullptr;
};

} // namespace

int main(int count, char** arguments)
{
  try
  {
    const Options options = Parse(count, arguments);
    Run run(options);
    const bool areFiles = !options.Paths.empty() &&
      std::all_of(options.Paths.begin(), options.Paths.end(),
        [](const std::string& path) { return fs::is_regular_file(path); });
    if (!areFiles)
    {
      return run.RunAll(options.Paths);
    }
    for (const std::string& path : options.Paths)
    {
      std::fprintf(stderr, "Running %s\n", path.c_str());
      run.RunOnce(ReadFile(path));
    }
    return 0;
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  }
}
