# SPDX-License-Identifier: BSD-3-Clause
# The counters of a frame's statistics, of each rank. Made from this table: the columns of vtkDSMStatistics, those of
# the panel Ray Tracing Memory, and the second table of docs/properties.md. cmake/DSMSettings.cmake says what each word
# means.

dsm_counter(Threads UNIT Count VALUE "frame.WorkerCounters.size()"
  TEXT "Tracing threads.")
dsm_counter(BytesResident UNIT Bytes VALUE "counters.ResidentBytes" COLUMN "Bricks" WITH BytesCopied
  COLUMN_TEXT "Memory of bricks owned by the rank, and of copies of other ranks' bricks when replicated."
  TEXT "Memory of bricks owned by the rank.")
dsm_counter(BytesCopied UNIT Bytes VALUE "counters.ReplicaBytes"
  TEXT "Memory of copies of other ranks' bricks, when replicated.")
dsm_counter(BytesShared UNIT Bytes VALUE "counters.SharedBytes" COLUMN "Shared" NO_TOTAL
  TEXT "Bricks of other ranks on the host that are read in place. They take no memory of this rank.")
dsm_counter(BytesOfTables UNIT Bytes VALUE "counters.TableBytes"
  TEXT "Memory of the tables that find bricks.")
dsm_counter(MemoryBudget UNIT Bytes VALUE "counters.MemoryBudget" COLUMN "Limit"
  TEXT "Memory limit of the rank.")
dsm_counter(BytesCached UNIT Bytes VALUE "counters.CachedBytes" COLUMN "Cache"
  TEXT "Memory of bricks that were fetched from other ranks or a file.")
dsm_counter(PeakBytesCached UNIT Bytes VALUE "counters.PeakCachedBytes"
  TEXT "Largest value of BytesCached.")
dsm_counter(CacheCapacity UNIT Bytes VALUE "counters.CacheCapacity" COLUMN "Cache Limit"
  TEXT "Memory limit of fetched bricks.")
dsm_counter(Publications UNIT Count VALUE "counters.Publications"
  TEXT "Number of times that an array or surface was cut into bricks, since the ranks came together.")
dsm_counter(BytesPublished UNIT Bytes VALUE "counters.BytesPublished"
  TEXT "Bytes that the rank put into bricks since then.")
dsm_counter(Accesses UNIT Count VALUE "counters.Workers.Accesses" WORKER "worker.Accesses"
  TEXT "Number of times that a ray needed a brick.")
dsm_counter(Hits UNIT Count VALUE "counters.Workers.Hits" WORKER "worker.Hits" COLUMN "Hits"
  TEXT "Number of times that a needed brick was in memory.")
dsm_counter(Misses UNIT Count VALUE "counters.Workers.Misses" WORKER "worker.Misses" COLUMN "Misses"
  TEXT "Number of times that a needed brick had to be fetched.")
dsm_counter(Joins UNIT Count VALUE "counters.Workers.Joins" WORKER "worker.Joins"
  TEXT "Misses of bricks that were being fetched already.")
dsm_counter(Evictions UNIT Count VALUE "counters.Evictions"
  TEXT "Bricks that left the cache.")
dsm_counter(Prefetches UNIT Count VALUE "counters.Prefetches"
  TEXT "Bricks requested before a tile needed them.")
dsm_counter(PrefetchesUsed UNIT Count VALUE "counters.PrefetchesUsed"
  TEXT "Prefetched bricks that the frame needed.")
dsm_counter(Requests UNIT Count VALUE "counters.Requests"
  TEXT "Messages that requested bricks.")
dsm_counter(BytesReceived UNIT Bytes VALUE "counters.BytesReceived"
  TEXT "Bytes of bricks received from other ranks.")
dsm_counter(BytesSent UNIT Bytes VALUE "counters.BytesSent"
  TEXT "Bytes of bricks sent to other ranks.")
dsm_counter(BytesFromServers UNIT Bytes VALUE "vol::BytesFromServers.load()"
  TEXT "Bytes of volumes that servers sent to the rank, since it began.")
dsm_counter(WaitSeconds UNIT Seconds VALUE "ToSeconds(counters.Workers.WaitNanoseconds)"
  WORKER "ToSeconds(worker.WaitNanoseconds)"
  TEXT "Time that tiles waited for bricks.")
dsm_counter(IdleSeconds UNIT Seconds VALUE "ToSeconds(frame.IdleNanoseconds)"
  TEXT "Time that threads waited because no other tile was left to trace.")
dsm_counter(Tiles UNIT Count VALUE "frame.Tiles.size()" COLUMN "Tiles"
  TEXT "Tiles of the picture that the rank traced.")
dsm_counter(NewTiles UNIT Count VALUE "newTiles"
  TEXT "Tiles that another rank traced in the last frame.")
dsm_counter(Seconds UNIT Seconds VALUE "seconds" COLUMN "Seconds"
  TEXT "Processor time of tracing, summed over threads.")
