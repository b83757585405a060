// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMErrorGuard_h
#define vtkDSMErrorGuard_h

#include "vtkObject.h"

#include <exception>
#include <new>
#include <string>

/// Keeps exceptions from VTK and ParaView, where they would end the process. For the bodies of requests.
class vtkDSMErrorGuard
{
public:
  /// Calls work(). Returns the message of what it throws, or an empty one. `doing` and `name` ("reading", the file's
  /// name) complete the sentence where memory runs out, which says nothing itself.
  template <class Work>
  static std::string Try(const char* doing, const char* name, const Work& work)
  {
    const auto describe = [&](const char* what)
    { return std::string(what) + " while " + doing + " '" + name + "'."; };
    try
    {
      work();
      return std::string();
    }
    catch (const std::bad_alloc&)
    {
      return describe("Out of memory");
    }
    catch (const std::exception& error)
    {
      return *error.what() ? error.what() : describe("An unknown error");
    }
    catch (...)
    {
      return describe("An unknown error");
    }
  }

  /// The same, but `self` reports the error. Returns what work() returns, or 0 when it throws.
  template <class Work>
  static int Run(vtkObject* self, const char* doing, const char* name, const Work& work)
  {
    int result = 0;
    const std::string failure = Try(doing, name, [&] { result = work(); });
    if (failure.empty())
    {
      return result;
    }
    vtkErrorWithObjectMacro(self, << failure);
    return 0;
  }
};

#endif
