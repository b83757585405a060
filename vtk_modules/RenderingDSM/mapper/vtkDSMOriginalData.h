// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMOriginalData_h
#define vtkDSMOriginalData_h

#include "vtkDataObject.h"
#include "vtkWeakPointer.h"

#include <algorithm>

/// Original data of a mapper's input, and their time; keeps nothing alive. Local.
class vtkDSMOriginalData
{
public:
  void Set(vtkDataObject* data)
  {
    this->Data = data;
    this->Time = data ? GetTime(data) : 0;
  }
  /// Null if they are gone, or unknown.
  vtkDataObject* Get() const { return this->Data; }
  /// Returns whether the original data have changed. False if unknown.
  bool HasChanged() const
  {
    return this->Time > 0 && (!this->Data || GetTime(this->Data) != this->Time);
  }

private:
  static vtkMTimeType GetTime(vtkDataObject* data)
  {
    return std::max(data->GetMTime(), data->GetUpdateTime());
  }

  vtkWeakPointer<vtkDataObject> Data;
  vtkMTimeType Time = 0;
};

#endif
