// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMNoUndo_h
#define vtkPVDSMNoUndo_h

class vtkSMUndoStackBuilder;

/// While it lives, no change of a property becomes a step of its own for the user to undo. The client's thread.
class vtkPVDSMNoUndo
{
public:
  vtkPVDSMNoUndo();
  ~vtkPVDSMNoUndo();
  vtkPVDSMNoUndo(const vtkPVDSMNoUndo&) = delete;
  vtkPVDSMNoUndo& operator=(const vtkPVDSMNoUndo&) = delete;

private:
  vtkSMUndoStackBuilder* Builder; ///< null outside of the application
  bool Before;
};

#endif
