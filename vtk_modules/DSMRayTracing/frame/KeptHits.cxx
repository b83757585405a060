// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/KeptHits.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace rt
{

bool KeptHits::Begin(const Key& key, int tiles, std::size_t most, bool keeps)
{
  const bool isNewStep =
    this->Last.Data != 0 && key.Data != this->Last.Data && key.Shapes != this->Last.Shapes;
  for (auto picture = this->Pictures.begin(); picture != this->Pictures.end();)
  {
    const auto next = std::next(picture);
    if (key.Data != this->Last.Data && picture->Shapes != key.Shapes)
    {
      this->Drop(picture);
    }
    picture = next;
  }
  this->Last = key;
  this->Most = most;
  this->Keeps = keeps && !isNewStep;
  const auto known = std::find_if(this->Pictures.begin(), this->Pictures.end(),
    [&](const Picture& picture) { return picture.Digest == key.Picture; });
  if (known != this->Pictures.end())
  {
    std::transform(known->Tiles.begin(), known->Tiles.end(), known->Known.begin(),
      [](const std::vector<TileHits>& samples)
      { return static_cast<std::uint8_t>(samples.size()); });
    this->Pictures.splice(this->Pictures.begin(), this->Pictures, known);
  }
  else if (this->Keeps)
  {
    std::vector<std::vector<TileHits>> empty(static_cast<std::size_t>(tiles));
    std::vector<std::uint8_t> none(empty.size(), 0);
    this->Pictures.emplace_front();
    this->Pictures.front().Digest = key.Picture;
    this->Pictures.front().Shapes = key.Shapes;
    this->Pictures.front().Tiles = std::move(empty);
    this->Pictures.front().Known = std::move(none);
  }
  else
  {
    return false;
  }
  while (this->Pictures.size() > MostPictures)
  {
    this->Drop(std::prev(this->Pictures.end()));
  }
  this->Shown = &this->Pictures.front();
  this->MakeRoom(0);
  return true;
}

void KeptHits::Keep(int tile, std::vector<TileHits> hits)
{
  for (TileHits& sample : hits)
  {
    sample.GiveBackMemory();
    const std::size_t bytes = sample.CountBytes();
    if (!this->MakeRoom(bytes))
    {
      return;
    }
    this->Shown->Bytes += bytes;
    this->Shown->Tiles[static_cast<std::size_t>(tile)].push_back(std::move(sample));
  }
}

void KeptHits::Drop(std::list<Picture>::iterator picture)
{
  this->Bytes -= picture->Bytes;
  this->Pictures.erase(picture);
}

/// Takes so many bytes, from other pictures if need be. Returns whether there are as many.
bool KeptHits::MakeRoom(std::size_t bytes)
{
  this->Bytes += bytes;
  if (this->Bytes <= this->Most)
  {
    return true;
  }
  const std::scoped_lock lock(this->Access);
  while (this->Bytes > this->Most && this->Pictures.size() > 1)
  {
    this->Drop(std::prev(this->Pictures.end()));
  }
  if (this->Bytes <= this->Most)
  {
    return true;
  }
  this->Bytes -= bytes;
  return false;
}

} // namespace rt
