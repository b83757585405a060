// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMSelectionActor.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkPVDSMSelectionActor);

vtkPVDSMSelectionActor::vtkPVDSMSelectionActor() = default;
vtkPVDSMSelectionActor::~vtkPVDSMSelectionActor() = default;
