// SPDX-License-Identifier: BSD-3-Clause
#include "BenchmarkOptions.h"

const char* BenchmarkOptions::Usage()
{
  return "usage: dsm_bench isosurface [options], alone or under mpirun\n"
         "  --volume V          sphere:N:TYPE, rm:N:TYPE (N^3 samples of char, uchar, short, "
         "ushort,\n"
         "                      int, uint, long, ulong, float, double), or a .vti file, or a file "
         "that\n"
         "                      stays where it is (HDF5, Zarr, ...), with a cache of --memory\n"
         "  --isovalue A[,B..]  isovalues (default 0.5)\n"
         "  --size WxH          pixels (default 512x512)\n"
         "  --frames N          camera positions around the volume (default 20)\n"
         "  --session FILE      positions and isovalues from a file instead; each repetition "
         "counts "
         "as a\n"
         "                      whole, the first one apart\n"
         "  --repeat R          orbits; for every position the fastest counts (default 1)\n"
         "  --threads T         tracing threads per rank (default 0: cores / ranks of the host)\n"
         "  --store S           automatic, replicated, object (default) or paged\n"
         "  --host-sharing H    on: ranks of one host read one another's bricks in place; off\n"
         "                      (default): one machine plays many hosts, as the paper's figures "
         "need\n"
         "  --memory MIB        memory per rank for bricks and cache (default 0: half of what the\n"
         "                      host has left, divided by its ranks)\n"
         "  --cache-fraction F  cache per rank, as a part of the bytes of all bricks (default 1)\n"
         "  --brick-edge E      cells along a brick's edge (default: by the scalar type)\n"
         "  --tile-size N       pixels along a tile's edge (default 16)\n"
         "  --shadows S         on: hard shadows of a lamp beside the camera; off (default)\n"
         "  --occlusion N       ambient occlusion rays for each hit, a fifth of the volume's\n"
         "                      diagonal long (default 0). With either, every frame is also "
         "traced\n"
         "                      without, and the result has the rates of both kinds of rays\n"
         "  --opacity O         of the surfaces (default 1)\n"
         "  --samples N         per pixel (default 1)\n"
         "  --tile-seconds T    on: the result has the mean cost of each tile "
         "(default off)\n"
         "  --picture FILE.ppm  writes the picture of the first position\n"
         "  --overlap N         workers per thread: while some wait for bricks, others trace "
         "(default 4)\n"
         "  --prefetch P        off: bricks are asked for when rays come to them, none ahead "
         "(default on)\n"
         "  --scheduler S       queue (rank 0 deals out tiles) or stealing (default)\n"
         "  --latency US        microseconds that are added to every message's way (default 0)\n"
         "  --json FILE         writes the result; - is standard output\n";
}

void BenchmarkOptions::AddTo(OptionValues::Setters& setters)
{
  using namespace OptionValues;
  this->RunOptions::AddTo(setters);
  setters.merge(Setters{
    { "--volume", [this](const auto&, const auto& text) { this->Volume = text; } },
    { "--isovalue",
      [this](const auto& name, const auto& text)
      { this->Isovalues = ToNumbers<double>(name, text, -1e300); } },
    { "--memory",
      [this](const auto& name, const auto& text)
      { this->MemoryBytes = ToNumber<std::uint64_t>(name, text, 0) << 20; } },
    { "--cache-fraction",
      [this](const auto& name, const auto& text)
      { this->CacheFraction = ToNumber<double>(name, text, 0.0); } },
    { "--brick-edge",
      [this](const auto& name, const auto& text) { this->BrickEdge = ToNumber(name, text, 4); } },
    { "--tile-size",
      [this](const auto& name, const auto& text) { this->TileSize = ToNumber(name, text, 1); } },
    { "--shadows",
      [this](const auto& name, const auto& text) { this->Shadows = ToSwitch(name, text); } },
    { "--occlusion",
      [this](const auto& name, const auto& text) { this->Occlusion = ToNumber(name, text, 0); } },
    { "--opacity",
      [this](const auto& name, const auto& text)
      { this->Opacity = ToNumber<float>(name, text, 0.0f); } },
    { "--samples",
      [this](const auto& name, const auto& text) { this->Samples = ToNumber(name, text, 1); } },
    { "--session", [this](const auto&, const auto& text) { this->Session = text; } },
    { "--tile-seconds",
      [this](const auto& name, const auto& text) { this->TileSeconds = ToSwitch(name, text); } },
    { "--picture", [this](const auto&, const auto& text) { this->Picture = text; } },
  });
}

BenchmarkOptions BenchmarkOptions::Parse(int argc, char** argv)
{
  BenchmarkOptions options;
  OptionValues::Setters setters;
  options.AddTo(setters);
  OptionValues::Parse(argc, argv, setters, Usage());
  return options;
}
