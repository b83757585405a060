// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/cells/RankExchange.h"

#include "DSMCore/base/Error.h"
#include "DSMCore/publish/FragmentStream.h"

#include <algorithm>
#include <cstring>

namespace bricks
{

namespace
{

/// Begins a fragment; records follow.
struct RankRecordsHeader
{
  std::uint64_t From;
  std::uint64_t First;
};

/// Block n is what rank n gets.
class RankRecordSource final : public dsm::FragmentSource
{
public:
  RankRecordSource(const RankExchange& exchange, int rank)
    : Exchange(exchange)
    , Rank(static_cast<std::size_t>(rank))
  {
  }

  bool Next(dsm::Fragment& fragment) override
  {
    constexpr std::size_t fragmentBytes = std::size_t(1) << 18;
    const std::size_t ranks = this->Exchange.Counts.size();
    // Each rank begins with the one behind it, so that not all send to the same.
    while (this->Turn < ranks && this->Position == this->Exchange.Counts[this->GetReceiver()])
    {
      ++this->Turn;
      this->Position = 0;
    }
    if (this->Turn == ranks)
    {
      return false;
    }
    const std::size_t to = this->GetReceiver();
    const std::size_t size = this->Exchange.RecordBytes;
    const std::size_t count = std::min<std::size_t>(
      this->Exchange.Counts[to] - this->Position, std::max<std::size_t>(fragmentBytes / size, 1));
    const RankRecordsHeader header{ this->Rank, this->Position };
    fragment.Block = to;
    fragment.Bytes.resize(sizeof(header) + count * size);
    std::memcpy(fragment.Bytes.data(), &header, sizeof(header));
    this->Exchange.WriteRecords(
      static_cast<int>(to), this->Position, count, fragment.Bytes.data() + sizeof(header));
    this->Position += count;
    return true;
  }

  double GetProgress() const override
  {
    return static_cast<double>(this->Turn) / static_cast<double>(this->Exchange.Counts.size());
  }

private:
  std::size_t GetReceiver() const
  {
    return (this->Rank + 1 + this->Turn) % this->Exchange.Counts.size();
  }

  const RankExchange& Exchange;
  std::size_t Rank;
  std::size_t Turn = 0;
  std::uint64_t Position = 0;
};

} // namespace

void RankExchange::Run(std::string_view what, dsm::Messenger& messenger) const
{
  RankRecordSource source(*this, messenger.GetRank());
  const auto absorb = [&](dsm::BlockId, const std::byte* bytes, std::size_t count)
  {
    RankRecordsHeader header{};
    std::memcpy(&header, bytes, std::min(sizeof(header), count));
    if (count < sizeof(header) || (count - sizeof(header)) % this->RecordBytes != 0 ||
      header.From >= this->Counts.size())
    {
      throw dsm::Error(
        "Values of points arrived in an unknown form. Do all ranks run the same build?");
    }
    this->ReadRecords(static_cast<int>(header.From), header.First,
      (count - sizeof(header)) / this->RecordBytes, bytes + sizeof(header));
  };
  dsm::FragmentStream::RunToRanks(what, messenger, source, absorb);
}

} // namespace bricks
