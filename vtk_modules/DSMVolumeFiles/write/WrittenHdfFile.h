// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_WrittenHdfFile_h
#define vol_WrittenHdfFile_h

#include "DSMVolumeFiles/hdf/HdfLibrary.h"

#include <cstdint>
#include <string>
#include <vector>

namespace vol
{

/// An HDF5 file that is being written, on a disk that may become full at any time. A failure throws dsm::Error,
/// which names the file and the cause; then it can still be closed. All members under GetHdfLock.
class WrittenHdfFile
{
public:
  explicit WrittenHdfFile(std::string path);
  ~WrittenHdfFile();
  WrittenHdfFile(const WrittenHdfFile&) = delete;
  WrittenHdfFile& operator=(const WrittenHdfFile&) = delete;

  void Create(unsigned indexNodeEntries);
  /// False where it is no HDF5 file.
  bool Open();
  /// All that was written is in the file.
  void Flush();
  void CloseWritten();
  /// Whatever has become of it. Throws nothing.
  void Close();

  hid_t Get() const { return this->Id; }
  void Check(herr_t result);
  HdfHandle Own(hid_t id, HdfHandle::Closer closer);
  void CreateGroup(const char* name);
  HdfHandle CreateDataset(
    const std::string& name, hid_t type, const std::vector<hsize_t>& shape, hid_t creation);
  void WriteAttribute(hid_t object, const char* name, hid_t type, const void* numbers, int count);
  void WriteAttribute(hid_t object, const char* name, const std::string& text);

  /// Before the library writes what it holds, or much at once: once that has failed half way, the file cannot be closed
  /// any more, wherever the rest goes. Makes sure of as many bytes beyond its end. Not every file system can do it.
  void Reserve(std::uint64_t beyond = 0);

  /// A file that cannot be written cannot be closed either, and the library ends the process with it: what it still
  /// has to write goes to memory, and then nowhere.
  void Divert();

private:
  /// Holds the library's metadata in memory until they are flushed. In between, the file is as it was at the last
  /// flush, with the data added since behind its end.
  void HoldMetadata() const;
  /// Returns the file descriptor; -1 when the file is closed.
  int GetDescriptor() const;

  std::string Path;
  hid_t Id = H5I_INVALID_HID;
  bool IsDiverted = false;
};

} // namespace vol

#endif
