// SPDX-License-Identifier: BSD-3-Clause
#include "BenchmarkOptions.h"

void BenchmarkOptions::AddTo(CLI::App& app)
{
  app.add_option("--isovalue", this->Isovalues, "isovalues, with commas (default 0.5)")
    ->delimiter(',')
    ->allow_extra_args(false);
  app.add_option("--opacity", this->Opacity, "of the surfaces")
    ->capture_default_str()
    ->check(CLI::NonNegativeNumber);
  app.add_option("--tile-seconds", this->TileSeconds,
    "on: the result has the mean cost of each tile (default off)");
  app.add_option("--filter", this->Filter,
    "on: the result compares a picture of one sample, whose light is filtered, with those of 16 "
    "and 256 (default off)");
  app.add_option("--looks", this->Looks,
    "on: the result compares pictures in other colors and light, of hits that are known, with the "
    "first one "
    "(default off)");
  this->VolumeOptions::AddTo(app);
  app.get_option("--occlusion")
    ->description(
      "ambient occlusion rays for each hit, a fifth of the volume's diagonal long. With these or "
      "shadows, every frame is also traced without, and the result has the rates of both kinds of "
      "rays");
}
