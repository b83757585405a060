// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/write/WrittenHdfFile.h"

#include "DSMVolumeFiles/base/FileError.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace vol
{

WrittenHdfFile::WrittenHdfFile(std::string path)
  : Path(std::move(path))
{
}

WrittenHdfFile::~WrittenHdfFile()
{
  this->Close();
}

void WrittenHdfFile::Create(unsigned indexNodeEntries)
{
  const HdfHandle creation(H5Pcreate(H5P_FILE_CREATE), &H5Pclose);
  H5Pset_istore_k(creation.Get(), indexNodeEntries);
  errno = 0;
  this->Id = H5Fcreate(this->Path.c_str(), H5F_ACC_TRUNC, creation.Get(), H5P_DEFAULT);
  this->Check(this->Id < 0 ? -1 : 0);
  this->HoldMetadata();
}

bool WrittenHdfFile::Open()
{
  errno = 0;
  this->Id = H5Fopen(this->Path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  if (this->Id < 0)
  {
    return false;
  }
  this->HoldMetadata();
  return true;
}

void WrittenHdfFile::Flush()
{
  errno = 0;
  this->Reserve();
  this->Check(H5Fflush(this->Id, H5F_SCOPE_GLOBAL));
}

void WrittenHdfFile::CloseWritten()
{
  errno = 0;
  this->Reserve();
  this->Check(H5Fclose(std::exchange(this->Id, H5I_INVALID_HID)));
}

void WrittenHdfFile::Close()
{
  if (this->Id >= 0)
  {
    H5Fclose(std::exchange(this->Id, H5I_INVALID_HID));
  }
}

void WrittenHdfFile::Check(herr_t result)
{
  if (result < 0)
  {
    const int cause = errno;
    this->Divert();
    throw FileError(this->Path,
      "cannot be written" + (cause != 0 ? std::string(": ") + std::strerror(cause) : "") + ".");
  }
}

HdfHandle WrittenHdfFile::Own(hid_t id, HdfHandle::Closer closer)
{
  this->Check(id < 0 ? -1 : 0);
  return { id, closer };
}

void WrittenHdfFile::CreateGroup(const char* name)
{
  this->Own(H5Gcreate2(this->Id, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), &H5Gclose);
}

HdfHandle WrittenHdfFile::CreateDataset(
  const std::string& name, hid_t type, const std::vector<hsize_t>& shape, hid_t creation)
{
  const HdfHandle space =
    this->Own(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), &H5Sclose);
  return this->Own(
    H5Dcreate2(this->Id, name.c_str(), type, space.Get(), H5P_DEFAULT, creation, H5P_DEFAULT),
    &H5Dclose);
}

void WrittenHdfFile::WriteAttribute(
  hid_t object, const char* name, hid_t type, const void* numbers, int count)
{
  const hsize_t shape = static_cast<hsize_t>(count);
  const HdfHandle space = this->Own(H5Screate_simple(1, &shape, nullptr), &H5Sclose);
  const HdfHandle attribute =
    this->Own(H5Acreate2(object, name, type, space.Get(), H5P_DEFAULT, H5P_DEFAULT), &H5Aclose);
  this->Check(H5Awrite(attribute.Get(), type, numbers));
}

void WrittenHdfFile::WriteAttribute(hid_t object, const char* name, const std::string& text)
{
  const HdfHandle type = this->Own(H5Tcopy(H5T_C_S1), &H5Tclose);
  H5Tset_size(type.Get(), text.size());
  H5Tset_strpad(type.Get(), H5T_STR_NULLPAD);
  const HdfHandle one = this->Own(H5Screate(H5S_SCALAR), &H5Sclose);
  const HdfHandle attribute =
    this->Own(H5Acreate2(object, name, type.Get(), one.Get(), H5P_DEFAULT, H5P_DEFAULT), &H5Aclose);
  this->Check(H5Awrite(attribute.Get(), type.Get(), text.data()));
}

void WrittenHdfFile::Divert()
{
  const int descriptor = this->GetDescriptor();
  const int memory =
    descriptor >= 0 && !this->IsDiverted ? memfd_create("dsm-nowhere", MFD_CLOEXEC) : -1;
  if (memory >= 0)
  {
    this->IsDiverted = dup2(memory, descriptor) >= 0;
    close(memory);
  }
}

void WrittenHdfFile::Reserve(std::uint64_t beyond)
{
  hsize_t end = 0;
  this->Check(H5Fget_filesize(this->Id, &end));
#ifdef __linux__
  const int descriptor = this->GetDescriptor();
  if (descriptor >= 0 &&
    fallocate(descriptor, FALLOC_FL_KEEP_SIZE, 0, static_cast<off_t>(end + beyond)) != 0 &&
    (errno == ENOSPC || errno == EDQUOT || errno == EFBIG || errno == EIO))
  {
    this->Check(-1);
  }
  errno = 0;
#endif
}

void WrittenHdfFile::HoldMetadata() const
{
  H5AC_cache_config_t config;
  config.version = H5AC__CURR_CACHE_CONFIG_VERSION;
  H5Fget_mdc_config(this->Id, &config);
  config.evictions_enabled = false;
  config.incr_mode = H5C_incr__off;
  config.decr_mode = H5C_decr__off;
  config.flash_incr_mode = H5C_flash_incr__off;
  H5Fset_mdc_config(this->Id, &config);
}

int WrittenHdfFile::GetDescriptor() const
{
  void* handle = nullptr;
  return this->Id >= 0 && H5Fget_vfd_handle(this->Id, H5P_DEFAULT, &handle) >= 0
    ? *static_cast<int*>(handle)
    : -1;
}

} // namespace vol
