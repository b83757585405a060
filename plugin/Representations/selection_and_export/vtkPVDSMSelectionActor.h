// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMSelectionActor_h
#define vtkPVDSMSelectionActor_h

#include "vtkOpenGLActor.h"

class vtkPropCollection;

/// Actor of a traced dataset for selections. Exporters do not see it: they use vtkPVDSMExportProp.
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
