// SPDX-License-Identifier: BSD-3-Clause
#include "VolumeOptions.h"

void VolumeOptions::AddTo(CLI::App& app)
{
  app
    .add_option("--volume", this->Volume,
      "sphere:N:TYPE, rm:N:TYPE (N^3 samples of char, uchar, short, ushort, int, uint, long, "
      "ulong, float, double; with :rectilinear, planes in tables), or a .vti "
      "file, or a file that stays where it is (HDF5, Zarr, ...), with a cache of --memory")
    ->capture_default_str();
  app.add_option("--session", this->Session,
    "positions and isovalues from a file instead of an orbit; isosurface counts each repetition as "
    "a whole, the first one apart");
  app
    .add_option("--memory", this->Mebibytes,
      "MiB per rank for bricks and cache; 0: half of what the host has left, divided by its ranks")
    ->capture_default_str();
  app
    .add_option("--cache-fraction", this->CacheFraction,
      "cache per rank, as a part of the bytes of all bricks")
    ->capture_default_str()
    ->check(CLI::NonNegativeNumber);
  app
    .add_option(
      "--brick-edge", this->BrickEdge, "cells along a brick's edge (default: by the scalar type)")
    ->check(CLI::Range(4, 1 << 20));
  app.add_option("--tile-size", this->TileSize, "pixels along a tile's edge")
    ->capture_default_str()
    ->check(CLI::PositiveNumber);
  app.add_option(
    "--shadows", this->Shadows, "on: hard shadows of a lamp beside the camera; off (default)");
  app.add_option("--light-radius", this->LightRadius, "above 0: shadows are soft")
    ->capture_default_str()
    ->check(CLI::NonNegativeNumber);
  app
    .add_option("--occlusion", this->Occlusion,
      "ambient occlusion rays for each place that is lit, a fifth of the volume's diagonal long")
    ->capture_default_str()
    ->check(CLI::NonNegativeNumber);
  app.add_option("--samples", this->Samples, "per pixel")
    ->capture_default_str()
    ->check(CLI::PositiveNumber);
  app
    .add_option("--tolerance", this->Tolerance,
      "standard error, in steps of 255, at which pixels get no more samples; 0: all get them")
    ->capture_default_str()
    ->check(CLI::NonNegativeNumber);
  app.add_option("--picture", this->Picture, "PPM file for the picture of the first position");
  this->RunOptions::AddTo(app);
}
