// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_FirstFailure_h
#define dsm_FirstFailure_h

#include <exception>

namespace dsm
{

/// Keeps the first failure of a rank while other ranks depend on it, until the ranks agree again
/// (Messenger::RunTogether). Allocates no memory. One thread.
class FirstFailure
{
public:
  bool IsEmpty() const { return !this->First; }

  template <class Step>
  void Try(const Step& step)
  {
    try
    {
      step();
    }
    catch (...)
    {
      this->Keep(std::current_exception());
    }
  }
  void Keep(std::exception_ptr failure)
  {
    if (!this->First)
    {
      this->First = failure;
    }
  }

  /// Throws it, if there is one.
  void Throw() const
  {
    if (this->First)
    {
      std::rethrow_exception(this->First);
    }
  }

private:
  std::exception_ptr First;
};

} // namespace dsm

#endif
