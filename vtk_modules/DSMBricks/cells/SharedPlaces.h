// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_SharedPlaces_h
#define bricks_SharedPlaces_h

#include "DSMBricks/cells/EqualPlaces.h"
#include "DSMCore/base/FunctionRef.h"
#include "DSMCore/transport/Messenger.h"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace bricks
{

/// Knows which points of all ranks have the same place: bit-equal floats in the space of the bricks. Values of such
/// points are combined without ghost cells and without global ids. A place that several ranks have is looked after by
/// one of them, chosen by a hash. Communication thread.
class SharedPlaces
{
public:
  /// Collective. `points`: number of this rank's points; they may be none. A point for which `getPlace` returns false
  /// shares its place with no other. Only points in the bounds of other ranks' points are sent. `threads`: of this
  /// rank, while this runs. The messenger is kept. Throws the same dsm::Error on every rank.
  SharedPlaces(std::string_view what, std::uint64_t points, GetPlaceFunction getPlace, int threads,
    dsm::Messenger& messenger);

  /// Collective: replaces the record of each point by the sum of those of all points of all ranks at its place.
  /// `records` has `width` integers for each of this rank's points, one after the other. Only records of places that
  /// several ranks have are sent. Throws the same dsm::Error on every rank.
  void Sum(std::string_view what, std::int64_t* records, std::size_t width) const;

  /// Collective, likewise, for plain records of any kind. `combine(value, other)` changes the first, is associative
  /// and commutative, and does not throw. `get(point)` returns a record, `set(point, record)` replaces it.
  template <class Record, class Get, class Set, class Combination>
  void Combine(
    std::string_view what, const Get& get, const Set& set, const Combination& combine) const
  {
    static_assert(std::is_trivially_copyable_v<Record>);
    const auto load = [](const std::byte* bytes)
    {
      Record record;
      std::memcpy(&record, bytes, sizeof(Record));
      return record;
    };
    const auto store = [](const Record& record, std::byte* bytes)
    { std::memcpy(bytes, &record, sizeof(Record)); };
    this->CombineRecords(what,
      { sizeof(Record), [&](std::uint64_t point, std::byte* bytes) { store(get(point), bytes); },
        [&](std::uint64_t point, const std::byte* bytes) { set(point, load(bytes)); },
        [&](std::byte* bytes, const std::byte* other)
        {
          Record record = load(bytes);
          combine(record, load(other));
          store(record, bytes);
        } });
  }

  /// Returns the first of this rank's points that have the place of this one. Any thread.
  std::uint64_t GetFirst(std::uint64_t point) const;

private:
  /// Records of points, as Combine handles them.
  struct Records
  {
    std::size_t Bytes;
    dsm::FunctionRef<void(std::uint64_t point, std::byte* record)> Get;
    dsm::FunctionRef<void(std::uint64_t point, const std::byte* record)> Set;
    dsm::FunctionRef<void(std::byte* record, const std::byte* other)> Combine;
  };
  /// Points for each rank that looks after their places.
  using PointsByRank = std::vector<std::vector<std::uint32_t>>;
  /// Places that ranks have sent to this one.
  struct Candidates;

  void FindOwn(std::uint64_t points, GetPlaceFunction getPlace, int threads);
  void FindOthers(
    std::string_view what, std::uint64_t points, GetPlaceFunction getPlace, int threads);
  Candidates SendCandidates(
    std::string_view what, const PointsByRank& points, GetPlaceFunction getPlace) const;
  /// Gives each place that several ranks have a slot, and notes which of a rank's candidates are there.
  PointsByRank FillSlots(const Candidates& candidates, int threads);
  void CombineRecords(std::string_view what, const Records& records) const;
  void CombineAcrossRanks(std::string_view what, const Records& records) const;

  dsm::Messenger& Messages;
  EqualPlaces Own; ///< of this rank's points alone
  /// One bit for each point: it is not the first of its place. Empty if no two points have the same place.
  std::vector<std::uint64_t> IsLater;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> FirstOfLater; ///< point, first; ascending

  bool AreSpread = false; ///< there are places that several ranks have
  PointsByRank Sent;      ///< of this rank's points, one of each such place
  /// For each rank the slots of the records that it sends to this one, in order. A slot is a place.
  std::vector<std::vector<std::uint32_t>> Slots;
  std::uint32_t SlotCount = 0;
};

} // namespace bricks

#endif
