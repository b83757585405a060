// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_ValueBytes_h
#define vol_ValueBytes_h

#include "DSMVolumeFiles/base/PositionedFile.h"

#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace vol
{

/// Where a file has values.
struct ValuePart
{
  std::string Path;
  std::uint64_t Offset;
  std::uint64_t Stamp; ///< of the file, when its size was looked at
};

/// The bytes of an array's values in a row: those of a file, or of several ones behind one another, which have equally
/// many. Only some of many files are open at a time. Any thread.
class ValueBytes final : public ByteSource
{
public:
  /// `path`: for messages; `partBytes`: bytes of each part, which the files were found to have. Throws dsm::Error
  /// when the first file cannot be opened, or is another one now.
  ValueBytes(std::string path, std::vector<ValuePart> parts, std::uint64_t partBytes);

  const std::string& GetPath() const override { return this->Path; }
  std::uint64_t GetBytes() const override { return this->Parts.size() * this->PartBytes; }

  /// As PositionedFile::Read; offsets count from the first value, and pieces may lie in several files.
  void Read(const std::vector<Piece>& pieces, std::byte* out) const override;
  /// As PositionedFile::Prefetch, for the files that are open.
  void Prefetch(std::vector<Piece> pieces) const override;

private:
  /// Calls `visit` with a part's number, the pieces in its file that follow one another, and their bytes.
  template <class Visit>
  void ForEachPart(const std::vector<Piece>& pieces, const Visit& visit) const;
  std::shared_ptr<const PositionedFile> Find(std::size_t part) const; ///< null: it is not open
  std::shared_ptr<const PositionedFile> Get(std::size_t part) const;

  std::string Path;
  std::vector<ValuePart> Parts;
  std::uint64_t PartBytes;
  mutable std::mutex Guard;
  /// The last used first.
  mutable std::list<std::pair<std::size_t, std::shared_ptr<const PositionedFile>>> Open;
};

} // namespace vol

#endif
