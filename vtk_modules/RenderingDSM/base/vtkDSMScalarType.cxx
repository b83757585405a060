// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMScalarType.h"

#include "vtkDataArray.h"

bricks::ScalarType vtkDSMScalarType::FromArray(vtkDataArray* array)
{
  const int type = array->GetDataType();
  if (type == VTK_FLOAT || type == VTK_DOUBLE)
  {
    return type == VTK_FLOAT ? bricks::ScalarType::Float32 : bricks::ScalarType::Float64;
  }
  const bool isSigned = array->GetDataTypeMin() < 0.0;
  switch (array->GetDataTypeSize())
  {
    case 1:
      return isSigned ? bricks::ScalarType::Int8 : bricks::ScalarType::UInt8;
    case 2:
      return isSigned ? bricks::ScalarType::Int16 : bricks::ScalarType::UInt16;
    case 4:
      return isSigned ? bricks::ScalarType::Int32 : bricks::ScalarType::UInt32;
    default:
      return isSigned ? bricks::ScalarType::Int64 : bricks::ScalarType::UInt64;
  }
}
