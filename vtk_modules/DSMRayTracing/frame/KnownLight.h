// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_KnownLight_h
#define rt_KnownLight_h

namespace rt
{

/// Result of light rays at a translucent surface of a path. The surfaces behind it borrow this
/// value as long as they contribute little to the path together: a ray from each of many sheets
/// costs more than it shows.
///
/// Has no value until Set; trivial, so that paths cost nothing where it is not used.
template <class T>
class KnownLight
{
public:
  void Set(const T& value)
  {
    this->Value = value;
    this->Borrowed = 0.0;
  }

  /// Returns whether the next surface may borrow the value. `contribution`: the largest color, in
  /// [0, 1], that the path gets from this light at that surface.
  bool Lend(double contribution)
  {
    this->Borrowed += contribution;
    return this->Borrowed < Largest;
  }

  const T& Get() const { return this->Value; }

private:
  /// Sum of contributions: bounds the error to eight steps of an 8-bit channel.
  static constexpr double Largest = 8.0 / 255.0;

  T Value;
  double Borrowed;
};

} // namespace rt

#endif
