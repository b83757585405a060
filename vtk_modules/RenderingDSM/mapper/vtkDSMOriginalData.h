// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMOriginalData_h
#define vtkDSMOriginalData_h

#include "vtkDataObject.h"
#include "vtkWeakPointer.h"

#include <algorithm>

/// What a mapper's input was made from, and when; keeps nothing alive. Local.
class vtkDSMOriginalData
{
public:
  void Set(vtkDataObject* data)
  {
    this->Data = data;
    this->Time = data ? GetTime(data) : 0;
  }
  /// Whether there are other data by now. False where nothing is known.
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
