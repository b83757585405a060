// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/cells/ExactScale.h"
#include "DSMBricks/cells/SharedPlaces.h"
#include "DSMCore/base/Error.h"
#include "tests/support/LimitedCluster.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <mutex>
#include <random>
#include <string>
#include <tuple>
#include <vector>

namespace
{

using Place = std::array<float, 3>;
using PlacesOfRanks = std::vector<std::vector<Place>>;
constexpr float NaN = std::numeric_limits<float>::quiet_NaN();
constexpr std::size_t Width = 2;

std::int64_t GetOwnNumber(std::size_t rank, std::size_t point)
{
  return static_cast<std::int64_t>(1000 * (rank + 1) + point) *
    (point % 2 == 0 ? std::int64_t(1) << 40 : -1);
}

bool IsFinitePlace(const Place& place)
{
  return std::all_of(
    place.begin(), place.end(), [](float coordinate) { return std::isfinite(coordinate); });
}

/// The sums that all points have to get, found without any exchange.
std::vector<std::vector<std::int64_t>> FindExpected(const PlacesOfRanks& all)
{
  std::map<Place, std::int64_t> sums; // zeros of both signs are equal
  for (std::size_t rank = 0; rank < all.size(); ++rank)
  {
    for (std::size_t point = 0; point < all[rank].size(); ++point)
    {
      if (IsFinitePlace(all[rank][point]))
      {
        sums[all[rank][point]] += GetOwnNumber(rank, point);
      }
    }
  }
  std::vector<std::vector<std::int64_t>> expected(all.size());
  for (std::size_t rank = 0; rank < all.size(); ++rank)
  {
    for (std::size_t point = 0; point < all[rank].size(); ++point)
    {
      const Place& place = all[rank][point];
      expected[rank].push_back(IsFinitePlace(place) ? sums[place] : GetOwnNumber(rank, point));
    }
  }
  return expected;
}

void ExpectSums(const PlacesOfRanks& all, int threads)
{
  const auto expected = FindExpected(all);
  RunOnLimitedCluster(static_cast<int>(all.size()), 256,
    [&](dsm::Messenger& messenger)
    {
      const auto rank = static_cast<std::size_t>(messenger.GetRank());
      const std::vector<Place>& mine = all[rank];
      const auto getPlace = [&](std::uint64_t point, float place[3])
      {
        std::copy_n(mine[point].begin(), 3, place);
        return IsFinitePlace(mine[point]);
      };
      const bricks::SharedPlaces places("test", mine.size(), getPlace, threads, messenger);
      for (int repeat = 0; repeat < 2; ++repeat)
      {
        std::vector<std::int64_t> records;
        std::vector<std::int64_t> wanted;
        for (std::size_t point = 0; point < mine.size(); ++point)
        {
          const std::int64_t own = GetOwnNumber(rank, point);
          records.insert(records.end(), { own, -own });
          wanted.insert(wanted.end(), { expected[rank][point], -expected[rank][point] });
        }
        places.Sum("test", records.data(), Width);
        EXPECT_EQ(records, wanted) << "rank " << rank;
      }
      for (std::size_t point = 0; point < mine.size(); ++point)
      {
        const auto first = IsFinitePlace(mine[point])
          ? std::find(mine.begin(), mine.end(), mine[point]) - mine.begin()
          : static_cast<std::ptrdiff_t>(point);
        EXPECT_EQ(places.GetFirst(point), static_cast<std::uint64_t>(first));
      }
    });
}

std::vector<Place> CreateRandomPlaces(unsigned seed, std::size_t count, int values)
{
  std::mt19937 random(seed);
  std::vector<Place> places(count);
  for (Place& place : places)
  {
    for (float& coordinate : place)
    {
      coordinate = 0.1f *
        static_cast<float>(static_cast<int>(random() % static_cast<unsigned>(values)) - values / 2);
    }
  }
  return places;
}

} // namespace

TEST(SharedPlaces, PointsOfOneRank)
{
  ExpectSums({ { { 1, 2, 3 }, { 3, 2, 1 }, { 1, 2, 3 }, { 1, 2, 4 }, { 1, 2, 3 } } }, 1);
}

TEST(SharedPlaces, ZerosOfBothSignsAreTheSame)
{
  ExpectSums(
    { { { 0.0f, 1, -0.0f }, { -0.0f, 1, 0.0f } }, { { -0.0f, 1, -0.0f }, { 5, 5, 5 } } }, 1);
}

TEST(SharedPlaces, PointsThatAreNotFiniteTakeNoPart)
{
  const float infinity = std::numeric_limits<float>::infinity();
  ExpectSums({ { { NaN, 0, 0 }, { NaN, 0, 0 }, { infinity, 0, 0 }, { 1, 1, 1 } },
               { { NaN, 0, 0 }, { infinity, 0, 0 }, { 1, 1, 1 } } },
    2);
}

TEST(SharedPlaces, RanksWithoutPoints)
{
  ExpectSums({ {}, { { 1, 1, 1 }, { 2, 2, 2 } }, {}, { { 2, 2, 2 } } }, 1);
  ExpectSums({ {}, {} }, 1);
  ExpectSums({ {} }, 1);
}

TEST(SharedPlaces, AllPointsAreAtOnePlace)
{
  const std::vector<Place> same(500, Place{ 1, 2, 3 });
  ExpectSums({ same, same, same }, 2);
}

TEST(SharedPlaces, RandomPoints)
{
  for (const std::size_t ranks : { 1, 2, 3, 5 })
  {
    PlacesOfRanks all;
    for (std::size_t rank = 0; rank < ranks; ++rank)
    {
      all.push_back(CreateRandomPlaces(static_cast<unsigned>(7 * ranks + rank), 3000, 17));
    }
    ExpectSums(all, 2);
  }
}

TEST(SharedPlaces, ManyPointsAreFoundByAnyThreads)
{
  // More than one chunk of points, and many parts.
  const std::vector<Place> places = CreateRandomPlaces(3, 300000, 80);
  const auto getPlace = [&](std::uint64_t point, float place[3])
  {
    std::copy_n(places[point].begin(), 3, place);
    return true;
  };
  const bricks::EqualPlaces one = bricks::FindEqualPlaces(places.size(), getPlace, 1);
  const bricks::EqualPlaces three = bricks::FindEqualPlaces(places.size(), getPlace, 3);
  EXPECT_EQ(one.Points, three.Points);
  EXPECT_EQ(one.Ends, three.Ends);
  std::map<Place, std::size_t> counts;
  for (const Place& place : places)
  {
    ++counts[place];
  }
  const auto isShared = [](const auto& place) { return place.second > 1; };
  EXPECT_EQ(one.Ends.size(),
    static_cast<std::size_t>(std::count_if(counts.begin(), counts.end(), isShared)));
  one.ForEach(
    [&](const std::uint32_t* points, std::uint32_t count)
    {
      EXPECT_TRUE(std::is_sorted(points, points + count));
      EXPECT_EQ(counts[places[points[0]]], count);
      EXPECT_TRUE(std::all_of(points, points + count,
        [&](std::uint32_t point) { return places[point] == places[points[0]]; }));
    });
}

TEST(SharedPlaces, FailsOnAllRanks)
{
  std::mutex guard;
  std::vector<std::string> texts;
  RunOnCluster(3,
    [&](dsm::Messenger& messenger)
    {
      const auto getPlace = [&](std::uint64_t, float*) -> bool
      {
        if (messenger.GetRank() == 1)
        {
          throw dsm::Error("no such point");
        }
        return false;
      };
      try
      {
        const bricks::SharedPlaces places("Joining points", 5, getPlace, 1, messenger);
        ADD_FAILURE() << "rank " << messenger.GetRank() << " did not fail";
      }
      catch (const dsm::Error& error)
      {
        const std::lock_guard<std::mutex> lock(guard);
        texts.emplace_back(error.what());
      }
    });
  EXPECT_EQ(texts, std::vector<std::string>(3, "Joining points: Rank 1: no such point"));
}

TEST(ExactScale, SumsDoNotDependOnTheOrder)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<double> power(-50.0, 0.0);
  std::vector<double> numbers;
  double largest = 0.0;
  for (int index = 0; index < 10000; ++index)
  {
    numbers.push_back((index % 2 == 0 ? 1.0 : -1.0) * std::exp2(power(random)));
    largest = std::max(largest, std::abs(numbers.back()));
  }
  const bricks::ExactScale scale(largest);
  const auto sum = [&]
  {
    std::int64_t integers = 0;
    for (const double number : numbers)
    {
      integers += scale.Fix(number);
    }
    return integers;
  };
  const std::int64_t expected = sum();
  double plain = 0.0;
  for (const double number : numbers)
  {
    plain += number;
  }
  EXPECT_NEAR(static_cast<double>(expected) * scale.GetUnit(), plain, 1e-8);
  for (int repeat = 0; repeat < 5; ++repeat)
  {
    std::shuffle(numbers.begin(), numbers.end(), random);
    EXPECT_EQ(sum(), expected);
  }
}

TEST(ExactScale, ManyLargeNumbersDoNotOverflow)
{
  for (const double number : { 1.0, std::nextafter(2.0, 0.0), 3e-30, 1e300 })
  {
    const bricks::ExactScale scale(number);
    const auto count = std::int64_t(1) << 20;
    const std::int64_t sum = scale.Fix(number) * count;
    EXPECT_GT(sum, 0);
    const double mean = static_cast<double>(sum) / static_cast<double>(count);
    EXPECT_NEAR(mean * scale.GetUnit(), number, 1e-12 * number);
  }
}

TEST(ExactScale, HoldsAnyNumber)
{
  for (const double number : { 0.0, 5e-324, 1e-310, 1e-290, 1.0, 1.7e308 })
  {
    const bricks::ExactScale scale(number);
    EXPECT_GT(scale.GetPower(), bricks::ExactScale().GetPower());
    EXPECT_NEAR(static_cast<double>(scale.Fix(number)) * scale.GetUnit(), number,
      std::max(1e-12 * number, 1e-300));
  }
}

TEST(ExactScale, ShiftsToALargerScale)
{
  const bricks::ExactScale large(1000.0);
  const bricks::ExactScale small(1.0);
  EXPECT_EQ(large.CountBitsAbove(small), 9);
  EXPECT_EQ(small.Fix(0.75) >> 9, large.Fix(0.75));
  EXPECT_EQ(bricks::ExactScale(1e300).CountBitsAbove(small), 63);
}
