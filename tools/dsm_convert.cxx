// SPDX-License-Identifier: BSD-3-Clause
// Writes a volume as a brick file, alone or with several MPI ranks.
#include "DSMCore/base/Error.h"
#include "DSMCore/transport/LoopbackTransport.h"
#include "DSMCore/transport/Messenger.h"
#include "DSMCore/transport/MpiTransport.h"
#include "DSMVolumeFiles/write/ConvertVolume.h"
#include "tools/OptionValues.h"

#include <getopt.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iostream>
#include <map>
#include <new>
#include <sstream>
#include <utility>

namespace
{

constexpr char Usage[] =
  R"(Writes a volume in bricks, so that its first picture reads only what it shows.
usage: dsm_convert [options] IN OUT
   or: mpirun -np 4 dsm_convert [options] IN OUT
  IN   any volume that DSM Volume Reader reads: HDF5, Zarr (its folder), NRRD, MetaImage, raw
  OUT  the file to write, such as volume.vtkhdf or volume.h5: VTK's ImageData in HDF5
When it is ended early, the same call goes on where it was.
  --arrays A,B        only these arrays (default: all)
  --step N            of a file with several time steps (default 0)
  --level N           of a file with several levels of detail (default 0, the finest)
  --dataset NAME      of an HDF5 file that is not VTK's
  --levels N          coarser ones to write beside the values, each with half the samples along each axis, for while
                      the camera moves; all: until one is a single brick (default 0)
  --compression KIND  none (default), zstd, or deflate, which programs without HDF5's plugin for zstd read
  --brick N           cells along an axis of a brick (default: the renderer's own, 16 to 32)
  --memory MIB        of values in memory, on each rank (default 512)
  --threads N         of each rank (default: the cores of its host, shared out)
  --raw-size X,Y,Z    of a file of bare values: its samples along each axis
  --raw-type TYPE     int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32 or float64
  --raw-header BYTES  before the first value (default 0)
  --raw-big-endian    the high byte comes first
  --spacing X,Y,Z     of the samples of such a file (default 1,1,1)
  --quiet             tell nothing of how far it is
  --help
)";

constexpr std::size_t MostMebibytes = std::size_t(1) << 40;
constexpr int MostThreads = 1 << 12;

struct Options
{
  std::string In;
  std::string Out;
  vol::OpenOptions Open;
  std::string OfBareValues; ///< one that tells of them; empty: none does
  vol::ConvertOptions Convert;
  bool HasStep = false; ///< --step is given
  bool IsQuiet = false;
  bool WantsHelp = false;
};

template <class T>
std::vector<T> ToThree(const std::string& name, const std::string& text, T least)
{
  const std::vector<T> numbers = OptionValues::ToNumbers<T>(name, text, least);
  if (numbers.size() != 3)
  {
    throw dsm::Error(name + " takes three numbers with commas, such as 512,512,400.");
  }
  return numbers;
}

std::vector<std::string> Split(const std::string& text)
{
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');)
  {
    parts.push_back(part);
  }
  return parts;
}

Options Parse(int argc, char** argv)
{
  Options options;
  options.Convert.Threads = 0;
  using Type = bricks::ScalarType;
  using Setter = std::function<void(const std::string& name, const std::string& text)>;
  struct Option
  {
    bool TakesText;
    Setter Set;
  };
  const std::map<std::string, Option> known = {
    { "arrays", { true, [&](auto&, auto& text) { options.Convert.Arrays = Split(text); } } },
    { "step",
      { true,
        [&](auto& name, auto& text)
        {
          options.Convert.Step = OptionValues::ToNumber(name, text, 0);
          options.HasStep = true;
        } } },
    { "level",
      { true,
        [&](auto& name, auto& text)
        { options.Open.Level = OptionValues::ToNumber(name, text, 0); } } },
    { "levels",
      { true,
        [&](auto& name, auto& text)
        {
          options.Convert.Levels =
            text == "all" ? vol::WriteOptions::AllLevels : OptionValues::ToNumber(name, text, 0);
        } } },
    { "dataset", { true, [&](auto&, auto& text) { options.Open.Dataset = text; } } },
    { "compression",
      { true,
        [&](auto& name, auto& text)
        {
          options.Convert.Pressed = OptionValues::ToChoice<vol::Compression>(name, text,
            { { "none", vol::Compression::None }, { "zstd", vol::Compression::Zstd },
              { "deflate", vol::Compression::Deflate } });
        } } },
    { "brick",
      { true,
        [&](auto& name, auto& text)
        { options.Convert.BrickEdge = OptionValues::ToNumber(name, text, 1); } } },
    { "memory",
      { true,
        [&](auto& name, auto& text)
        {
          options.Convert.MemoryBytes =
            OptionValues::ToNumber<std::size_t>(name, text, 1, MostMebibytes) << 20;
        } } },
    { "threads",
      { true,
        [&](auto& name, auto& text)
        { options.Convert.Threads = OptionValues::ToNumber(name, text, 1, MostThreads); } } },
    { "raw-size",
      { true,
        [&](auto& name, auto& text)
        {
          const auto samples = ToThree<std::int64_t>(name, text, 1);
          options.Open.Bare.Samples = { samples[0], samples[1], samples[2] };
        } } },
    { "raw-type",
      { true,
        [&](auto& name, auto& text)
        {
          options.Open.Bare.Type = OptionValues::ToChoice<Type>(name, text,
            { { "int8", Type::Int8 }, { "uint8", Type::UInt8 }, { "int16", Type::Int16 },
              { "uint16", Type::UInt16 }, { "int32", Type::Int32 }, { "uint32", Type::UInt32 },
              { "int64", Type::Int64 }, { "uint64", Type::UInt64 }, { "float32", Type::Float32 },
              { "float64", Type::Float64 } });
        } } },
    { "raw-header",
      { true,
        [&](auto& name, auto& text) {
          options.Open.Bare.HeaderBytes = OptionValues::ToNumber<std::uint64_t>(name, text, 0);
        } } },
    { "raw-big-endian", { false, [&](auto&, auto&) { options.Open.Bare.BigEndian = true; } } },
    { "spacing",
      { true,
        [&](auto& name, auto& text)
        {
          const auto spacing = ToThree(name, text, 0.0);
          if (std::count(spacing.begin(), spacing.end(), 0.0) > 0)
          {
            throw dsm::Error(name + " takes three numbers above 0, not \"" + text + "\".");
          }
          std::copy(spacing.begin(), spacing.end(), options.Open.Bare.Spacing);
        } } },
    { "quiet", { false, [&](auto&, auto&) { options.IsQuiet = true; } } },
    { "help", { false, [&](auto&, auto&) { options.WantsHelp = true; } } },
  };
  std::vector<option> list;
  for (const auto& [name, entry] : known)
  {
    list.push_back({ name.c_str(), entry.TakesText ? required_argument : no_argument, nullptr, 0 });
  }
  list.push_back({});
  opterr = 0;
  int index = 0;
  for (int found = 0; (found = getopt_long(argc, argv, "h", list.data(), &index)) != -1;)
  {
    if (found == 'h')
    {
      options.WantsHelp = true;
      continue;
    }
    if (found == '?')
    {
      throw dsm::Error("'" + std::string(argv[optind - 1]) +
        "' is no option, or lacks its value; --help lists them.");
    }
    const std::string name = list[static_cast<std::size_t>(index)].name;
    known.at(name).Set("--" + name, optarg ? optarg : "");
    const bool isOfBareValues = name.rfind("raw-", 0) == 0 || name == "spacing";
    options.OfBareValues = isOfBareValues ? "--" + name : options.OfBareValues;
  }
  if (!options.WantsHelp && argc - optind != 2)
  {
    throw dsm::Error("Name the file to read and the file to write; --help tells more.");
  }
  if (!options.WantsHelp)
  {
    options.In = argv[optind];
    options.Out = argv[optind + 1];
  }
  return options;
}

/// Writes a line over, where somebody looks; each number once, for the line stays in the logs of jobs.
class Teller
{
public:
  void operator()(double part)
  {
    const int percent = static_cast<int>(100.0 * part);
    if (std::exchange(this->Told, percent) != percent)
    {
      std::cerr << '\r' << percent << " %" << std::flush;
    }
  }

private:
  int Told = -1;
};

void Convert(Options& options, dsm::Messenger& messenger)
{
  std::shared_ptr<const vol::VolumeFile> file;
  messenger.RunTogether("Opening the volume",
    [&]
    {
      file = vol::OpenVolumeFile(options.In, options.Open);
      if (!options.OfBareValues.empty() && !vol::IsBareFile(options.In))
      {
        throw dsm::Error(options.OfBareValues + " is for bare values (.raw); '" + options.In +
          "' tells itself what it has.");
      }
    });
  if (options.Convert.Threads == 0)
  {
    options.Convert.Threads = messenger.GetCoresPerRank();
  }
  const std::function<void(double)> tell =
    options.IsQuiet ? std::function<void(double)>([](double) {}) : Teller();
  if (messenger.GetRank() == 0 && file->GetSteps() > 1 && !options.HasStep)
  {
    std::cerr << "dsm_convert: '" << options.In << "' has " << file->GetSteps()
              << " time steps (0 to " << file->GetSteps() - 1
              << "); only step 0 is written. Use --step to write another one to a file of its own."
              << std::endl;
  }
  vol::ConvertVolume(file, options.Out, options.Convert, messenger, tell);
  if (messenger.GetRank() == 0 && !options.IsQuiet)
  {
    std::cerr << '\r';
    std::cout << options.Out << ": "
              << std::filesystem::file_size(options.Out) / (std::uintmax_t(1) << 20) << " MiB"
              << std::endl;
  }
}

/// Returns whether the command succeeds. An error is printed by the first rank.
bool Run(int argc, char** argv, dsm::Messenger& messenger)
{
  std::string failure;
  try
  {
    Options options = Parse(argc, argv);
    if (!options.WantsHelp)
    {
      Convert(options, messenger);
    }
    else if (messenger.GetRank() == 0)
    {
      std::cout << Usage;
    }
    return true;
  }
  catch (const std::bad_alloc&)
  {
    failure = "Out of memory. Lower --memory or --threads, or use more hosts.";
  }
  catch (const std::exception& error)
  {
    failure = error.what();
  }
  if (messenger.GetRank() == 0)
  {
    std::cerr << "dsm_convert: " << failure << std::endl;
  }
  return false;
}

} // namespace

int main(int argc, char** argv)
{
  try
  {
    const dsm::MpiTransport::Environment environment(argc, argv);
    auto transport = dsm::MpiTransport::Create(nullptr);
    dsm::Messenger messenger(
      transport ? std::move(transport) : std::move(dsm::LoopbackTransport::CreateGroup(1).front()));
    return Run(argc, argv, messenger) ? EXIT_SUCCESS : EXIT_FAILURE;
  }
  catch (const std::exception& error)
  {
    std::cerr << "dsm_convert: " << error.what() << std::endl;
  }
  catch (...)
  {
    std::cerr << "dsm_convert: an unknown error" << std::endl;
  }
  return EXIT_FAILURE;
}
