// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMProgressGuard.h"

#include "vtkCommand.h"
#include "vtkObjectFactory.h"
#include "vtkPVProgressHandler.h"
#include "vtkRenderWindow.h"

namespace
{
/// The application listens between the two.
constexpr float BeforeOthers = 1.0f;
constexpr float AfterOthers = -1.0f;
}

vtkStandardNewMacro(vtkPVDSMProgressGuard);

vtkPVDSMProgressGuard::~vtkPVDSMProgressGuard()
{
  if (this->Handler)
  {
    this->Handler->RemoveObserver(this->First);
    this->Handler->RemoveObserver(this->Last);
  }
}

void vtkPVDSMProgressGuard::Watch(vtkPVProgressHandler* handler, vtkRenderWindow* window)
{
  this->Handler = handler;
  this->Window = window;
  this->First = handler->AddObserver(
    vtkCommand::ProgressEvent, this, &vtkPVDSMProgressGuard::Begin, BeforeOthers);
  this->Last =
    handler->AddObserver(vtkCommand::ProgressEvent, this, &vtkPVDSMProgressGuard::End, AfterOthers);
}

void vtkPVDSMProgressGuard::Begin()
{
  // Events shown within a render must not begin another render; the first one is guarded already.
  // Outside of a render there is nothing to continue, and other drawing of the application stays as
  // it is.
  if (!this->Guard && this->Window && this->Window->CheckInRenderStatus())
  {
    this->Guard.emplace(this->Window);
  }
}

void vtkPVDSMProgressGuard::End()
{
  this->Guard.reset();
}
