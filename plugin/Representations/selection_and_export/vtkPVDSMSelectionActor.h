// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMSelectionActor_h
#define vtkPVDSMSelectionActor_h

#include "vtkOpenGLActor.h"

class vtkPropCollection;

/// What selections see of a dataset that is traced. Exporters do not: they have vtkPVDSMExportProp.
class vtkPVDSMSelectionActor : public vtkOpenGLActor
{
public:
  static vtkPVDSMSelectionActor* New();
  vtkTypeMacro(vtkPVDSMSelectionActor, vtkOpenGLActor);

  void GetActors(vtkPropCollection*) override {}

protected:
  vtkPVDSMSelectionActor();
  ~vtkPVDSMSelectionActor() override;

private:
  vtkPVDSMSelectionActor(const vtkPVDSMSelectionActor&) = delete;
  void operator=(const vtkPVDSMSelectionActor&) = delete;
};

#endif
