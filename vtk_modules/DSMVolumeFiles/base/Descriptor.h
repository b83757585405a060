// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_Descriptor_h
#define vol_Descriptor_h

#include <utility>

#include <unistd.h>

namespace vol
{

/// A file descriptor, which is closed with it; negative: none.
class Descriptor
{
public:
  explicit Descriptor(int number = -1)
    : Number(number)
  {
  }
  Descriptor(Descriptor&& other) noexcept
    : Number(std::exchange(other.Number, -1))
  {
  }
  Descriptor& operator=(Descriptor&& other) noexcept
  {
    std::swap(this->Number, other.Number);
    return *this;
  }
  ~Descriptor() { this->Close(); }

  int Get() const { return this->Number; }
  bool IsOpen() const { return this->Number >= 0; }
  /// Some file systems report a failed write only here.
  bool Close() { return this->Number < 0 || close(std::exchange(this->Number, -1)) == 0; }

private:
  int Number;
};

} // namespace vol

#endif
