// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/hdf/HdfHeap.h"

#include "DSMVolumeFiles/base/FileError.h"
#include "DSMVolumeFiles/base/SmallFile.h"
#include "DSMVolumeFiles/hdf/HdfBytes.h"
#include "DSMVolumeFiles/hdf/HdfLibrary.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace vol
{

namespace
{

constexpr std::size_t LengthBytes = 4; ///< of an element in the file, before an address and
constexpr std::size_t IndexBytes = 4;

constexpr const char* OwnTag = "DSM element of a list";

/// A conversion that leaves an element as it is in the file. It refuses opaque types of others.
herr_t KeepBytes(hid_t, hid_t to, H5T_cdata_t* data, size_t, size_t, size_t, void*, void*, hid_t)
{
  if (data->command == H5T_CONV_INIT)
  {
    char* const tag = H5Tget_tag(to);
    const bool isOwn = tag && std::string(tag) == OwnTag;
    H5free_memory(tag);
    data->need_bkg = H5T_BKG_NO;
    return isOwn ? 0 : -1;
  }
  return 0;
}

/// Has the library give the elements themselves, instead of what they refer to: lengths, addresses
/// and indices. None where it does not.
std::vector<std::byte> ReadElements(hid_t attribute, std::size_t count, std::size_t bytes)
{
  const HdfHandle opaque(H5Tcreate(H5T_OPAQUE, bytes), &H5Tclose);
  const HdfHandle list(H5Tvlen_create(H5T_NATIVE_CHAR), &H5Tclose);
  H5Tset_tag(opaque.Get(), OwnTag);
  // The library asks the conversion that was registered last: h5py has one for any opaque type.
  H5Tregister(H5T_PERS_SOFT, OwnTag, list.Get(), opaque.Get(), &KeepBytes);
  std::vector<std::byte> elements(count * bytes);
  if (H5Aread(attribute, opaque.Get(), elements.data()) < 0)
  {
    elements.clear();
  }
  H5Tunregister(H5T_PERS_SOFT, OwnTag, list.Get(), opaque.Get(), &KeepBytes);
  return elements;
}

/// Returns whether a collection of the heap is whole, and an object in it has so many bytes.
bool HasObject(const PositionedFile& file, std::uint64_t place, std::size_t sizeBytes,
  std::uint64_t wanted, std::uint64_t wantedBytes)
{
  constexpr std::uint64_t header = 16; // of the collection, and of each object
  constexpr std::size_t sizeAt = 8;
  const auto head = HdfBytes::Read(file, place, header);
  const auto heap = head && head->Begins("GCOL") && head->Get(4, 1) == 1
    ? HdfBytes::Read(file, place, head->Get(sizeAt, sizeBytes))
    : std::nullopt;
  const std::uint64_t all = heap ? heap->GetCount() : 0;
  bool isFound = false;
  for (std::uint64_t at = header; at < all && all - at >= header;)
  {
    const std::uint64_t left = all - at;
    const std::uint64_t index = heap->Get(at, 2);
    const std::uint64_t bytes = heap->Get(at + sizeAt, sizeBytes);
    // Free space counts its own header.
    const std::uint64_t step = bytes > left || index == 0 ? bytes : header + (bytes + 7) / 8 * 8;
    if (step < header || step > left || (index == wanted && bytes != wantedBytes))
    {
      return false;
    }
    isFound = isFound || index == wanted;
    at += step;
  }
  return isFound;
}

bool IsWhole(hid_t attribute, std::size_t count, const std::string& path)
{
  const HdfHandle file(H5Iget_file_id(attribute), &H5Fclose);
  const HdfHandle creation(H5Fget_create_plist(file.Get()), &H5Pclose);
  const HdfHandle type(H5Aget_type(attribute), &H5Tclose);
  std::size_t addressBytes = 0;
  std::size_t sizeBytes = 0;
  hsize_t before = 0;
  if (H5Pget_sizes(creation.Get(), &addressBytes, &sizeBytes) < 0 ||
    H5Pget_userblock(creation.Get(), &before) < 0 || addressBytes > 8 || sizeBytes > 8)
  {
    return false;
  }
  // A reference to an object is its address.
  const std::size_t width = H5Tget_class(type.Get()) == H5T_STRING ? 1 : addressBytes;
  const std::size_t bytes = LengthBytes + addressBytes + IndexBytes;
  const HdfBytes elements(ReadElements(attribute, count, bytes));
  const PositionedFile whole(path);
  for (std::size_t at = 0; at < elements.GetCount(); at += bytes)
  {
    const std::uint64_t address = elements.Get(at + LengthBytes, addressBytes);
    if (address != 0 && // else the list is empty
      (before + address < address ||
        !HasObject(whole, before + address, sizeBytes,
          elements.Get(at + LengthBytes + addressBytes, IndexBytes),
          width * elements.Get(at, LengthBytes))))
    {
      return false;
    }
  }
  return true;
}

} // namespace

void CheckHdfHeap(hid_t attribute, std::size_t count)
{
  const std::string path = GetHdfText(&H5Fget_name, attribute);
  if (!IsWhole(attribute, count, path))
  {
    const std::string object = GetHdfText(&H5Iget_name, attribute);
    const std::string name =
      GetHdfText([=](char* to, std::size_t size) { return H5Aget_name(attribute, size, to); });
    throw FileError(path,
      "is damaged: the attribute " + Quote(name) + " of " + Quote(object) +
        " refers to a place in the file's global heap that does not have its value.");
  }
}

} // namespace vol
