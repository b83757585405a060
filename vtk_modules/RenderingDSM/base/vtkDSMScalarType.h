// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMScalarType_h
#define vtkDSMScalarType_h

#include "DSMBricks/base/ScalarType.h"

class vtkDataArray;

/// Which of the tracer's scalar types an array's values have.
namespace vtkDSMScalarType
{
/// By size, sign and kind, so that long, long long and vtkIdType need no cases.
bricks::ScalarType FromArray(vtkDataArray* array);
}

#endif
