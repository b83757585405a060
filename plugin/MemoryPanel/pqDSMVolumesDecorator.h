// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqDSMVolumesDecorator_h
#define pqDSMVolumesDecorator_h

#include <pqPropertyWidgetDecorator.h>

/// Shows a property of a display where the dataset has blocks that are image data, rectilinear, structured,
/// unstructured or hyper tree grids. The application's thread.
class pqDSMVolumesDecorator : public pqPropertyWidgetDecorator
{
  Q_OBJECT

public:
  pqDSMVolumesDecorator(vtkPVXMLElement* config, pqPropertyWidget* parent);
  ~pqDSMVolumesDecorator() override;

  bool canShowWidget(bool isAdvanced) const override;
};

#endif
