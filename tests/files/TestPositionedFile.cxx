// SPDX-License-Identifier: BSD-3-Clause
// Many pieces of a file, read in one go.
#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/base/PositionedFile.h"
#include "DSMVolumeFiles/base/ReadingManner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

namespace
{

namespace fs = std::filesystem;
using Piece = vol::PositionedFile::Piece;

std::byte GetPattern(std::uint64_t place)
{
  return static_cast<std::byte>(place * 2654435761u >> 13);
}

/// A file of pattern bytes, for as long as it is in scope.
class PatternFile
{
public:
  explicit PatternFile(std::size_t bytes)
    : Path(fs::path(DSM_TEST_FILES) / "pieces.bin")
  {
    fs::create_directories(this->Path.parent_path());
    std::ofstream file(this->Path, std::ios::binary);
    for (std::uint64_t place = 0; place < bytes; ++place)
    {
      file.put(static_cast<char>(GetPattern(place)));
    }
  }
  ~PatternFile() { fs::remove(this->Path); }

  const fs::path Path;
};

/// Rows of `bytes`, `stride` apart.
std::vector<Piece> MakeRows(std::uint64_t first, std::size_t bytes, std::size_t stride, int count)
{
  std::vector<Piece> rows;
  for (int row = 0; row < count; ++row)
  {
    rows.push_back({ first + static_cast<std::uint64_t>(row) * stride, bytes });
  }
  return rows;
}

void ExpectPieces(const vol::PositionedFile& file, const std::vector<Piece>& pieces)
{
  std::vector<std::byte> expected;
  for (const Piece& piece : pieces)
  {
    for (std::size_t byte = 0; byte < piece.Bytes; ++byte)
    {
      expected.push_back(GetPattern(piece.Offset + byte));
    }
  }
  std::vector<std::byte> found(expected.size());
  file.Read(pieces, found.data());
  EXPECT_EQ(found, expected);
}

TEST(PositionedFile, PiecesComeOneBehindTheOther)
{
  const PatternFile pattern(4000000);
  const vol::PositionedFile file(pattern.Path.string());
  ExpectPieces(file, {});
  ExpectPieces(file, { { 17, 1 } });
  ExpectPieces(file, MakeRows(5, 68, 68, 17));      // without gaps
  ExpectPieces(file, MakeRows(5, 68, 256, 17));     // near one another
  ExpectPieces(file, MakeRows(5, 68, 200000, 17));  // far
  ExpectPieces(file, MakeRows(5, 4000, 9000, 400)); // near, and more than are read together
  ExpectPieces(file, { { 0, 3 }, { 3, 0 }, { 8000, 5 }, { 100000, 2000000 }, { 2100001, 1 } });
}

TEST(PositionedFile, PiecesBehindTheEndAreRefusedWithTheirPlace)
{
  const PatternFile pattern(10000);
  const vol::PositionedFile file(pattern.Path.string());
  std::vector<std::byte> out(1000);
  try
  {
    file.Read(MakeRows(9000, 100, 300, 5), out.data());
    FAIL() << "the last piece ends behind the file";
  }
  catch (const dsm::Error& error)
  {
    const std::string text = error.what();
    EXPECT_NE(text.find("ends at byte 10000"), std::string::npos) << text;
    EXPECT_NE(text.find("truncated"), std::string::npos) << text;
  }
}

TEST(PositionedFile, PiecesOfAFileThatWasWrittenToAreRefused)
{
  const PatternFile pattern(10000);
  const vol::PositionedFile file(pattern.Path.string());
  std::ofstream(pattern.Path, std::ios::binary | std::ios::app) << "more";
  std::vector<std::byte> out(1000);
  EXPECT_THROW(file.Read(MakeRows(0, 100, 300, 10), out.data()), dsm::Error);
}

void LeaveMemory(const fs::path& path)
{
  const int file = open(path.c_str(), O_RDONLY);
  fsync(file);
  posix_fadvise(file, 0, 0, POSIX_FADV_DONTNEED);
  close(file);
}

TEST(PositionedFile, WhatIsNotInMemoryIsNotWaitedFor)
{
  const PatternFile pattern(1000000);
  const vol::PositionedFile file(pattern.Path.string());
  LeaveMemory(pattern.Path);
  std::vector<std::byte> out(100);
  const auto read = [&](std::uint64_t offset)
  {
    const vol::WithoutWaiting scope;
    file.Read(offset, out.data(), out.size());
  };
  try
  {
    read(500000);
    GTEST_SKIP() << "the file cannot be made to leave the system's memory";
  }
  catch (const vol::WouldWait& wait)
  {
    if (wait.Always)
    {
      GTEST_SKIP() << "the file system does not tell what is in memory";
    }
  }
  EXPECT_FALSE(vol::WithoutWaiting::IsInForce());
  file.Read(500000, out.data(), out.size()); // waits
  out.assign(out.size(), std::byte(0));
  read(500000);
  EXPECT_EQ(out.back(), GetPattern(500099));

  LeaveMemory(pattern.Path);
  auto rows = MakeRows(500000, 100, 3000, 10);
  std::reverse(rows.begin(), rows.end());
  rows.push_back(rows[3]); // once more
  file.Prefetch(std::move(rows));
  for (int attempt = 0; attempt < 1000; ++attempt) // the disk may take a while
  {
    try
    {
      read(500000);
      break;
    }
    catch (const vol::WouldWait&)
    {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
  read(527000);
  EXPECT_EQ(out.front(), GetPattern(527000));
  EXPECT_THROW(read(1000000), dsm::Error) << "behind the end";
}

TEST(PositionedFile, OpeningOneMayWait)
{
  const PatternFile pattern(10);
  const vol::WithoutWaiting scope;
  EXPECT_THROW(vol::PositionedFile(pattern.Path.string()), vol::WouldWait);
}

} // namespace
