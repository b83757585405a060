// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/plain/UnpackedCopy.h"

#include "DSMBricks/base/ByteHash.h"
#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/ByteBuffer.h"
#include "DSMVolumeFiles/base/CacheFolder.h"
#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/FileLimits.h"
#include "DSMVolumeFiles/plain/ValueCopy.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <string>
#include <system_error>
#include <thread>

namespace vol
{

namespace
{

constexpr std::size_t BufferBytes = std::size_t(1) << 20;

/// The caller wants no file any more: not an error of the file.
class Aborted final : public dsm::Error
{
public:
  using dsm::Error::Error;
};

void CheckGoesOn(const std::string& path, const std::function<bool()>& goesOn)
{
  if (goesOn && !goesOn())
  {
    throw Aborted("Opening '" + path + "' was aborted.");
  }
}

/// Calls `take` with the unpacked bytes of a part, piece after piece, until its last stream ends or `take` has enough.
template <class Take>
void UnpackPart(const CompressedValues& packed, const CompressedValues::Part& part,
  const std::function<bool()>& goesOn, const Take& take)
{
  const PositionedFile file(part.Place.Path);
  if (file.GetStamp() != part.Place.Stamp)
  {
    throw FileError(file.GetPath(), "changed after it was opened. Reload it.");
  }
  const std::unique_ptr<StreamDecoder> decoder = StreamDecoder::Make(packed.Encoding);
  ByteBuffer in(BufferBytes);
  ByteBuffer out(BufferBytes);
  const std::uint64_t end = part.Place.Offset + part.PackedBytes;
  std::uint64_t at = part.Place.Offset;
  bool isBetween = false; // two streams
  while (at < end)
  {
    CheckGoesOn(file.GetPath(), goesOn);
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(in.size(), end - at));
    file.Read(at, in.data(), count);
    at += count;
    for (std::size_t used = 0;;)
    {
      const auto step = decoder->Decode(in.data() + used, count - used, out.data(), out.size());
      if (!step)
      {
        throw dsm::Error("its compressed values are damaged");
      }
      used += step->Taken;
      isBetween = step->Ended;
      if (!take(out.data(), step->Written, step->Ended))
      {
        return;
      }
      // The decoder may have more to give when all is taken.
      if (used == count && (step->Written < out.size() || step->Ended))
      {
        break;
      }
      if (step->Taken == 0 && step->Written == 0 && !step->Ended)
      {
        throw dsm::Error("its compressed values are damaged");
      }
      CheckGoesOn(file.GetPath(), step->Written > 0 ? goesOn : nullptr);
    }
  }
  if (!isBetween)
  {
    throw dsm::Error("its compressed values end early. The file is truncated or its header is "
                     "wrong");
  }
}

std::uint64_t CountUnpacked(const CompressedValues& packed, const CompressedValues::Part& part,
  const std::function<bool()>& goesOn)
{
  std::uint64_t count = 0;
  UnpackPart(packed, part, goesOn,
    [&](const std::byte*, std::size_t bytes, bool)
    {
      count += bytes;
      return true;
    });
  return count;
}

std::filesystem::path FindPlace(const CompressedValues& packed)
{
  const std::string& path = packed.Parts.front().Place.Path;
  const std::filesystem::path folder = GetCacheFolder();
  if (folder.empty())
  {
    throw FileError(path,
      "is compressed, and there is no folder for its unpacked values. Let XDG_CACHE_HOME name one, "
      "or save the volume without compression.");
  }
  std::error_code failure;
  std::filesystem::create_directories(folder, failure); // writing reports a failure
  bricks::ByteHash hash;
  for (const CompressedValues::Part& part : packed.Parts)
  {
    const std::string whole = std::filesystem::absolute(part.Place.Path, failure).string();
    const std::uint64_t numbers[] = { part.Place.Offset, part.Place.Stamp, part.PackedBytes };
    hash.Add(whole.data(), whole.size());
    hash.Add(numbers, sizeof(numbers));
  }
  const std::uint64_t manner[] = { static_cast<std::uint64_t>(packed.Encoding), packed.PartBytes,
    static_cast<std::uint64_t>(packed.Skip) };
  hash.Add(manner, sizeof(manner));
  return ValueCopy::GetPath(folder, hash.Get());
}

void UnpackTo(ValueCopy& copy, const CompressedValues& packed, const std::function<bool()>& goesOn)
{
  for (const CompressedValues::Part& part : packed.Parts)
  {
    try
    {
      auto skip = static_cast<std::uint64_t>(packed.Skip);
      if (packed.Skip < 0)
      {
        const std::uint64_t all = CountUnpacked(packed, part, goesOn);
        skip = all - std::min(all, packed.PartBytes);
      }
      const std::uint64_t end = skip + packed.PartBytes;
      std::uint64_t at = 0;
      UnpackPart(packed, part, goesOn,
        [&](const std::byte* bytes, std::size_t count, bool hasEnded)
        {
          const std::uint64_t first = std::clamp(skip, at, at + count);
          if (at + count > end)
          {
            throw dsm::Error("it unpacks to more than the " + std::to_string(end) +
              " bytes that its header declares");
          }
          copy.Add(bytes + (first - at), static_cast<std::size_t>(at + count - first));
          at += count;
          return at < end || !hasEnded;
        });
      if (at < end)
      {
        throw dsm::Error("it unpacks to " + std::to_string(at) + " bytes instead of the " +
          std::to_string(end) + " that its header declares");
      }
    }
    catch (const FileError&)
    {
      throw;
    }
    catch (const Aborted&)
    {
      throw;
    }
    catch (const dsm::Error& error)
    {
      throw FileError(part.Place.Path, "cannot be read: " + std::string(error.what()) + ".");
    }
  }
}

} // namespace

ValuePart UnpackOnce(const CompressedValues& packed, const std::function<bool()>& goesOn)
{
  const std::string& path = packed.Parts.front().Place.Path;
  const std::uint64_t growth = StreamDecoder::GetMostGrowth(packed.Encoding);
  for (const CompressedValues::Part& part : packed.Parts)
  {
    const auto most = MultiplyWithin(FileLimits::ArrayBytes, { part.PackedBytes, growth });
    if (most && *most < packed.PartBytes)
    {
      throw FileError(part.Place.Path,
        "has " + std::to_string(part.PackedBytes) + " compressed bytes, which are too few for " +
          std::to_string(packed.PartBytes) +
          " bytes of values. The file is truncated or its header "
          "is wrong.");
    }
  }
  const std::filesystem::path place = FindPlace(packed);
  const std::uint64_t bytes = packed.PartBytes * packed.Parts.size();
  for (;;)
  {
    if (const auto copy = ValueCopy::Find(place, bytes))
    {
      return *copy;
    }
    if (const auto written = ValueCopy::TryBegin(place))
    {
      // Another process may have finished it meanwhile.
      if (const auto copy = ValueCopy::Find(place, bytes))
      {
        return *copy;
      }
      ValueCopy::MakeRoom(path, place.parent_path(), bytes);
      UnpackTo(*written, packed, goesOn);
      written->Finish(bytes);
      if (const auto copy = ValueCopy::Find(place, bytes))
      {
        return *copy;
      }
      throw FileError(place.string(), "has unpacked values, and cannot be read.");
    }
    CheckGoesOn(path, goesOn);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

} // namespace vol
