// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMStatistics.h"

#include "DSMCore/transport/Messenger.h"
#include "DSMRayTracing/frame/Frame.h"

#include "vtkDoubleArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkStringArray.h"
#include "vtkTable.h"
#include "vtkTypeInt64Array.h"

#include <vtksys/SystemInformation.hxx>

#include <algorithm>
#include <cstring>
#include <iomanip>
#include <numeric>
#include <sstream>
#include <type_traits>
#include <utility>

namespace
{

/// A column's name, and where a row has its value.
template <class Row, class Value>
using Column = std::pair<const char*, Value Row::*>;

template <class Row, class Value>
void AddColumn(vtkTable* table, const std::vector<Row>& rows, const Column<Row, Value>& column)
{
  using Array =
    std::conditional_t<std::is_same_v<Value, double>, vtkDoubleArray, vtkTypeInt64Array>;
  vtkNew<Array> array;
  array->SetName(column.first);
  for (const Row& row : rows)
  {
    array->InsertNextValue(row.*column.second);
  }
  table->AddColumn(array);
}

template <class Row, class Value>
void AddMember(std::ostream& json, const Row& row, const Column<Row, Value>& column)
{
  json << ", \"" << column.first << "\": " << row.*column.second;
}

double ToSeconds(std::uint64_t nanoseconds)
{
  return 1e-9 * static_cast<double>(nanoseconds);
}

} // namespace

/// Plain, so that it travels between ranks.
struct vtkDSMStatistics::RankRow
{
  std::int64_t Rank;
  char Host[64];
  std::int64_t Threads;
  std::int64_t BytesResident;
  std::int64_t BytesShared;
  std::int64_t BytesCopied;
  std::int64_t BytesOfTables;
  std::int64_t BytesCached;
  std::int64_t PeakBytesCached;
  std::int64_t CacheCapacity;
  std::int64_t MemoryBudget;
  std::int64_t Publications;
  std::int64_t BytesPublished;
  std::int64_t Accesses;
  std::int64_t Hits;
  std::int64_t Misses;
  std::int64_t Joins;
  std::int64_t Evictions;
  std::int64_t Prefetches;
  std::int64_t PrefetchesUsed;
  std::int64_t Requests;
  std::int64_t BytesReceived;
  std::int64_t BytesSent;
  double WaitSeconds;
  double IdleSeconds;
  std::int64_t Tiles;
  std::int64_t NewTiles;
  double Seconds;
  double FrameSeconds;

  /// Calls `visit` with every column behind Rank, Host and Organization.
  template <class Visit>
  static void ForEachColumn(const Visit& visit)
  {
    using Count = Column<RankRow, std::int64_t>;
    using Time = Column<RankRow, double>;
    visit(Count("Threads", &RankRow::Threads));
    visit(Count("BytesResident", &RankRow::BytesResident));
    visit(Count("BytesShared", &RankRow::BytesShared));
    visit(Count("BytesCopied", &RankRow::BytesCopied));
    visit(Count("BytesOfTables", &RankRow::BytesOfTables));
    visit(Count("BytesCached", &RankRow::BytesCached));
    visit(Count("PeakBytesCached", &RankRow::PeakBytesCached));
    visit(Count("CacheCapacity", &RankRow::CacheCapacity));
    visit(Count("MemoryBudget", &RankRow::MemoryBudget));
    visit(Count("Publications", &RankRow::Publications));
    visit(Count("BytesPublished", &RankRow::BytesPublished));
    visit(Count("Accesses", &RankRow::Accesses));
    visit(Count("Hits", &RankRow::Hits));
    visit(Count("Misses", &RankRow::Misses));
    visit(Count("Joins", &RankRow::Joins));
    visit(Count("Evictions", &RankRow::Evictions));
    visit(Count("Prefetches", &RankRow::Prefetches));
    visit(Count("PrefetchesUsed", &RankRow::PrefetchesUsed));
    visit(Count("Requests", &RankRow::Requests));
    visit(Count("BytesReceived", &RankRow::BytesReceived));
    visit(Count("BytesSent", &RankRow::BytesSent));
    visit(Time("WaitSeconds", &RankRow::WaitSeconds));
    visit(Time("IdleSeconds", &RankRow::IdleSeconds));
    visit(Count("Tiles", &RankRow::Tiles));
    visit(Count("NewTiles", &RankRow::NewTiles));
    visit(Time("Seconds", &RankRow::Seconds));
  }
};

struct vtkDSMStatistics::WorkerRow
{
  std::int64_t Rank;
  std::int64_t Worker;
  std::int64_t Accesses;
  std::int64_t Hits;
  std::int64_t Misses;
  std::int64_t Joins;
  double WaitSeconds;

  /// Calls `visit` with every column behind Rank.
  template <class Visit>
  static void ForEachColumn(const Visit& visit)
  {
    using Count = Column<WorkerRow, std::int64_t>;
    visit(Count("Worker", &WorkerRow::Worker));
    visit(Count("Accesses", &WorkerRow::Accesses));
    visit(Count("Hits", &WorkerRow::Hits));
    visit(Count("Misses", &WorkerRow::Misses));
    visit(Count("Joins", &WorkerRow::Joins));
    visit(Column<WorkerRow, double>("WaitSeconds", &WorkerRow::WaitSeconds));
  }
};

vtkStandardNewMacro(vtkDSMStatistics);

vtkDSMStatistics::vtkDSMStatistics() = default;
vtkDSMStatistics::~vtkDSMStatistics() = default;

void vtkDSMStatistics::Gather(
  dsm::Messenger& messenger, const rt::Frame& frame, int samples, int wanted, int coarser)
{
  this->Samples = samples;
  this->Wanted = wanted;
  this->CoarserLevel = coarser;
  RankRow mine{};
  mine.Rank = messenger.GetRank();
  vtksys::SystemInformation system;
  const char* host = system.GetHostname();
  std::strncpy(mine.Host, host ? host : "", sizeof(mine.Host) - 1);
  const dsm::StoreCounters& counters = frame.Counters;
  mine.Threads = static_cast<std::int64_t>(frame.WorkerCounters.size());
  mine.BytesResident = static_cast<std::int64_t>(counters.ResidentBytes);
  mine.BytesShared = static_cast<std::int64_t>(counters.SharedBytes);
  mine.BytesCopied = static_cast<std::int64_t>(counters.ReplicaBytes);
  mine.BytesOfTables = static_cast<std::int64_t>(counters.TableBytes);
  mine.BytesCached = static_cast<std::int64_t>(counters.CachedBytes);
  mine.PeakBytesCached = static_cast<std::int64_t>(counters.PeakCachedBytes);
  mine.CacheCapacity = static_cast<std::int64_t>(counters.CacheCapacity);
  mine.MemoryBudget = static_cast<std::int64_t>(counters.MemoryBudget);
  mine.Publications = static_cast<std::int64_t>(counters.Publications);
  mine.BytesPublished = static_cast<std::int64_t>(counters.BytesPublished);
  mine.Accesses = static_cast<std::int64_t>(counters.Workers.Accesses);
  mine.Hits = static_cast<std::int64_t>(counters.Workers.Hits);
  mine.Misses = static_cast<std::int64_t>(counters.Workers.Misses);
  mine.Joins = static_cast<std::int64_t>(counters.Workers.Joins);
  mine.Evictions = static_cast<std::int64_t>(counters.Evictions);
  mine.Prefetches = static_cast<std::int64_t>(counters.Prefetches);
  mine.PrefetchesUsed = static_cast<std::int64_t>(counters.PrefetchesUsed);
  mine.Requests = static_cast<std::int64_t>(counters.Requests);
  mine.BytesReceived = static_cast<std::int64_t>(counters.BytesReceived);
  mine.BytesSent = static_cast<std::int64_t>(counters.BytesSent);
  mine.WaitSeconds = ToSeconds(counters.Workers.WaitNanoseconds);
  mine.IdleSeconds = ToSeconds(frame.IdleNanoseconds);
  mine.Tiles = static_cast<std::int64_t>(frame.Tiles.size());
  for (const rt::Tile& tile : frame.Tiles)
  {
    mine.NewTiles += tile.IsNew ? 1 : 0;
    mine.Seconds += tile.Seconds;
  }
  mine.FrameSeconds = frame.Seconds;

  std::vector<std::byte> bytes = dsm::Encode(mine);
  for (std::size_t index = 0; index < frame.WorkerCounters.size(); ++index)
  {
    const dsm::WorkerCounters& worker = frame.WorkerCounters[index];
    dsm::AttachTail(bytes,
      WorkerRow{ mine.Rank, static_cast<std::int64_t>(index),
        static_cast<std::int64_t>(worker.Accesses), static_cast<std::int64_t>(worker.Hits),
        static_cast<std::int64_t>(worker.Misses), static_cast<std::int64_t>(worker.Joins),
        ToSeconds(worker.WaitNanoseconds) });
  }
  this->Rows.clear();
  this->Workers.clear();
  for (const auto& part : messenger.AllGather(std::move(bytes)))
  {
    std::memcpy(&this->Rows.emplace_back(), part.data(), sizeof(RankRow));
    for (std::size_t at = sizeof(RankRow); at < part.size(); at += sizeof(WorkerRow))
    {
      std::memcpy(&this->Workers.emplace_back(), part.data() + at, sizeof(WorkerRow));
    }
  }
  this->FrameSeconds = 0.0;
  for (const RankRow& row : this->Rows)
  {
    this->FrameSeconds = std::max(this->FrameSeconds, row.FrameSeconds);
  }
  this->Organization = dsm::GetText(frame.Organization);
  this->Explanation = frame.Explanation;
  this->Modified();
}

void vtkDSMStatistics::Clear()
{
  this->CoarserLevel = 0;
  this->Rows.clear();
  this->Workers.clear();
  this->FrameSeconds = 0.0;
  this->Organization.clear();
  this->Explanation.clear();
  this->Modified();
}

void vtkDSMStatistics::GetTable(vtkTable* table) const
{
  table->Initialize();
  AddColumn(table, this->Rows, Column<RankRow, std::int64_t>("Rank", &RankRow::Rank));
  vtkNew<vtkStringArray> hosts;
  vtkNew<vtkStringArray> organizations;
  hosts->SetName("Host");
  organizations->SetName("Organization");
  for (const RankRow& row : this->Rows)
  {
    hosts->InsertNextValue(row.Host);
    organizations->InsertNextValue(this->Organization);
  }
  table->AddColumn(hosts);
  table->AddColumn(organizations);
  RankRow::ForEachColumn([&](const auto& column) { AddColumn(table, this->Rows, column); });
}

void vtkDSMStatistics::GetWorkerTable(vtkTable* table) const
{
  table->Initialize();
  AddColumn(table, this->Workers, Column<WorkerRow, std::int64_t>("Rank", &WorkerRow::Rank));
  WorkerRow::ForEachColumn([&](const auto& column) { AddColumn(table, this->Workers, column); });
}

int vtkDSMStatistics::GetNumberOfRanks() const
{
  return static_cast<int>(this->Rows.size());
}

std::string vtkDSMStatistics::GetHost(int rank) const
{
  return rank >= 0 && rank < this->GetNumberOfRanks() ? this->Rows[rank].Host : "";
}

vtkTypeInt64 vtkDSMStatistics::GetNumberOfMisses() const
{
  return std::accumulate(this->Rows.begin(), this->Rows.end(), vtkTypeInt64(0),
    [](vtkTypeInt64 sum, const RankRow& row) { return sum + row.Misses; });
}

std::string vtkDSMStatistics::GetSummary() const
{
  if (this->Rows.empty())
  {
    return {};
  }
  RankRow sum{};
  double longest = 0.0;
  for (const RankRow& row : this->Rows)
  {
    sum.Threads += row.Threads;
    sum.BytesResident += row.BytesResident;
    sum.BytesShared += row.BytesShared;
    sum.BytesCopied += row.BytesCopied;
    sum.BytesCached += row.BytesCached;
    sum.Accesses += row.Accesses;
    sum.Misses += row.Misses;
    sum.BytesReceived += row.BytesReceived;
    sum.WaitSeconds += row.WaitSeconds;
    sum.Seconds += row.Seconds;
    longest =
      std::max(longest, row.Seconds / static_cast<double>(std::max<std::int64_t>(row.Threads, 1)));
  }
  const double threads = static_cast<double>(std::max<std::int64_t>(sum.Threads, 1));
  const auto toMebibytes = [](std::int64_t bytes)
  { return static_cast<double>(bytes) / 1048576.0; };
  const auto toPercent = [](double part, double whole)
  { return whole > 0.0 ? 100.0 * part / whole : 0.0; };
  std::ostringstream text;
  text << std::fixed << std::setprecision(1);
  const auto count = [](std::int64_t number, const char* what)
  { return std::to_string(number) + " " + what + (number == 1 ? "" : "s"); };
  text << 1e3 * this->FrameSeconds << " ms, ";
  if (this->Wanted > 1)
  {
    text << this->Samples << " of " << this->Wanted << " samples, ";
  }
  if (this->CoarserLevel > 0)
  {
    text << count(this->CoarserLevel, "level") << " coarser, ";
  }
  text << count(static_cast<std::int64_t>(this->Rows.size()), "rank") << ", "
       << count(sum.Threads, "thread") << "\n";
  // Held by all ranks together. What a rank reads in place is another's, and held once.
  text << this->Organization << ", MiB: " << toMebibytes(sum.BytesResident) << " owned"
       << (sum.BytesShared > 0 ? ", shared on hosts,\n" : ",\n") << toMebibytes(sum.BytesCopied)
       << " copied, " << toMebibytes(sum.BytesCached) << " cached\n";
  text << sum.Accesses << " look-ups of bricks,\n"
       << toPercent(static_cast<double>(sum.Misses), static_cast<double>(sum.Accesses))
       << " % missed, " << toMebibytes(sum.BytesReceived) << " MiB fetched\n";
  text << "waited " << toPercent(sum.WaitSeconds, sum.Seconds) << " %, busiest rank "
       << std::setprecision(2) << (sum.Seconds > 0.0 ? longest * threads / sum.Seconds : 1.0)
       << " of mean";
  return text.str();
}

std::string vtkDSMStatistics::GetJson() const
{
  std::ostringstream json;
  json << "[";
  for (const RankRow& row : this->Rows)
  {
    json << (row.Rank > 0 ? ", " : "") << "{\"Rank\": " << row.Rank << ", \"Host\": \"" << row.Host
         << "\", \"Organization\": \"" << this->Organization << "\", \"Explanation\": \""
         << this->Explanation << "\", \"CoarserLevel\": " << this->CoarserLevel;
    RankRow::ForEachColumn([&](const auto& column) { AddMember(json, row, column); });
    json << ", \"Workers\": [";
    bool first = true;
    for (const WorkerRow& worker : this->Workers)
    {
      if (worker.Rank == row.Rank)
      {
        json << (first ? "" : ", ") << "{\"Rank\": " << worker.Rank;
        WorkerRow::ForEachColumn([&](const auto& column) { AddMember(json, worker, column); });
        json << "}";
        first = false;
      }
    }
    json << "]}";
  }
  json << "]";
  return json.str();
}

void vtkDSMStatistics::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FrameSeconds: " << this->FrameSeconds << "\n";
  os << indent << "Explanation: " << this->Explanation << "\n";
  os << indent << "Ranks: " << this->GetJson() << "\n";
}
