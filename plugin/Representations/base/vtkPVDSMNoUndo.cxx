// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMNoUndo.h"

#include "vtkSMProxyManager.h"
#include "vtkSMUndoStackBuilder.h"

vtkPVDSMNoUndo::vtkPVDSMNoUndo()
  : Builder(vtkSMProxyManager::GetProxyManager()->GetUndoStackBuilder())
  , Before(this->Builder && this->Builder->GetIgnoreAllChanges())
{
  if (this->Builder)
  {
    this->Builder->SetIgnoreAllChanges(true);
  }
}

vtkPVDSMNoUndo::~vtkPVDSMNoUndo()
{
  if (this->Builder)
  {
    this->Builder->SetIgnoreAllChanges(this->Before);
  }
}
