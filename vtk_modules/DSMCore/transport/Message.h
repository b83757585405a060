// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_Message_h
#define dsm_Message_h

#include "DSMCore/base/Error.h"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

namespace dsm
{

/// Kind of a message; its receiver dispatches on this.
enum class MessageKind : std::uint32_t
{
  Collective = 1,
  Fragment,
  PublishDone,
  BlockRequest,
  BlockReply,
  TileRequest,
  TileGrant,
  StealRequest,
  StolenTiles,
  GivenTiles,
  FrameDone,
  FrameStop,
  FrameAbort,
  FrameEnd,
  SignOfLife,
  Last = SignOfLife
};

/// A run of bytes from one rank to another. Every rank runs the same binary, so the payload is in
/// native byte order. `Session` numbers the collective step the message belongs to (see Messenger).
struct Message
{
  MessageKind Kind = MessageKind::Collective;
  std::uint32_t Session = 0;
  int Source = -1;
  std::vector<std::byte> Payload;
};

/// The bytes of a trivially copyable value.
template <class T>
std::vector<std::byte> Encode(const T& value)
{
  static_assert(std::is_trivially_copyable_v<T>, "only plain values travel");
  std::vector<std::byte> bytes(sizeof(T));
  std::memcpy(bytes.data(), &value, sizeof(T));
  return bytes;
}

/// The value at the start of a message of kind `kind`. Throws Error when the kind differs, or when
/// the payload is not exactly the value (`exact`) or is shorter than it.
template <class T>
T Decode(const Message& message, MessageKind kind, bool exact = true)
{
  static_assert(std::is_trivially_copyable_v<T>, "only plain values travel");
  if (message.Kind != kind || message.Payload.size() < sizeof(T) ||
    (exact && message.Payload.size() != sizeof(T)))
  {
    throw Error("A message from rank " + std::to_string(message.Source) + " of kind " +
      std::to_string(static_cast<unsigned>(message.Kind)) + " with " +
      std::to_string(message.Payload.size()) + " bytes was rejected: kind " +
      std::to_string(static_cast<unsigned>(kind)) + " with " + std::to_string(sizeof(T)) +
      " bytes was expected. Do all ranks run the same build?");
  }
  T value;
  std::memcpy(&value, message.Payload.data(), sizeof(T));
  return value;
}

/// The values, one or more, that a message of kind `kind` consists of. Throws Error when the kind
/// differs, or the payload is anything else.
template <class T>
std::vector<T> DecodeSeveral(const Message& message, MessageKind kind)
{
  static_assert(std::is_trivially_copyable_v<T>, "only plain values travel");
  const std::size_t bytes = message.Payload.size();
  if (message.Kind != kind || bytes == 0 || bytes % sizeof(T) != 0)
  {
    throw Error("A message from rank " + std::to_string(message.Source) + " of kind " +
      std::to_string(static_cast<unsigned>(message.Kind)) + " with " + std::to_string(bytes) +
      " bytes was rejected: kind " + std::to_string(static_cast<unsigned>(kind)) +
      " with a multiple of " + std::to_string(sizeof(T)) +
      " bytes was expected. Do all ranks run the same build?");
  }
  std::vector<T> values(bytes / sizeof(T));
  std::memcpy(values.data(), message.Payload.data(), bytes);
  return values;
}

/// Puts a value behind a run of bytes. Behind, not before, so that the receiver takes it off
/// (DetachTail) without moving what precedes it.
template <class T>
void AttachTail(std::vector<std::byte>& bytes, const T& value)
{
  static_assert(std::is_trivially_copyable_v<T>, "only plain values travel");
  const std::size_t size = bytes.size();
  if (bytes.capacity() < size + sizeof(T))
  {
    bytes.reserve(size + sizeof(T)); // exactly: growth by doubling would waste a block's worth
  }
  bytes.resize(size + sizeof(T));
  std::memcpy(bytes.data() + size, &value, sizeof(T));
}

/// Takes off what AttachTail put there. Throws Error when the kind differs or the payload is
/// shorter than the value.
template <class T>
T DetachTail(Message& message, MessageKind kind)
{
  static_assert(std::is_trivially_copyable_v<T>, "only plain values travel");
  if (message.Kind != kind || message.Payload.size() < sizeof(T))
  {
    throw Error("A message from rank " + std::to_string(message.Source) + " of kind " +
      std::to_string(static_cast<unsigned>(message.Kind)) + " with " +
      std::to_string(message.Payload.size()) + " bytes was rejected: kind " +
      std::to_string(static_cast<unsigned>(kind)) + " with at least " + std::to_string(sizeof(T)) +
      " bytes was expected. Do all ranks run the same build?");
  }
  T value;
  const std::size_t size = message.Payload.size() - sizeof(T);
  std::memcpy(&value, message.Payload.data() + size, sizeof(T));
  message.Payload.resize(size);
  return value;
}

} // namespace dsm

#endif
