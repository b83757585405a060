// SPDX-License-Identifier: BSD-3-Clause
#include "BenchmarkOptions.h"

#include "DSMCore/Error.h"

#include <functional>
#include <map>
#include <sstream>

namespace
{

template <class T>
T ToNumber(const std::string& name, const std::string& text, T smallest)
{
  std::istringstream stream(text);
  T value{};
  if (!(stream >> value) || !stream.eof() || value < smallest)
  {
    std::ostringstream message;
    message << name << " takes a number of at least " << smallest << ", not \"" << text << "\".";
    throw dsm::Error(message.str());
  }
  return value;
}

std::vector<double> ToNumbers(const std::string& name, const std::string& text)
{
  std::vector<double> values;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');)
  {
    values.push_back(ToNumber<double>(name, part, -1e300));
  }
  return values;
}

} // namespace

const char* BenchmarkOptions::Usage()
{
  return "usage: dsm_bench isosurface [options], alone or under mpirun\n"
         "  --volume V          sphere:N:TYPE, rm:N:TYPE (N^3 samples of char, uchar, short, "
         "ushort,\n"
         "                      int, uint, long, ulong, float, double), or a file in .vti format\n"
         "  --isovalue A[,B..]  isovalues (default 0.5)\n"
         "  --size WxH          pixels (default 512x512)\n"
         "  --frames N          camera positions around the volume (default 20)\n"
         "  --repeat R          orbits; for every position the fastest counts (default 1)\n"
         "  --threads T         tracing threads per rank (default 0: cores / ranks of the host)\n"
         "  --store object      memory organisation\n"
         "  --cache-fraction F  cache per rank, as a part of the bytes of all bricks (default 1)\n"
         "  --brick-edge E      cells along a brick's edge (default: by the scalar type)\n"
         "  --picture FILE.ppm  writes the picture of the first position\n"
         "  --json FILE         writes the result; - is standard output\n";
}

BenchmarkOptions BenchmarkOptions::Parse(int argc, char** argv)
{
  BenchmarkOptions options;
  const std::map<std::string, std::function<void(const std::string&, const std::string&)>> setters{
    { "--volume", [&](const auto&, const auto& text) { options.Volume = text; } },
    { "--isovalue",
      [&](const auto& name, const auto& text) { options.Isovalues = ToNumbers(name, text); } },
    { "--size",
      [&](const auto& name, const auto& text)
      {
        const auto x = text.find('x');
        options.Width = ToNumber(name, text.substr(0, x), 1);
        options.Height = ToNumber(name, x == std::string::npos ? "" : text.substr(x + 1), 1);
      } },
    { "--frames",
      [&](const auto& name, const auto& text) { options.Frames = ToNumber(name, text, 1); } },
    { "--repeat",
      [&](const auto& name, const auto& text) { options.Repeat = ToNumber(name, text, 1); } },
    { "--threads",
      [&](const auto& name, const auto& text) { options.Threads = ToNumber(name, text, 0); } },
    { "--store",
      [&](const auto& name, const auto& text)
      {
        if (text != "object")
        {
          throw dsm::Error(name + " knows object, not \"" + text + "\".");
        }
        options.Store = text;
      } },
    { "--cache-fraction",
      [&](const auto& name, const auto& text)
      { options.CacheFraction = ToNumber<double>(name, text, 0.0); } },
    { "--brick-edge",
      [&](const auto& name, const auto& text) { options.BrickEdge = ToNumber(name, text, 4); } },
    { "--picture", [&](const auto&, const auto& text) { options.Picture = text; } },
    { "--json", [&](const auto&, const auto& text) { options.Json = text; } },
  };
  if (argc < 2 || std::string(argv[1]) != "isosurface")
  {
    throw dsm::Error(
      std::string("The first argument names the benchmark: isosurface.\n") + Usage());
  }
  for (int argument = 2; argument < argc; argument += 2)
  {
    const std::string name = argv[argument];
    const auto setter = setters.find(name);
    if (setter == setters.end() || argument + 1 >= argc)
    {
      throw dsm::Error("Option " + name +
        (setter == setters.end() ? " is not known.\n" : " lacks its value.\n") + Usage());
    }
    setter->second(name, argv[argument + 1]);
  }
  return options;
}
