// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMScalarType.h"

#include "vtkDataArray.h"

rt::ScalarType vtkDSMScalarType::FromArray(vtkDataArray* array)
{
  const int type = array->GetDataType();
  if (type == VTK_FLOAT || type == VTK_DOUBLE)
  {
    return type == VTK_FLOAT ? rt::ScalarType::Float32 : rt::ScalarType::Float64;
  }
  const bool isSigned = array->GetDataTypeMin() < 0.0;
  switch (array->GetDataTypeSize())
  {
    case 1:
      return isSigned ? rt::ScalarType::Int8 : rt::ScalarType::UInt8;
    case 2:
      return isSigned ? rt::ScalarType::Int16 : rt::ScalarType::UInt16;
    case 4:
      return isSigned ? rt::ScalarType::Int32 : rt::ScalarType::UInt32;
    default:
      return isSigned ? rt::ScalarType::Int64 : rt::ScalarType::UInt64;
  }
}
