// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/cells/AverageCells.h"

#include "DSMBricks/cells/ExactScale.h"
#include "DSMBricks/cells/PointLocks.h"
#include "DSMBricks/cells/ShownCells.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

namespace bricks
{

namespace
{

struct CellValueSum
{
  std::int64_t Sum;
  std::int64_t Count;
};
static_assert(sizeof(CellValueSum) == 2 * sizeof(std::int64_t));

class CellAverager
{
public:
  CellAverager(const CellSource& source, const SharedPlaces& places,
    dsm::FunctionRef<double(std::uint64_t)> getValue, int threads)
    : Source(source)
    , Places(places)
    , GetValue(getValue)
    , Threads(threads)
    , Powers(source.GetPointCount())
  {
  }

  /// Finds how large the values around each of this rank's points may be.
  void FindScales()
  {
    this->ForEachCell(
      [this](double value, const std::uint64_t* points, int corners)
      {
        const std::uint16_t power = ExactScale(std::abs(value)).GetPower();
        for (int corner = 0; corner < corners; ++corner)
        {
          RaiseAtomic(this->Powers[points[corner]],
            [&](std::uint16_t known) { return std::max(known, power); });
        }
      });
  }

  void JoinScales(std::string_view what)
  {
    this->Places.Combine<std::uint16_t>(
      what, [this](std::uint64_t point) { return this->GetScale(point).GetPower(); },
      [this](std::uint64_t point, std::uint16_t power)
      { this->Powers[point].store(power, std::memory_order_relaxed); },
      [](std::uint16_t& power, std::uint16_t other) { power = std::max(power, other); });
  }

  /// Adds up the values of this rank's cells.
  void AddCells()
  {
    this->Sums.resize(this->Powers.size());
    PointLocks locks(this->Powers.size());
    this->ForEachCell(
      [&](double value, const std::uint64_t* points, int corners)
      {
        std::uint64_t added[CellSource::MostCorners];
        int count = 0;
        for (int corner = 0; corner < corners; ++corner)
        {
          const std::uint64_t point = this->Places.GetFirst(points[corner]);
          if (std::find(added, added + count, point) == added + count)
          {
            added[count++] = point;
            const std::int64_t number = this->GetScale(point).Fix(value);
            locks.Run(point,
              [&]
              {
                this->Sums[point].Sum += number;
                ++this->Sums[point].Count;
              });
          }
        }
      });
  }

  std::int64_t* GetSums() { return this->Sums.empty() ? nullptr : &this->Sums.data()->Sum; }

  std::vector<float> FindMeans() const
  {
    std::vector<float> means(this->Sums.size(), std::numeric_limits<float>::quiet_NaN());
    for (std::size_t point = 0; point < means.size(); ++point)
    {
      const CellValueSum& sum = this->Sums[point];
      if (sum.Count > 0)
      {
        const double mean = static_cast<double>(sum.Sum) / static_cast<double>(sum.Count);
        means[point] = static_cast<float>(mean * this->GetScale(point).GetUnit());
      }
    }
    return means;
  }

private:
  ExactScale GetScale(std::uint64_t point) const
  {
    return ExactScale::FromPower(this->Powers[point].load(std::memory_order_relaxed));
  }

  /// Calls visit(value, points, corners) for every shown cell that has a value.
  template <class Visit>
  void ForEachCell(const Visit& visit) const
  {
    ForEachShownCell(this->Source, this->Threads,
      [&](std::uint64_t cell, const std::uint64_t* points, int corners)
      {
        const double value = this->GetValue(cell);
        if (std::isfinite(value))
        {
          visit(value, points, corners);
        }
      });
  }

  const CellSource& Source;
  const SharedPlaces& Places;
  dsm::FunctionRef<double(std::uint64_t)> GetValue;
  int Threads;
  std::vector<std::atomic<std::uint16_t>> Powers; ///< of points: ExactScale
  std::vector<CellValueSum> Sums;                 ///< of points
};

} // namespace

std::vector<float> AverageCells(std::string_view what, const CellSource& source,
  const SharedPlaces& places, dsm::FunctionRef<double(std::uint64_t cell)> getCellValue,
  int threads, dsm::Messenger& messenger)
{
  std::optional<CellAverager> averager;
  messenger.RunTogether(what,
    [&]
    {
      averager.emplace(source, places, getCellValue, threads);
      averager->FindScales();
    });
  averager->JoinScales(what);
  messenger.RunTogether(what, [&] { averager->AddCells(); });
  places.Sum(what, averager->GetSums(), 2);
  std::vector<float> means;
  messenger.RunTogether(what, [&] { means = averager->FindMeans(); });
  return means;
}

} // namespace bricks
