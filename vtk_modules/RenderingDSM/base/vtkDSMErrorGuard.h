// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMErrorGuard_h
#define vtkDSMErrorGuard_h

#include "vtkObject.h"

#include <exception>
#include <new>

/// Keeps exceptions from VTK and ParaView, where they would end the process. For the bodies of requests.
class vtkDSMErrorGuard
{
public:
  /// Calls work(). Returns what it returns, or 0 when it throws: then `self` reports the error. `doing` and `name`
  /// ("reading", the file's name) complete the sentence where memory runs out, which says nothing itself.
  template <class Work>
  static int Run(vtkObject* self, const char* doing, const char* name, const Work& work)
  {
    try
    {
      return work();
    }
    catch (const std::bad_alloc&)
    {
      vtkErrorWithObjectMacro(self, << "Out of memory while " << doing << " '" << name << "'.");
    }
    catch (const std::exception& error)
    {
      vtkErrorWithObjectMacro(self, << error.what());
    }
    catch (...)
    {
      vtkErrorWithObjectMacro(self, << "An unknown error while " << doing << " '" << name << "'.");
    }
    return 0;
  }
};

#endif
