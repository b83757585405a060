// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMStatistics.h"

#include "DSMCore/store/BlockStore.h"
#include "DSMCore/transport/Message.h"
#include "DSMRayTracing/frame/Frame.h"
#include "DSMVolumeFiles/base/BytesFromServers.h"
#include "vtkDSMCounters.h"

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

#define DSM_MEMBER(type, name, value) type name;
#define DSM_VISIT(type, name, value) visit(Column<Row, type>(#name, &Row::name));
#define DSM_TAKE(type, name, value) row.name = static_cast<type>(value);

/// Plain, so that it travels between ranks.
struct vtkDSMStatistics::RankRow
{
  using Row = RankRow;
  std::int64_t Rank;
  char Host[64];
  double FrameSeconds;
  DSM_RANK_COUNTERS(DSM_MEMBER)

  /// Calls `visit` with every column behind Rank, Host and Organization.
  template <class Visit>
  static void ForEachColumn(const Visit& visit)
  {
    DSM_RANK_COUNTERS(DSM_VISIT)
  }
};

struct vtkDSMStatistics::WorkerRow
{
  using Row = WorkerRow;
  std::int64_t Rank;
  std::int64_t Worker;
  DSM_WORKER_COUNTERS(DSM_MEMBER)

  /// Calls `visit` with every column behind Rank.
  template <class Visit>
  static void ForEachColumn(const Visit& visit)
  {
    visit(Column<Row, std::int64_t>("Worker", &Row::Worker));
    DSM_WORKER_COUNTERS(DSM_VISIT)
  }
};

/// Data that a rank has received from one owner; behind the rows of its report.
struct vtkDSMStatistics::Delivery
{
  std::int64_t Owner;
  std::int64_t Bytes;
};

vtkStandardNewMacro(vtkDSMStatistics);

vtkDSMStatistics::vtkDSMStatistics() = default;
vtkDSMStatistics::~vtkDSMStatistics() = default;

std::vector<std::byte> vtkDSMStatistics::CreateReport(
  dsm::BlockStore& store, const rt::Frame& frame, int rank, int ranks)
{
  const dsm::StoreCounters& counters = frame.Counters;
  std::int64_t newTiles = 0;
  double seconds = 0.0;
  for (const rt::Tile& tile : frame.Tiles)
  {
    newTiles += tile.IsNew ? 1 : 0;
    seconds += tile.Seconds;
  }
  RankRow row{};
  row.Rank = rank;
  vtksys::SystemInformation system;
  const char* host = system.GetHostname();
  std::strncpy(row.Host, host ? host : "", sizeof(row.Host) - 1);
  row.FrameSeconds = frame.Seconds;
  DSM_RANK_COUNTERS(DSM_TAKE)
  std::vector<std::byte> bytes = dsm::Encode(row);
  for (std::size_t index = 0; index < frame.WorkerCounters.size(); ++index)
  {
    const dsm::WorkerCounters& worker = frame.WorkerCounters[index];
    WorkerRow row{};
    row.Rank = rank;
    row.Worker = static_cast<std::int64_t>(index);
    DSM_WORKER_COUNTERS(DSM_TAKE)
    dsm::AttachTail(bytes, row);
  }
  for (int owner = 0; owner < ranks; ++owner)
  {
    const auto received = static_cast<std::int64_t>(store.GetBytesFrom(owner));
    if (received > 0)
    {
      dsm::AttachTail(bytes, Delivery{ owner, received });
    }
  }
  return bytes;
}

void vtkDSMStatistics::Take(const rt::Frame& frame, int samples, int wanted, int coarser)
{
  this->Samples = samples;
  this->Wanted = wanted;
  this->CoarserLevel = coarser;
  this->Rows.clear();
  this->Workers.clear();
  this->FrameSeconds = 0.0;
  std::vector<std::int64_t> sent(frame.Reports.size());
  for (const std::vector<std::byte>& report : frame.Reports)
  {
    std::size_t at = 0;
    const auto read = [&](auto& value)
    {
      std::memcpy(&value, report.data() + at, sizeof(value));
      at += sizeof(value);
    };
    RankRow& row = this->Rows.emplace_back();
    read(row);
    for (std::int64_t worker = 0; worker < row.Threads; ++worker)
    {
      read(this->Workers.emplace_back());
    }
    while (at < report.size())
    {
      Delivery delivery;
      read(delivery);
      sent[static_cast<std::size_t>(delivery.Owner)] += delivery.Bytes;
    }
    this->FrameSeconds = std::max(this->FrameSeconds, row.FrameSeconds);
  }
  // A rank continues to send after its report.
  for (std::size_t rank = 0; rank < sent.size(); ++rank)
  {
    this->Rows[rank].BytesSent = sent[rank];
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
    RankRow::ForEachColumn([&](const auto& column) { sum.*column.second += row.*column.second; });
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
  // Sums over all ranks. Memory that a rank reads in place belongs to another rank, and counts once.
  text << this->Organization << ", MiB: " << toMebibytes(sum.BytesResident) << " owned"
       << (sum.BytesShared > 0 ? ", shared on hosts,\n" : ",\n") << toMebibytes(sum.BytesCopied)
       << " copied, " << toMebibytes(sum.BytesCached) << " cached\n";
  text << sum.Accesses << " brick accesses,\n"
       << toPercent(static_cast<double>(sum.Misses), static_cast<double>(sum.Accesses))
       << " % misses, " << toMebibytes(sum.BytesReceived) << " MiB fetched\n";
  text << "waiting " << toPercent(sum.WaitSeconds, sum.Seconds) << " %, busiest rank "
       << std::setprecision(2) << (sum.Seconds > 0.0 ? longest * threads / sum.Seconds : 1.0)
       << " x mean";
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
