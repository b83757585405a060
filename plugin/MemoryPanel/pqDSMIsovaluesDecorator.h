// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqDSMIsovaluesDecorator_h
#define pqDSMIsovaluesDecorator_h

#include <pqPropertyWidgetDecorator.h>

/// Shows the single isovalue, or, where the list has any, the list. Advanced panels show both, with the single one
/// disabled while the list counts, so that nothing moves when the list's first value is added. For the widgets of both,
/// and of what belongs to the single one. The application's thread.
class pqDSMIsovaluesDecorator : public pqPropertyWidgetDecorator
{
  Q_OBJECT

public:
  pqDSMIsovaluesDecorator(vtkPVXMLElement* config, pqPropertyWidget* parent);
  ~pqDSMIsovaluesDecorator() override;

  bool canShowWidget(bool isAdvanced) const override;
  bool enableWidget() const override;

private:
  bool IsOfList() const;
  /// In the panel.
  bool HasValues() const;
};

#endif
