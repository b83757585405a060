// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TileGrid_h
#define rt_TileGrid_h

#include "DSMRayTracing/frame/Frame.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace rt
{

/// Cuts a frame into square tiles, row-major from the lower left; those at the upper and right
/// border may be smaller.
class TileGrid
{
public:
  TileGrid(int width, int height, int tileSize)
    : Width(width)
    , Height(height)
    , TileSize(tileSize)
    , Columns((width + tileSize - 1) / tileSize)
    , Rows((height + tileSize - 1) / tileSize)
  {
  }

  int GetCount() const { return this->Columns * this->Rows; }
  int GetColumns() const { return this->Columns; }

  /// Returns the numbers of all tiles.
  std::vector<int> ListTiles() const
  {
    std::vector<int> tiles(static_cast<std::size_t>(this->GetCount()));
    std::iota(tiles.begin(), tiles.end(), 0);
    return tiles;
  }

  /// The tile's place and size, without pixels.
  Tile CreateTile(int index) const
  {
    Tile tile;
    tile.Index = index;
    tile.X = (index % this->Columns) * this->TileSize;
    tile.Y = (index / this->Columns) * this->TileSize;
    tile.Width = std::min(this->TileSize, this->Width - tile.X);
    tile.Height = std::min(this->TileSize, this->Height - tile.Y);
    return tile;
  }

private:
  int Width;
  int Height;
  int TileSize;
  int Columns;
  int Rows;
};

} // namespace rt

#endif
