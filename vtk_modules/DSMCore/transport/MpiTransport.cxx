// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/transport/MpiTransport.h"

#include "DSMCore/base/Error.h"

#ifdef DSM_HAS_MPI

#define OMPI_SKIP_MPICXX // the C++ bindings are not ours to use
#include <mpi.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <deque>
#include <limits>
#include <list>
#include <new>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace dsm
{

namespace
{

constexpr int Tag = 0;
/// Tag of messages that the receiver confirms when it begins to receive them. MPI_Issend would do
/// the same, but in Open MPI 5.0.7 it loses messages between ranks of a host, and the sender then
/// waits forever.
constexpr int ConfirmedTag = 1;
/// Kind of the message that confirms those; it is not delivered.
constexpr auto ReceiptKind =
  static_cast<MessageKind>(static_cast<std::uint32_t>(MessageKind::Last) + 1);
/// Matched messages that may be under way to this rank before it looks for more.
constexpr std::size_t MaximumArrivingBytes = std::size_t(16) << 20;
/// Lets a rank without memory take part in what all must agree on.
constexpr std::size_t SendReserveBytes = std::size_t(1) << 20;
/// How long an ended transport waits, before it is closed, for the other ranks to take its last messages.
constexpr std::chrono::seconds DrainTime(5);

/// Travels behind the payload (see AttachTail).
struct WireHeader
{
  std::uint32_t Kind;
  std::uint32_t Session;
  std::uint64_t PayloadBytes;
};

/// Messages of another rank that this rank has begun to receive since its last confirmation.
struct Receipt
{
  std::uint64_t Messages = 0;
  std::uint64_t PayloadBytes = 0;
};

bool IsRunning()
{
  int initialized = 0;
  int finalized = 0;
  MPI_Initialized(&initialized);
  MPI_Finalized(&finalized);
  return initialized && !finalized;
}

class Transmission final : public Transport
{
public:
  explicit Transmission(MPI_Comm communicator)
  {
    // Until the duplicate has its own, the handler of the parent is in charge.
    this->Check(MPI_Comm_dup(communicator, &this->Communicator), "MPI_Comm_dup");
    this->Check(
      MPI_Comm_set_errhandler(this->Communicator, MPI_ERRORS_RETURN), "MPI_Comm_set_errhandler");
    this->Check(MPI_Comm_rank(this->Communicator, &this->Rank), "MPI_Comm_rank");
    this->Check(MPI_Comm_size(this->Communicator, &this->Size), "MPI_Comm_size");
    this->Arriving.resize(static_cast<std::size_t>(this->Size));
    this->Receipts.resize(static_cast<std::size_t>(this->Size));
  }

  /// Does not wait for the other ranks, which may be at something else that waits for this one. Messages that are
  /// still under way stay with an ended transmission, until CloseEnded.
  ~Transmission() override
  {
    if (this->IsEnded || !IsRunning())
    {
      return;
    }
    this->IsEnded = true;
    try
    {
      std::vector<std::unique_ptr<Transmission>>& ended = GetEnded();
      ended.reserve(ended.size() + 1); // once it is moved, nothing may fail
      ended.emplace_back(new Transmission(std::move(*this)));
    }
    catch (const std::bad_alloc&)
    {
      this->Close();
    }
  }

  /// Closes what this rank has ended. Collective over the communicators of all of it.
  static void CloseEnded()
  {
    for (const std::unique_ptr<Transmission>& ended : std::exchange(GetEnded(), {}))
    {
      ended->Close();
    }
  }

  int GetRank() const override { return this->Rank; }
  int GetSize() const override { return this->Size; }

  void Post(int destination, Message message) override
  {
    if (destination == this->Rank)
    {
      message.Source = this->Rank;
      this->ToSelf.push_back(std::move(message));
      return;
    }
    if (message.Payload.size() > std::numeric_limits<int>::max() - sizeof(WireHeader))
    {
      throw Error("A message of " + std::to_string(message.Payload.size()) +
        " bytes cannot be sent from rank " + std::to_string(this->Rank) + " to rank " +
        std::to_string(destination) + ": the maximum is 2 GiB. Use smaller blocks.");
    }
    const MessageKind kind = message.Kind;
    Sending sending{ kind, message.Payload.size(), std::move(message.Payload) };
    AttachTail(sending.Buffer,
      WireHeader{ static_cast<std::uint32_t>(kind), message.Session, sending.PayloadBytes });
    // MPI may call a small message sent that has yet to be taken. So that the unsent bytes count what
    // would otherwise pile up, unexpected, in the receiver's memory, it tells when it takes them.
    const bool isConfirmed = kind == MessageKind::Fragment;
    const int bytes = static_cast<int>(sending.Buffer.size());
    this->MakeRoomToSend(); // from MPI's call on, nothing may fail here
    MPI_Request request = MPI_REQUEST_NULL;
    this->Check(MPI_Isend(sending.Buffer.data(), bytes, MPI_BYTE, destination,
                  isConfirmed ? ConfirmedTag : Tag, this->Communicator, &request),
      "MPI_Isend");
    if (isConfirmed)
    {
      ++this->Unconfirmed.Messages;
      this->Unconfirmed.PayloadBytes += sending.PayloadBytes;
    }
    this->UnsentBytes += sending.PayloadBytes;
    ++this->UnsentMessages.at(static_cast<std::size_t>(kind));
    this->Outgoing.push_back(std::move(sending));
    this->Requests.push_back(request);
  }

  bool Progress(const Deliver& deliver) override
  {
    bool any = this->FinishSends();
    any |= this->BeginReceives();
    any |= this->SendReceipts();
    for (std::size_t count = this->ToSelf.size(); count > 0; --count)
    {
      deliver(std::move(this->ToSelf.front()));
      this->ToSelf.pop_front();
      any = true;
    }
    for (std::size_t source = 0; source < this->Arriving.size(); ++source)
    {
      any |= this->FinishReceives(static_cast<int>(source), deliver);
    }
    return any;
  }

  std::size_t GetUnsentBytes() const override
  {
    return std::max<std::size_t>(this->UnsentBytes, this->Unconfirmed.PayloadBytes);
  }

  bool HasUnsent(MessageKind kind) const override
  {
    return this->UnsentMessages[static_cast<std::size_t>(kind)] > 0 ||
      (kind == MessageKind::Fragment && (this->Unconfirmed.Messages > 0 || this->OpenReceipts > 0));
  }

private:
  Transmission(Transmission&&) = default; ///< MPI's buffers stay where they are

  /// Transmissions that this rank has ended, but not closed. They are closed before MPI is
  /// finalized at the latest.
  static std::vector<std::unique_ptr<Transmission>>& GetEnded()
  {
    static std::vector<std::unique_ptr<Transmission>> ended;
    return ended;
  }

  void Close()
  {
    if (this->Drain())
    {
      MPI_Comm_free(&this->Communicator);
    }
    else
    {
      // MPI may still read and write these buffers and use the communicator: they stay.
      new std::vector<Sending>(std::move(this->Outgoing));
      new std::vector<std::list<Receiving>>(std::move(this->Arriving));
      new std::vector<Confirming>(std::move(this->Receipts));
    }
  }

  struct Sending
  {
    MessageKind Kind = MessageKind::Collective;
    std::size_t PayloadBytes = 0;
    std::vector<std::byte> Buffer;
  };

  /// Receipts for one rank. The buffer that MPI reads does not change until it has been sent.
  struct Confirming
  {
    struct
    {
      Receipt Taken;
      WireHeader Header;
    } Wire{};
    MPI_Request Request = MPI_REQUEST_NULL;
    Receipt Owed;
  };

  struct Receiving
  {
    MPI_Request Request = MPI_REQUEST_NULL;
    bool IsConfirmed = false;
    std::size_t WireBytes = 0;
    Message Arrived;
    bool IsLost = false;  ///< there was no memory for it
    bool IsWhole = false; ///< its header has been read
  };

  /// A request and what belongs to it stand at the same place of two arrays, which grow here and
  /// nowhere else, so that neither can fail to grow with the other.
  void MakeRoomToSend()
  {
    const std::size_t needed = this->Outgoing.size() + 1;
    if (this->Outgoing.capacity() < needed || this->Requests.capacity() < needed ||
      this->Done.size() < needed)
    {
      const std::size_t room = std::max<std::size_t>(2 * needed, 16);
      this->Outgoing.reserve(room);
      this->Requests.reserve(room);
      this->Done.resize(room);
    }
  }

  void FillReserve() noexcept
  {
    if (this->Reserve.capacity() < SendReserveBytes)
    {
      try
      {
        this->Reserve.reserve(SendReserveBytes);
      }
      catch (const std::bad_alloc&)
      {
        // Tried again before the next message.
      }
    }
  }

  /// Memory for a message of `bytes`: when there is none left, the reserve. Empty when the message is
  /// larger than that. Throws std::bad_alloc when the reserve is in use.
  std::vector<std::byte> TakeBuffer(std::size_t bytes)
  {
    this->FillReserve();
    try
    {
      return std::vector<std::byte>(bytes);
    }
    catch (const std::bad_alloc&)
    {
      if (bytes > SendReserveBytes)
      {
        return {};
      }
      if (bytes > this->Reserve.capacity())
      {
        throw;
      }
      this->Reserve.resize(bytes);
      return std::exchange(this->Reserve, {});
    }
  }

  void Check(int code, const char* call) const
  {
    if (code == MPI_SUCCESS)
    {
      return;
    }
    std::array<char, MPI_MAX_ERROR_STRING> text{};
    int length = 0;
    MPI_Error_string(code, text.data(), &length);
    throw Error(std::string(call) + " failed on rank " + std::to_string(this->Rank) + ": " +
      std::string(text.data(), static_cast<std::size_t>(length)));
  }

  bool FinishSends()
  {
    const int count = static_cast<int>(this->Requests.size());
    if (count == 0)
    {
      return false;
    }
    int completed = 0;
    this->Check(MPI_Testsome(
                  count, this->Requests.data(), &completed, this->Done.data(), MPI_STATUSES_IGNORE),
      "MPI_Testsome");
    if (completed == 0 || completed == MPI_UNDEFINED)
    {
      return false;
    }
    // From the back, so that the last element can take the place of the one that goes.
    std::sort(this->Done.begin(), this->Done.begin() + completed);
    for (int i = completed - 1; i >= 0; --i)
    {
      const std::size_t index = static_cast<std::size_t>(this->Done[i]);
      this->UnsentBytes -= this->Outgoing[index].PayloadBytes;
      --this->UnsentMessages[static_cast<std::size_t>(this->Outgoing[index].Kind)];
      std::swap(this->Outgoing[index], this->Outgoing.back());
      std::swap(this->Requests[index], this->Requests.back());
      this->Outgoing.pop_back();
      this->Requests.pop_back();
    }
    return true;
  }

  bool BeginReceives()
  {
    bool any = false;
    while (this->ArrivingBytes < MaximumArrivingBytes)
    {
      if (this->Spare.empty())
      {
        this->Spare.emplace_back();
      }
      Receiving& receiving = this->Spare.front();
      if (this->Matched == MPI_MESSAGE_NULL && !this->Match(receiving))
      {
        break;
      }
      receiving.Arrived.Payload = this->TakeBuffer(receiving.WireBytes);
      receiving.IsLost = receiving.Arrived.Payload.empty();
      // Taken all the same, cut to nothing: the sender, and what follows, must not wait for it.
      const int bytes = receiving.IsLost ? 0 : static_cast<int>(receiving.WireBytes);
      this->Check(MPI_Imrecv(receiving.Arrived.Payload.data(), bytes, MPI_BYTE, &this->Matched,
                    &receiving.Request),
        "MPI_Imrecv");
      if (receiving.IsConfirmed)
      {
        this->Owe(receiving);
      }
      auto& queue = this->Arriving[static_cast<std::size_t>(receiving.Arrived.Source)];
      queue.splice(queue.end(), this->Spare); // no memory is needed any more
      this->ArrivingBytes += static_cast<std::size_t>(bytes);
      any = true;
    }
    return any;
  }

  /// Finds the next message, if there is one, and what memory it wants.
  bool Match(Receiving& receiving)
  {
    int found = 0;
    MPI_Message matched = MPI_MESSAGE_NULL;
    MPI_Status status;
    this->Check(
      MPI_Improbe(MPI_ANY_SOURCE, MPI_ANY_TAG, this->Communicator, &found, &matched, &status),
      "MPI_Improbe");
    if (found)
    {
      int bytes = 0;
      this->Check(MPI_Get_count(&status, MPI_BYTE, &bytes), "MPI_Get_count");
      receiving.WireBytes = static_cast<std::size_t>(bytes);
      receiving.Arrived.Source = status.MPI_SOURCE;
      receiving.IsConfirmed = status.MPI_TAG == ConfirmedTag;
      this->Matched = matched;
    }
    return found != 0;
  }

  void Owe(const Receiving& receiving)
  {
    Confirming& confirming = this->Receipts[static_cast<std::size_t>(receiving.Arrived.Source)];
    if (confirming.Owed.Messages == 0 && confirming.Request == MPI_REQUEST_NULL)
    {
      ++this->OpenReceipts;
    }
    ++confirming.Owed.Messages;
    confirming.Owed.PayloadBytes +=
      receiving.WireBytes - std::min(receiving.WireBytes, sizeof(WireHeader));
  }

  /// One to each rank that is owed some, unless the last is still on its way. Needs no memory.
  bool SendReceipts()
  {
    bool any = false;
    for (int rank = 0; rank<this->Size&& this->OpenReceipts> 0; ++rank)
    {
      Confirming& confirming = this->Receipts[static_cast<std::size_t>(rank)];
      if (confirming.Request == MPI_REQUEST_NULL && confirming.Owed.Messages > 0)
      {
        confirming.Wire.Taken = std::exchange(confirming.Owed, {});
        confirming.Wire.Header = { static_cast<std::uint32_t>(ReceiptKind), 0, sizeof(Receipt) };
        this->Check(MPI_Isend(&confirming.Wire, sizeof(confirming.Wire), MPI_BYTE, rank, Tag,
                      this->Communicator, &confirming.Request),
          "MPI_Isend");
        any = true;
      }
      if (confirming.Request != MPI_REQUEST_NULL)
      {
        int sent = 0;
        this->Check(MPI_Test(&confirming.Request, &sent, MPI_STATUS_IGNORE), "MPI_Test");
        if (sent && confirming.Owed.Messages == 0)
        {
          --this->OpenReceipts;
        }
      }
    }
    return any;
  }

  /// In the order in which they were matched, which is the order in which they were posted. A message that
  /// `deliver` does not take stays.
  bool FinishReceives(int source, const Deliver& deliver)
  {
    auto& queue = this->Arriving[static_cast<std::size_t>(source)];
    bool any = false;
    while (!queue.empty())
    {
      Receiving& receiving = queue.front();
      if (!receiving.IsWhole && !this->Finish(receiving, queue))
      {
        break;
      }
      if (receiving.Arrived.Kind == ReceiptKind)
      {
        const auto taken = Decode<Receipt>(receiving.Arrived, ReceiptKind);
        this->Unconfirmed.Messages -= taken.Messages;
        this->Unconfirmed.PayloadBytes -= taken.PayloadBytes;
      }
      else
      {
        deliver(std::move(receiving.Arrived));
      }
      queue.pop_front();
      any = true;
    }
    return any;
  }

  /// Returns whether the message at the head of `queue` has arrived. Throws, and removes it, if it
  /// is lost.
  bool Finish(Receiving& receiving, std::list<Receiving>& queue)
  {
    int arrived = 0;
    const int code = MPI_Test(&receiving.Request, &arrived, MPI_STATUS_IGNORE);
    if (receiving.IsLost && (arrived || code != MPI_SUCCESS)) // cut short is an error to MPI
    {
      const std::string text = "out of memory: a message of " +
        std::to_string(receiving.WireBytes) + " bytes from rank " +
        std::to_string(receiving.Arrived.Source) +
        " could not be received. Use more ranks or more hosts.";
      queue.pop_front();
      throw Error(text);
    }
    this->Check(code, "MPI_Test");
    if (!arrived)
    {
      return false;
    }
    this->ArrivingBytes -= receiving.WireBytes;
    receiving.IsWhole = true;
    try
    {
      this->ReadHeader(receiving.Arrived);
    }
    catch (...)
    {
      queue.pop_front();
      throw;
    }
    return true;
  }

  void ReadHeader(Message& message) const
  {
    const auto header = DetachTail<WireHeader>(message, message.Kind);
    if (header.PayloadBytes != message.Payload.size())
    {
      throw Error("Rank " + std::to_string(this->Rank) + " received a message of " +
        std::to_string(message.Payload.size()) + " bytes from rank " +
        std::to_string(message.Source) + " that declares " + std::to_string(header.PayloadBytes) +
        ". Do all ranks run the same build?");
    }
    message.Kind = static_cast<MessageKind>(header.Kind);
    message.Session = header.Session;
  }

  /// Takes and discards what is still under way until every rank's last message has been taken.
  bool Drain()
  {
    try
    {
      const auto end = std::chrono::steady_clock::now() + DrainTime;
      MPI_Request barrier = MPI_REQUEST_NULL;
      bool entered = false;
      int passed = 0;
      while (!passed || this->ArrivingBytes > 0)
      {
        if (!this->Progress([](Message&&) {}))
        {
          std::this_thread::yield();
        }
        if (!entered && this->Requests.empty() && !this->HasUnsent(MessageKind::Fragment))
        {
          this->Check(MPI_Ibarrier(this->Communicator, &barrier), "MPI_Ibarrier");
          entered = true;
        }
        if (entered && !passed)
        {
          this->Check(MPI_Test(&barrier, &passed, MPI_STATUS_IGNORE), "MPI_Test");
        }
        if (std::chrono::steady_clock::now() > end)
        {
          return false;
        }
      }
      return true;
    }
    catch (const std::exception&)
    {
      return false; // a destructor cannot report it; the buffers stay, as after a timeout
    }
  }

  MPI_Comm Communicator = MPI_COMM_NULL;
  int Rank = 0;
  int Size = 1;
  /// MPI_Testsome wants the requests side by side; see MakeRoomToSend.
  std::vector<MPI_Request> Requests;
  std::vector<Sending> Outgoing;
  std::vector<int> Done; ///< output of MPI_Testsome; has room for all requests
  std::size_t UnsentBytes = 0;
  std::array<std::size_t, static_cast<std::size_t>(MessageKind::Last) + 1> UnsentMessages{};
  Receipt Unconfirmed; ///< posted messages that their receivers have not begun to receive
  std::vector<std::list<Receiving>> Arriving; ///< per source
  std::vector<Confirming> Receipts;           ///< per source
  int OpenReceipts = 0;       ///< ranks that are owed some, or to which some are on their way
  std::list<Receiving> Spare; ///< one, made before MPI is asked for a message
  MPI_Message Matched =
    MPI_MESSAGE_NULL; ///< message of Spare, as long as there is no memory for it
  std::size_t ArrivingBytes = 0;
  std::deque<Message> ToSelf;
  bool IsEnded = false;           ///< what was under way is with another, or is closed
  std::vector<std::byte> Reserve; ///< for receiving when no memory is left; untouched until then
};

/// MPI deletes the attributes of MPI_COMM_SELF before it ends, while communication still works (MPI 4.0, section
/// 11.2.4).
void CloseEndedBeforeMpiEnds()
{
  static bool isAsked = false;
  if (isAsked)
  {
    return;
  }
  isAsked = true;
  const auto close = [](MPI_Comm, int, void*, void*)
  {
    Transmission::CloseEnded();
    return MPI_SUCCESS;
  };
  int key = MPI_KEYVAL_INVALID;
  MPI_Comm_create_keyval(MPI_COMM_NULL_COPY_FN, close, &key, nullptr);
  MPI_Comm_set_attr(MPI_COMM_SELF, key, nullptr);
}

} // namespace

std::unique_ptr<Transport> MpiTransport::Create(const void* communicator)
{
  if (!IsRunning())
  {
    return nullptr;
  }
  auto created = std::make_unique<Transmission>(
    communicator ? *static_cast<const MPI_Comm*>(communicator) : MPI_COMM_WORLD);
  Transmission::CloseEnded(); // all ranks are here
  CloseEndedBeforeMpiEnds();
  return created;
}

MpiTransport::Environment::Environment(int& argc, char**& argv)
{
  int initialized = 0;
  MPI_Initialized(&initialized);
  if (!initialized)
  {
    // SINGLE, as in ParaView, so that tests run what users run.
    int provided = MPI_THREAD_SINGLE;
    if (MPI_Init_thread(&argc, &argv, MPI_THREAD_SINGLE, &provided) != MPI_SUCCESS)
    {
      throw Error("MPI_Init_thread failed. Start the program with mpirun, or without MPI.");
    }
    this->Owner = true;
  }
}

MpiTransport::Environment::~Environment()
{
  if (this->Owner && IsRunning())
  {
    MPI_Finalize();
  }
}

} // namespace dsm

#else

namespace dsm
{

std::unique_ptr<Transport> MpiTransport::Create(const void*)
{
  return nullptr;
}

MpiTransport::Environment::Environment(int&, char**&) {}

MpiTransport::Environment::~Environment() = default;

} // namespace dsm

#endif
