// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/cells/AverageCells.h"

#include "DSMBricks/cells/ExactScale.h"
#include "DSMBricks/cells/PointNotes.h"
#include "DSMBricks/cells/ShownCells.h"
#include "DSMCore/memory/BlockArena.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

namespace bricks
{

namespace
{

/// Part of the time until the scales are known.
constexpr double EndOfScales = 0.4;

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
    , Notes(source.GetPointCount())
  {
  }

  /// Finds how large the values around each of this rank's points may be.
  void FindScales(dsm::FunctionRef<void(double)> progress)
  {
    SharedProgress advance(progress, 0.0, EndOfScales, this->Source.GetCellCount());
    this->ForEachCell(advance,
      [this](double value, const std::uint64_t* points, int corners, std::size_t chunk)
      {
        const std::uint32_t power = ExactScale(std::abs(value)).GetPower();
        for (int corner = 0; corner < corners; ++corner)
        {
          this->Notes.Add(this->Places.GetFirst(points[corner]), chunk,
            [&](std::uint32_t known) { return std::max(known, power); });
        }
      });
  }

  void JoinScales(std::string_view what)
  {
    this->Places.Combine<std::uint32_t>(
      what, [this](std::uint64_t point) { return this->Notes.Get(point); },
      [this](std::uint64_t point, std::uint32_t power) { this->Notes.Set(point, power); },
      [](std::uint32_t& power, std::uint32_t other) { power = std::max(power, other); });
  }

  /// Adds up the values of this rank's cells.
  void AddCells(dsm::FunctionRef<void(double)> progress)
  {
    SharedProgress advance(progress, EndOfScales, 1.0, this->Source.GetCellCount());
    this->Memory = dsm::BlockArena(this->Notes.GetCount() * sizeof(CellValueSum));
    this->Sums = reinterpret_cast<CellValueSum*>(this->Memory.GetData());
    this->ForEachCell(advance,
      [this](double value, const std::uint64_t* points, int corners, std::size_t chunk)
      {
        std::uint64_t added[CellSource::MostCorners];
        int count = 0;
        for (int corner = 0; corner < corners; ++corner)
        {
          const std::uint64_t point = this->Places.GetFirst(points[corner]);
          if (std::find(added, added + count, point) == added + count)
          {
            added[count++] = point;
            this->Notes.Run(point, chunk,
              [&](std::uint32_t power)
              {
                this->Sums[point].Sum += ToScale(power).Fix(value);
                ++this->Sums[point].Count;
              });
          }
        }
      });
  }

  std::int64_t* GetSums() { return &this->Sums->Sum; }

  std::vector<float> FindMeans() const
  {
    std::vector<float> means(this->Notes.GetCount(), std::numeric_limits<float>::quiet_NaN());
    for (std::size_t point = 0; point < means.size(); ++point)
    {
      const CellValueSum& sum = this->Sums[point];
      if (sum.Count > 0)
      {
        const double mean = static_cast<double>(sum.Sum) / static_cast<double>(sum.Count);
        means[point] = static_cast<float>(mean * ToScale(this->Notes.Get(point)).GetUnit());
      }
    }
    return means;
  }

private:
  static ExactScale ToScale(std::uint32_t power)
  {
    return ExactScale::FromPower(static_cast<std::uint16_t>(power));
  }

  /// Calls visit(value, points, corners, chunk) for every shown cell that has a value.
  template <class Visit>
  void ForEachCell(SharedProgress& progress, const Visit& visit) const
  {
    ForEachShownCell(this->Source, this->Threads, progress,
      [&](std::uint64_t cell, const std::uint64_t* points, int corners, std::size_t chunk, int)
      {
        const double value = this->GetValue(cell);
        if (std::isfinite(value))
        {
          visit(value, points, corners, chunk);
        }
      });
  }

  const CellSource& Source;
  const SharedPlaces& Places;
  dsm::FunctionRef<double(std::uint64_t)> GetValue;
  int Threads;
  PointNotes Notes; ///< powers of ExactScale
  dsm::BlockArena Memory;
  CellValueSum* Sums = nullptr; ///< of points, in Memory
};

} // namespace

std::vector<float> AverageCells(std::string_view what, const CellSource& source,
  const SharedPlaces& places, dsm::FunctionRef<double(std::uint64_t cell)> getCellValue,
  int threads, dsm::Messenger& messenger, dsm::FunctionRef<void(double)> progress)
{
  std::optional<CellAverager> averager;
  messenger.RunTogether(what,
    [&]
    {
      averager.emplace(source, places, getCellValue, threads);
      averager->FindScales(progress);
    });
  averager->JoinScales(what);
  messenger.RunTogether(what, [&] { averager->AddCells(progress); });
  places.Sum(what, averager->GetSums(), 2);
  std::vector<float> means;
  messenger.RunTogether(what, [&] { means = averager->FindMeans(); });
  return means;
}

} // namespace bricks
