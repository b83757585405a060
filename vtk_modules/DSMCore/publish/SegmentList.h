// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_SegmentList_h
#define dsm_SegmentList_h

#include "DSMCore/publish/BlockSegment.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace dsm
{

/// The segments that a store has, in ascending order of number. Room is made where ranks can still
/// agree that one of them lacks memory; then adding and removing cannot fail.
template <class Segment>
class SegmentList
{
public:
  using Pointer = std::shared_ptr<Segment>;

  /// For `count` more. Throws std::bad_alloc.
  void MakeRoom(std::size_t count) { this->Segments.reserve(this->Segments.size() + count); }

  void Add(Pointer segment)
  {
    const auto place = this->Seek(segment->GetNumber());
    this->Segments.insert(place, std::move(segment));
  }

  /// Null when it is not here.
  Pointer Remove(const BlockSegment& segment)
  {
    const auto place = this->Seek(segment.GetNumber());
    if (place == this->Segments.end() || place->get() != &segment)
    {
      return nullptr;
    }
    Pointer removed = std::move(*place);
    this->Segments.erase(place);
    return removed;
  }

  bool Has(const BlockSegment& segment) const
  {
    return this->Find(segment.GetNumber()) == &segment;
  }
  /// Null when there is none of the number.
  Segment* Find(std::uint32_t number) const
  {
    const auto place = this->Seek(number);
    return place == this->Segments.end() || (*place)->GetNumber() != number ? nullptr
                                                                            : place->get();
  }

  bool IsEmpty() const { return this->Segments.empty(); }
  std::size_t GetCount() const { return this->Segments.size(); }
  auto begin() const { return this->Segments.begin(); }
  auto end() const { return this->Segments.end(); }

private:
  auto Seek(std::uint32_t number) const
  {
    return std::lower_bound(this->Segments.begin(), this->Segments.end(), number,
      [](const Pointer& segment, std::uint32_t wanted) { return segment->GetNumber() < wanted; });
  }
  auto Seek(std::uint32_t number)
  {
    const auto place = std::as_const(*this).Seek(number);
    return this->Segments.begin() + (place - this->Segments.cbegin());
  }

  std::vector<Pointer> Segments;
};

} // namespace dsm

#endif
