// SPDX-License-Identifier: BSD-3-Clause
// Writes a volume as a brick file, alone or with several MPI ranks.
#include "DSMCore/base/Error.h"
#include "DSMCore/transport/LoopbackTransport.h"
#include "DSMCore/transport/Messenger.h"
#include "DSMCore/transport/MpiTransport.h"
#include "DSMVolumeFiles/open/OpenVolumeFile.h"
#include "DSMVolumeFiles/write/ConvertVolume.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iostream>
#include <limits>
#include <map>
#include <new>
#include <utility>

namespace
{

constexpr std::size_t MostMebibytes = std::size_t(1) << 40;
constexpr int Most = std::numeric_limits<int>::max();
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
};

template <class T>
CLI::Option* AddChoice(CLI::App& app, const std::string& name, T& value,
  const std::map<std::string, T>& choices, const std::string& text)
{
  return app
    .add_option_function<std::string>(
      name, [&value, choices](const std::string& word) { value = choices.at(word); }, text)
    ->check(CLI::IsMember(choices));
}

/// Names of scalar types in VTK and ParaView, and the names here.
const std::map<std::string, std::string> VtkTypes = { { "signed char", "int8" },
  { "unsigned char", "uint8" }, { "short", "int16" }, { "unsigned short", "uint16" },
  { "int", "int32" }, { "unsigned int", "uint32" }, { "long long", "int64" },
  { "unsigned long long", "uint64" }, { "float", "float32" }, { "double", "float64" } };

/// Three numbers with commas between them.
template <class T>
void AddThree(CLI::App& app, const std::string& name, T* numbers, const std::string& text)
{
  const auto set = [name, numbers](const std::vector<T>& given)
  {
    if (given.size() != 3 ||
      !std::all_of(given.begin(), given.end(), [](T number) { return number > 0; }))
    {
      throw CLI::ValidationError(
        name, "requires three positive numbers separated by commas, such as 1,1,2");
    }
    std::copy(given.begin(), given.end(), numbers);
  };
  app.add_option_function<std::vector<T>>(name, set, text)->delimiter(',')->allow_extra_args(false);
}

/// Throws CLI::ParseError.
Options Parse(CLI::App& app, int argc, char** argv)
{
  Options options;
  vol::ConvertOptions& convert = options.Convert;
  vol::OpenOptions::Raw& bare = options.Open.Bare;
  const CLI::Range atLeastZero(0, Most, "N");
  convert.Threads = 0;
  std::size_t mebibytes = 0;
  app
    .add_option("IN", options.In,
      "volume to read, in a format of DSM Volume Reader: HDF5, Zarr (its folder, or its address: "
      "https://HOST/image.zarr), NRRD, MetaImage, raw")
    ->required();
  app
    .add_option(
      "OUT", options.Out, "file to write (VTKHDF image data), such as volume.vtkhdf or volume.h5")
    ->required();
  app
    .add_option("--arrays", convert.Arrays,
      "names of the arrays to write, separated by commas (default: all)")
    ->delimiter(',')
    ->allow_extra_args(false);
  CLI::Option* const step =
    app.add_option("--step", convert.Step, "time step to read (default: 0)")->check(atLeastZero);
  app.add_option("--level", options.Open.Level, "level of detail to read (default: 0, the finest)")
    ->check(atLeastZero);
  app.add_option("--dataset", options.Open.Dataset,
    "dataset to read in an HDF5 file that is not VTKHDF, or image or group in a Zarr folder");
  app
    .add_option("--levels", convert.Levels,
      "number of coarser levels to write, each with half the samples along each axis, for display "
      "while the camera moves; 'all' ends with a level of one brick (default: 0)")
    ->transform(
      CLI::Transformer(std::map<std::string, int>{ { "all", vol::WriteOptions::AllLevels } }))
    ->check(atLeastZero);
  AddChoice<vol::Compression>(app, "--compression", convert.Pressed,
    { { "none", vol::Compression::None }, { "zstd", vol::Compression::Zstd },
      { "deflate", vol::Compression::Deflate } },
    "compression: none (default), zstd, or deflate; for zstd, other programs need the HDF5 plugin");
  app
    .add_option("--brick", convert.BrickEdge,
      "cells along each axis of a brick (default: as in the renderer, 16 to 32)")
    ->check(CLI::Range(1, Most, "N"));
  app.add_option("--memory", mebibytes, "memory for values in MiB per rank (default: 512)")
    ->check(CLI::Range(std::size_t(1), MostMebibytes, "MIB"));
  app
    .add_option("--threads", convert.Threads,
      "threads per rank (default: the host's cores divided by its ranks)")
    ->check(CLI::Range(1, MostThreads, "N"));
  app.add_flag("--quiet", options.IsQuiet, "do not print progress");

  AddThree(app, "--spacing", options.Open.Spacing.data(),
    "distance between samples along x, y and z, separated by commas (default: as the file says)");
  app
    .add_option("--origin", options.Open.Origin,
      "position of the first sample along x, y and z, separated by commas (default: as the file "
      "says)")
    ->delimiter(',');

  CLI::App& raw = *app.add_option_group("Options for .raw files");
  AddThree(
    raw, "--raw-size", &bare.Samples[0], "number of samples along x, y and z, separated by commas");
  using Type = bricks::ScalarType;
  AddChoice<Type>(raw, "--raw-type", bare.Type,
    { { "int8", Type::Int8 }, { "uint8", Type::UInt8 }, { "int16", Type::Int16 },
      { "uint16", Type::UInt16 }, { "int32", Type::Int32 }, { "uint32", Type::UInt32 },
      { "int64", Type::Int64 }, { "uint64", Type::UInt64 }, { "float32", Type::Float32 },
      { "float64", Type::Float64 } },
    "scalar type of the values")
    ->transform(
      [](const std::string& word)
      {
        const auto known = VtkTypes.find(word);
        return known != VtkTypes.end() ? known->second : word;
      });
  raw
    .add_option(
      "--raw-header", bare.HeaderBytes, "number of bytes before the first value (default: 0)")
    ->check(CLI::Range(std::int64_t(0), std::numeric_limits<std::int64_t>::max(), "BYTES"));
  raw.add_flag("--raw-big-endian", bare.BigEndian, "values are big-endian");

  app.parse(argc, argv);
  convert.MemoryBytes = mebibytes > 0 ? mebibytes << 20 : convert.MemoryBytes;
  options.HasStep = step->count() > 0;
  for (const CLI::Option* option : raw.get_options())
  {
    options.OfBareValues = option->count() > 0 ? option->get_name() : options.OfBareValues;
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
        throw dsm::Error(
          options.OfBareValues + " applies to .raw files only; '" + options.In + "' has a header.");
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
              << "); only step 0 is written. Use --step to write another step to a separate file."
              << std::endl;
  }
  if (messenger.GetRank() == 0)
  {
    for (const std::string& warning : file->GetWarnings())
    {
      std::cerr << "dsm_convert: '" << options.In << "' " << warning << std::endl;
    }
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
  CLI::App app(
    "Writes a volume in bricks, so that the first picture reads only the visible bricks. Runs with "
    "or without mpirun. If it is interrupted, run the same command again to resume.");
  std::string failure;
  try
  {
    Options options = Parse(app, argc, argv);
    Convert(options, messenger);
    return true;
  }
  catch (const CLI::CallForHelp&)
  {
    std::cout << (messenger.GetRank() == 0 ? app.help() : "");
    return true;
  }
  catch (const std::bad_alloc&)
  {
    failure = "out of memory. Lower --memory or --threads, or use more hosts.";
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
