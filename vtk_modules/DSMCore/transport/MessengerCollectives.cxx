// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/transport/MessengerInternals.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>
#include <optional>
#include <utility>

namespace dsm
{

namespace
{

/// Behind what a rank gives: how much it has, in all.
struct Contribution
{
  std::uint64_t Bytes;
  std::uint64_t Faring;
};

/// Behind what all hear of it; before it, the number of bytes of every rank, 64 bits each.
struct Verdict
{
  std::int32_t FailedRank; ///< whose text it is; below 0: none has failed
  std::int16_t IsEverywhere;
  std::int16_t HasLeft; ///< the step is over
};

/// Behind a piece.
struct PieceTail
{
  std::uint32_t Root; ///< whose bytes they are
};

template <class T>
T ReadTail(const std::vector<std::byte>& bytes, std::size_t behind = 0)
{
  T value;
  std::memcpy(&value, bytes.data() + bytes.size() - behind - sizeof(T), sizeof(T));
  return value;
}

/// A rank's place in the binomial tree of all ranks below `root`: rank r, counted from there, hears
/// from r without its lowest bit.
class Tree
{
public:
  Tree(int rank, int size, int root = 0)
    : Place((rank - root + size) % size)
    , Size(size)
    , Root(root)
    , Lowest(this->Place == 0 ? size : (this->Place & -this->Place))
  {
  }
  bool IsRoot() const { return this->Place == 0; }
  int GetParent() const { return this->ToRank(this->Place - this->Lowest); }
  int CountChildren() const
  {
    int count = 0;
    for (int step = 1; step < this->Lowest && this->Place + step < this->Size; step *= 2)
    {
      ++count;
    }
    return count;
  }
  int GetChild(int index) const { return this->ToRank(this->Place + (1 << index)); }

private:
  int ToRank(int place) const { return (place + this->Root) % this->Size; }

  int Place;
  int Size;
  int Root;
  int Lowest;
};

/// Returns the number of units in the message that begins with unit `first`, of `count` in all, if
/// `most` fit into one message.
std::size_t GetPiece(std::size_t first, std::size_t count, std::size_t most)
{
  return std::min(count - first, std::max<std::size_t>(most, 1));
}

std::string ToText(const std::byte* bytes, std::size_t count)
{
  return { reinterpret_cast<const char*>(bytes), count };
}

} // namespace

void Messenger::Internals::SpreadFromRankZero(std::vector<std::byte>& bytes)
{
  const Tree tree(this->Carrier->GetRank(), this->Carrier->GetSize());
  if (!tree.IsRoot())
  {
    this->Await([this] { return !this->Received.empty(); });
    bytes = std::move(this->Received.front().Payload);
    this->Received.clear();
  }
  // The farthest first: it has most to hand on.
  for (int child = tree.CountChildren() - 1; child >= 0; --child)
  {
    this->PostCopy(tree.GetChild(child), bytes.data(), bytes.size());
  }
}

std::vector<int> Messenger::GetChildren() const
{
  const Tree tree(this->GetRank(), this->GetSize());
  std::vector<int> children;
  for (int child = tree.CountChildren() - 1; child >= 0; --child)
  {
    children.push_back(tree.GetChild(child));
  }
  return children;
}

namespace
{

/// Returns rank 0's message to all ranks about their contributions; it includes every rank's bytes
/// only if they are few.
std::vector<std::byte> Judge(const std::vector<const std::vector<std::byte>*>& heard,
  std::uint64_t left, std::size_t pieceBytes)
{
  std::vector<std::byte> packed;
  Verdict verdict{ -1, 0, 0 };
  std::uint64_t total = 0;
  std::uint64_t worst = 0;
  for (std::size_t rank = 0; rank < heard.size(); ++rank)
  {
    const auto given = ReadTail<Contribution>(*heard[rank]);
    total += given.Bytes;
    if (given.Faring > worst)
    {
      worst = given.Faring;
      verdict.FailedRank = static_cast<std::int32_t>(rank);
    }
  }
  verdict.HasLeft = worst == left ? 1 : 0;
  const bool isWhole = verdict.FailedRank < 0 && total <= pieceBytes;
  if (verdict.FailedRank >= 0)
  {
    const auto& cause = *heard[static_cast<std::size_t>(verdict.FailedRank)];
    verdict.IsEverywhere =
      std::all_of(heard.begin(), heard.end(), [&](const auto* other) { return *other == cause; });
    packed.assign(cause.begin(), cause.end() - sizeof(Contribution));
  }
  for (std::size_t rank = 0; rank < heard.size() && isWhole; ++rank)
  {
    packed.insert(packed.end(), heard[rank]->begin(), heard[rank]->end() - sizeof(Contribution));
  }
  for (const auto* each : heard)
  {
    AttachTail(packed, ReadTail<Contribution>(*each).Bytes);
  }
  AttachTail(packed, verdict);
  return packed;
}

} // namespace

Messenger::Gathered Messenger::Gather(
  std::vector<std::byte>&& mine, Faring faring, Receivers receivers)
{
  Gathered gathered = this->Exchange(std::move(mine), faring, receivers);
  if (gathered.IsStepOver)
  {
    std::optional<StepAborted> aborted;
    this->Insist([&] { aborted.emplace(gathered.Outcome); });
    throw *aborted;
  }
  return gathered;
}

Messenger::Gathered Messenger::Exchange(
  std::vector<std::byte>&& mine, Faring faring, Receivers receivers)
{
  Internals& self = *this->Self;
  const std::size_t size = static_cast<std::size_t>(this->GetSize());
  const Contribution given{ mine.size(), static_cast<std::uint64_t>(faring) };
  const bool isLarge = faring == Faring::Well && mine.size() > self.PieceBytes;
  std::vector<std::byte> packed;
  self.RunCollective(
    [&]
    {
      std::vector<std::byte> own;
      this->Insist(
        [&]
        {
          own.reserve(sizeof(given) + (isLarge ? 0 : mine.size()));
          own.clear();
          own.insert(own.end(), mine.begin(), isLarge ? mine.begin() : mine.end());
          AttachTail(own, given);
        });
      if (this->GetRank() != 0)
      {
        self.PostCopy(0, own.data(), own.size());
      }
      else
      {
        self.Await([&] { return self.Received.size() == size - 1; });
        this->Insist(
          [&]
          {
            std::vector<const std::vector<std::byte>*> heard(size, &own);
            for (const Message& message : self.Received)
            {
              heard[static_cast<std::size_t>(message.Source)] = &message.Payload;
            }
            packed = Judge(heard, static_cast<std::uint64_t>(Faring::Left), self.PieceBytes);
          });
        self.Received.clear();
      }
      self.SpreadFromRankZero(packed);
    });

  Gathered gathered;
  const auto verdict = ReadTail<Verdict>(packed);
  const std::size_t tail = size * sizeof(std::uint64_t) + sizeof(verdict);
  if (verdict.FailedRank >= 0)
  {
    this->Insist([&] { gathered.Outcome.Cause = ToText(packed.data(), packed.size() - tail); });
    gathered.Outcome.FailedRank = verdict.FailedRank;
    gathered.Outcome.IsEverywhere = verdict.IsEverywhere != 0;
    gathered.IsStepOver = verdict.HasLeft != 0;
    return gathered;
  }
  std::vector<std::uint64_t> sizes;
  this->Insist([&] { sizes.resize(size); });
  std::memcpy(sizes.data(), packed.data() + packed.size() - tail, size * sizeof(std::uint64_t));
  if (std::accumulate(sizes.begin(), sizes.end(), std::uint64_t(0)) > self.PieceBytes)
  {
    gathered.Parts = this->GatherPieces(std::move(mine), std::move(sizes), receivers);
    return gathered;
  }
  this->Insist(
    [&]
    {
      gathered.Parts.resize(size);
      if (receivers == Receivers::RankZero && this->GetRank() != 0)
      {
        return;
      }
      auto next = packed.begin();
      for (std::size_t rank = 0; rank < size; ++rank)
      {
        const auto first = next;
        next += static_cast<std::ptrdiff_t>(sizes[rank]);
        gathered.Parts[rank].assign(first, next);
      }
    });
  return gathered;
}

/// Gathers from every rank along a tree of its own, or to rank 0 directly, all at the same time;
/// the pieces of a rank arrive in order. Pieces that pass through this rank are stored in the
/// result, so a rank takes no other memory than for the pieces that it posts.
std::vector<std::vector<std::byte>> Messenger::GatherPieces(
  std::vector<std::byte>&& mine, std::vector<std::uint64_t> sizes, Receivers receivers)
{
  /// Progress of one rank's bytes: the number received, and the ranks that get the next ones.
  struct Stream
  {
    std::size_t Arrived = 0;
    std::size_t Next = 0;
    int Child = 0;
  };
  Internals& self = *this->Self;
  const std::size_t size = sizes.size();
  const auto rank = static_cast<std::size_t>(this->GetRank());
  const bool toAll = receivers == Receivers::All;
  const bool isReceiver = toAll || rank == 0;
  for (std::size_t root = 0; root < size && !isReceiver; ++root)
  {
    sizes[root] = root == rank ? sizes[root] : 0; // does not pass here
  }
  std::vector<std::vector<std::byte>> parts;
  std::vector<Stream> streams;
  this->RunTogether("Cannot gather the ranks' data",
    [&]
    {
      streams.resize(size);
      parts.resize(size);
      for (std::size_t root = 0; root < size; ++root)
      {
        parts[root].resize(root == rank ? 0 : sizes[root]);
      }
    });
  streams[rank].Arrived = mine.size();
  parts[rank] = std::move(mine);

  std::size_t missing = size; // streams
  std::size_t turn = rank;
  const auto take = [&]
  {
    const bool any = !self.Received.empty();
    while (!self.Received.empty())
    {
      const std::vector<std::byte>& piece = self.Received.front().Payload;
      const auto root = static_cast<std::size_t>(ReadTail<PieceTail>(piece).Root);
      Stream& stream = streams[root];
      const std::size_t count = piece.size() - sizeof(PieceTail);
      std::copy_n(
        piece.begin(), count, parts[root].begin() + static_cast<std::ptrdiff_t>(stream.Arrived));
      stream.Arrived += count;
      self.Received.pop_front();
    }
    return any;
  };
  const auto send = [&](std::size_t root)
  {
    Stream& stream = streams[root];
    const Tree tree(static_cast<int>(rank), static_cast<int>(size), static_cast<int>(root));
    const int children = toAll ? tree.CountChildren() : isReceiver ? 0 : 1;
    if (stream.Next == stream.Arrived || !self.MaySend())
    {
      return false;
    }
    const std::size_t count = GetPiece(stream.Next, stream.Arrived, self.PieceBytes);
    if (stream.Child < children)
    {
      this->Insist(
        [&]
        {
          constexpr std::size_t headerRoom = 64; // the transport's
          const auto first = parts[root].begin() + static_cast<std::ptrdiff_t>(stream.Next);
          std::vector<std::byte> piece;
          piece.reserve(count + sizeof(PieceTail) + headerRoom);
          piece.assign(first, first + static_cast<std::ptrdiff_t>(count));
          AttachTail(piece, PieceTail{ static_cast<std::uint32_t>(root) });
          this->Post(
            toAll ? tree.GetChild(stream.Child) : 0, MessageKind::Collective, std::move(piece));
        });
      ++stream.Child;
    }
    if (stream.Child >= children)
    {
      stream.Child = 0;
      stream.Next += count;
    }
    return true;
  };
  self.RunCollective(
    [&]
    {
      self.Await([&] { return missing == 0; },
        [&]
        {
          bool any = take();
          missing = 0;
          for (std::size_t step = 0; step < size; ++step)
          {
            turn = (turn + 1) % size;
            any |= send(turn);
            missing += streams[turn].Next < sizes[turn] ? 1 : 0;
          }
          return any;
        });
    });
  if (!isReceiver)
  {
    parts[rank] = {};
  }
  return parts;
}

void Messenger::Sum(std::vector<std::uint64_t>& numbers)
{
  this->Reduce(numbers, [](std::uint64_t& sum, std::uint64_t number) { sum += number; });
}

void Messenger::ReduceBytes(
  std::byte* values, std::size_t count, std::size_t valueBytes, Combination combine)
{
  const auto counts = this->AllGatherValue(static_cast<std::uint64_t>(count));
  if (std::count(counts.begin(), counts.end(), counts.front()) != this->GetSize())
  {
    throw Error("The ranks combine arrays of different lengths. Do all ranks run the same build?");
  }
  Internals& self = *this->Self;
  const Tree tree(this->GetRank(), this->GetSize());
  const int children = tree.CountChildren();
  const std::size_t most = self.PieceBytes / valueBytes;
  std::array<std::size_t, 32> fromChild{}; // values that have been combined
  std::size_t up = 0;                      // that went up, combined of this rank and those below
  std::size_t down = 0;                    // that are combined of all ranks
  std::size_t next = 0;                    // of those, who gets which next
  int nextChild = 0;
  const auto take = [&]
  {
    const bool any = !self.Received.empty();
    while (!self.Received.empty())
    {
      const Message& message = self.Received.front();
      const std::size_t length = message.Payload.size() / valueBytes;
      int child = 0;
      while (child < children && tree.GetChild(child) != message.Source)
      {
        ++child;
      }
      std::size_t& begin = child < children ? fromChild[static_cast<std::size_t>(child)] : down;
      if (child < children)
      {
        combine(begin, message.Payload.data(), length);
      }
      else
      {
        std::copy_n(message.Payload.data(), length * valueBytes, values + begin * valueBytes);
      }
      begin += length;
      self.Received.pop_front();
    }
    return any;
  };
  const auto post = [&](int destination, std::size_t first, std::size_t length)
  { self.PostCopy(destination, values + first * valueBytes, length * valueBytes); };
  const auto send = [&]
  {
    const std::size_t ready =
      children == 0 ? count : *std::min_element(fromChild.begin(), fromChild.begin() + children);
    if (!self.MaySend())
    {
      return false;
    }
    bool any = false;
    // In whole pieces: what of one has come has come from all that are below.
    if (up < ready)
    {
      const std::size_t length = GetPiece(up, ready, most);
      if (!tree.IsRoot())
      {
        post(tree.GetParent(), up, length);
      }
      up += length;
      down = tree.IsRoot() ? up : down;
      any = true;
    }
    if (next < down)
    {
      const std::size_t length = GetPiece(next, down, most);
      if (nextChild < children)
      {
        post(tree.GetChild(nextChild++), next, length);
      }
      if (nextChild >= children)
      {
        nextChild = 0;
        next += length;
      }
      any = true;
    }
    return any;
  };
  self.RunCollective(
    [&]
    {
      self.Await([&] { return next == count && up == count; },
        [&]
        {
          const bool any = take();
          return send() || any;
        });
    });
}

std::vector<std::vector<std::byte>> Messenger::AllGather(std::vector<std::byte> mine)
{
  return this->Gather(std::move(mine), Faring::Well, Receivers::All).Parts;
}

std::vector<std::byte> Messenger::Broadcast(std::vector<std::byte> fromRankZero)
{
  if (this->GetRank() != 0)
  {
    fromRankZero.clear();
  }
  return std::move(this->AllGather(std::move(fromRankZero)).front());
}

void Messenger::Barrier()
{
  this->AllGather({});
}

} // namespace dsm
