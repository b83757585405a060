// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/build/CellExchange.h"

#include "DSMCore/base/Error.h"
#include "DSMCore/publish/FragmentStream.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>

namespace bricks
{

namespace
{

using Pieces = std::vector<CellExchange::Piece>;
using OwnPieces = std::map<std::size_t, std::shared_ptr<CellAverages>>;

/// Bytes of one message, about.
constexpr std::int64_t FragmentBytes = std::int64_t(1) << 18;

/// Cells that one piece gives to another.
struct Transfer
{
  std::size_t From;
  std::size_t To;
  Box Cells;
};

/// Begins a fragment; states and values follow, as for CellAverages::AddNeighbors.
struct Header
{
  std::uint32_t From;
  std::uint32_t To;
  std::int64_t Min[3];
  std::int64_t Max[3];
};

class TransferList
{
public:
  TransferList(const Pieces& pieces, const OwnPieces& own)
  {
    for (std::size_t to = 0; to < pieces.size(); ++to)
    {
      const Box& cells = pieces[to].Cells;
      const Box around{ cells.Min - Index3(1), cells.Max + Index3(1) };
      const auto isNear = [&](const auto& one)
      { return !Intersect(around, pieces[one.first].Reach).IsEmpty(); };
      if (!pieces[to].IsUsed || std::none_of(own.begin(), own.end(), isNear))
      {
        continue;
      }
      const std::vector<Box> layer = CellAverages::GetLayer(cells);
      std::optional<std::vector<Box>> whole; // cells that some rank owns
      for (const auto& [from, unused] : own)
      {
        for (const Box& box : layer)
        {
          const Box real = Intersect(box, pieces[from].Cells);
          const Box known = Intersect(box, pieces[from].Reach);
          if (known.GetCount() > real.GetCount() && !whole)
          {
            whole = FindWhole(pieces, around);
          }
          const bool hasCopies =
            known.GetCount() > real.GetCount() && !LatticePlan::IsCovered(known, *whole);
          const Box& sent = hasCopies ? known : real;
          if (!sent.IsEmpty())
          {
            this->Split({ from, to, sent });
          }
        }
      }
    }
  }
  const std::vector<Transfer>& Get() const { return this->Transfers; }

private:
  static std::vector<Box> FindWhole(const Pieces& pieces, const Box& around)
  {
    std::vector<Box> whole;
    for (const CellExchange::Piece& piece : pieces)
    {
      if (piece.IsUsed && !piece.HasMask && !Intersect(piece.Cells, around).IsEmpty())
      {
        whole.push_back(piece.Cells);
      }
    }
    return whole;
  }
  /// Into parts of bounded size.
  void Split(const Transfer& transfer)
  {
    const Index3 size = transfer.Cells.GetSize();
    const int axis = size.z > 1 ? 2 : size.y > 1 ? 1 : 0;
    const std::int64_t others = transfer.Cells.GetCount() / size[axis];
    const std::int64_t most = FragmentBytes / 8;
    if (transfer.Cells.GetCount() <= most || size[axis] == 1)
    {
      this->Transfers.push_back(transfer);
      return;
    }
    const std::int64_t step = std::max<std::int64_t>(most / others, 1);
    for (std::int64_t first = transfer.Cells.Min[axis]; first < transfer.Cells.Max[axis];
         first += step)
    {
      Transfer part = transfer;
      part.Cells.Min[axis] = first;
      part.Cells.Max[axis] = std::min(first + step, transfer.Cells.Max[axis]);
      step == 1 ? this->Split(part) : this->Transfers.push_back(part);
    }
  }

  std::vector<Transfer> Transfers;
};

/// Yields the cells of this rank's transfers. Block n is what rank n gets.
class LayerSource final : public dsm::FragmentSource
{
public:
  LayerSource(const std::vector<Transfer>& transfers, const Pieces& pieces, const OwnPieces& own)
    : Transfers(transfers)
    , All(pieces)
    , Own(own)
  {
  }
  bool Next(dsm::Fragment& fragment) override
  {
    if (this->Position == this->Transfers.size())
    {
      return false;
    }
    const Transfer& transfer = this->Transfers[this->Position++];
    const CellReader& reader = this->Own.at(transfer.From)->GetPiece();
    Header header{ static_cast<std::uint32_t>(transfer.From),
      static_cast<std::uint32_t>(transfer.To), {}, {} };
    for (int axis = 0; axis < 3; ++axis)
    {
      header.Min[axis] = transfer.Cells.Min[axis];
      header.Max[axis] = transfer.Cells.Max[axis];
    }
    const auto count = static_cast<std::size_t>(transfer.Cells.GetCount());
    const std::size_t bytes = count * bricks::GetBytes(reader.GetType());
    const auto components = static_cast<std::size_t>(reader.CountComponents());
    fragment.Block = static_cast<dsm::BlockId>(this->All[transfer.To].Rank);
    fragment.Bytes.resize(sizeof(header) + count + components * bytes);
    std::byte* out = fragment.Bytes.data();
    std::memcpy(out, &header, sizeof(header));
    out += sizeof(header);
    reader.ReadStates(transfer.Cells, reinterpret_cast<std::uint8_t*>(out));
    out += count;
    this->Values.resize(bytes);
    for (std::size_t component = 0; component < components; ++component, out += bytes)
    {
      reader.ReadValues(static_cast<int>(component), transfer.Cells, this->Values.data());
      std::memcpy(out, this->Values.data(), bytes); // out need not be aligned
    }
    return true;
  }
  double GetProgress() const override
  {
    return this->Transfers.empty()
      ? 1.0
      : static_cast<double>(this->Position) / static_cast<double>(this->Transfers.size());
  }

private:
  const std::vector<Transfer>& Transfers;
  const Pieces& All;
  const OwnPieces& Own;
  std::vector<std::byte> Values;
  std::size_t Position = 0;
};

void Absorb(const OwnPieces& own, const std::byte* bytes, std::size_t count)
{
  Header header{};
  if (count >= sizeof(header))
  {
    std::memcpy(&header, bytes, sizeof(header));
  }
  const auto to = own.find(header.To);
  if (count < sizeof(header) || to == own.end())
  {
    throw dsm::Error("Cells arrived for a piece that this rank does not have. Do all ranks run the "
                     "same build?");
  }
  const Box cells{ { header.Min[0], header.Min[1], header.Min[2] },
    { header.Max[0], header.Max[1], header.Max[2] } };
  to->second->AddNeighbors(header.From, cells, bytes + sizeof(header), count - sizeof(header));
}

} // namespace

void CellExchange::Run(dsm::Messenger& messenger, std::string_view what,
  const std::vector<Piece>& pieces, const std::map<std::size_t, std::shared_ptr<CellAverages>>& own)
{
  std::optional<TransferList> transfers;
  messenger.RunTogether(what, [&] { transfers.emplace(pieces, own); });
  LayerSource source(transfers->Get(), pieces, own);
  const auto absorb = [&](dsm::BlockId, const std::byte* bytes, std::size_t count)
  { Absorb(own, bytes, count); };
  dsm::FragmentStream::RunToRanks(what, messenger, source, absorb);
}

} // namespace bricks
