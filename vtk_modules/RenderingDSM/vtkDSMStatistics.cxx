// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMStatistics.h"

#include "DSMCore/Messenger.h"
#include "DSMRayTracing/frame/Frame.h"

#include "vtkDoubleArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkStringArray.h"
#include "vtkTable.h"
#include "vtkTypeInt64Array.h"

#include <vtksys/SystemInformation.hxx>

#include <algorithm>
#include <array>
#include <cstring>
#include <sstream>
#include <utility>

/// Plain, so that it travels between ranks.
struct vtkDSMStatistics::RankRow
{
  char Host[64];
  std::int64_t Threads;
  std::int64_t BytesResident;
  std::int64_t BytesCached;
  std::int64_t CacheCapacity;
  std::int64_t Accesses;
  std::int64_t Hits;
  std::int64_t Misses;
  std::int64_t BytesReceived;
  std::int64_t Tiles;
  double Seconds;
  double FrameSeconds;

  using Column = std::pair<const char*, std::int64_t RankRow::*>;
  static const std::array<Column, 9>& GetColumns()
  {
    static const std::array<Column, 9> columns = { Column("Threads", &RankRow::Threads),
      Column("BytesResident", &RankRow::BytesResident),
      Column("BytesCached", &RankRow::BytesCached),
      Column("CacheCapacity", &RankRow::CacheCapacity), Column("Accesses", &RankRow::Accesses),
      Column("Hits", &RankRow::Hits), Column("Misses", &RankRow::Misses),
      Column("BytesReceived", &RankRow::BytesReceived), Column("Tiles", &RankRow::Tiles) };
    return columns;
  }
};

vtkStandardNewMacro(vtkDSMStatistics);

vtkDSMStatistics::vtkDSMStatistics() = default;
vtkDSMStatistics::~vtkDSMStatistics() = default;

void vtkDSMStatistics::Gather(dsm::Messenger& messenger, const rt::Frame& frame)
{
  RankRow mine{};
  vtksys::SystemInformation system;
  const char* host = system.GetHostname();
  std::strncpy(mine.Host, host ? host : "", sizeof(mine.Host) - 1);
  const dsm::StoreCounters& counters = frame.Counters;
  mine.Threads = static_cast<std::int64_t>(frame.WorkerCounters.size());
  mine.BytesResident = static_cast<std::int64_t>(counters.ResidentBytes);
  mine.BytesCached = static_cast<std::int64_t>(counters.CachedBytes);
  mine.CacheCapacity = static_cast<std::int64_t>(counters.CacheCapacity);
  mine.Accesses = static_cast<std::int64_t>(counters.Workers.Accesses);
  mine.Hits = static_cast<std::int64_t>(counters.Workers.Hits);
  mine.Misses = static_cast<std::int64_t>(counters.Workers.Misses);
  mine.BytesReceived = static_cast<std::int64_t>(counters.BytesReceived);
  mine.Tiles = static_cast<std::int64_t>(frame.Tiles.size());
  for (const rt::Tile& tile : frame.Tiles)
  {
    mine.Seconds += tile.Seconds;
  }
  mine.FrameSeconds = frame.Seconds;

  this->Rows = messenger.AllGatherValue(mine);
  this->FrameSeconds = 0.0;
  for (const RankRow& row : this->Rows)
  {
    this->FrameSeconds = std::max(this->FrameSeconds, row.FrameSeconds);
  }
  this->Modified();
}

void vtkDSMStatistics::Clear()
{
  this->Rows.clear();
  this->FrameSeconds = 0.0;
  this->Modified();
}

void vtkDSMStatistics::GetTable(vtkTable* table) const
{
  table->Initialize();
  vtkNew<vtkTypeInt64Array> ranks;
  vtkNew<vtkStringArray> hosts;
  vtkNew<vtkDoubleArray> seconds;
  ranks->SetName("Rank");
  hosts->SetName("Host");
  seconds->SetName("Seconds");
  for (std::size_t rank = 0; rank < this->Rows.size(); ++rank)
  {
    ranks->InsertNextValue(static_cast<vtkTypeInt64>(rank));
    hosts->InsertNextValue(this->Rows[rank].Host);
    seconds->InsertNextValue(this->Rows[rank].Seconds);
  }
  table->AddColumn(ranks);
  table->AddColumn(hosts);
  for (const auto& [name, member] : RankRow::GetColumns())
  {
    vtkNew<vtkTypeInt64Array> column;
    column->SetName(name);
    for (const RankRow& row : this->Rows)
    {
      column->InsertNextValue(row.*member);
    }
    table->AddColumn(column);
  }
  table->AddColumn(seconds);
}

std::string vtkDSMStatistics::GetJson() const
{
  std::ostringstream json;
  json << "[";
  for (std::size_t rank = 0; rank < this->Rows.size(); ++rank)
  {
    const RankRow& row = this->Rows[rank];
    json << (rank ? ", " : "") << "{\"Rank\": " << rank << ", \"Host\": \"" << row.Host << "\"";
    for (const auto& [name, member] : RankRow::GetColumns())
    {
      json << ", \"" << name << "\": " << row.*member;
    }
    json << ", \"Seconds\": " << row.Seconds << "}";
  }
  json << "]";
  return json.str();
}

void vtkDSMStatistics::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FrameSeconds: " << this->FrameSeconds << "\n";
  os << indent << "Ranks: " << this->GetJson() << "\n";
}
