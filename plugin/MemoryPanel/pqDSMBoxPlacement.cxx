// SPDX-License-Identifier: BSD-3-Clause
#include "pqDSMBoxPlacement.h"

#include "pqPropertyWidget.h"
#include "vtkSMProxy.h"

#include <QAbstractButton>
#include <QCoreApplication>
#include <QEvent>

pqDSMBoxPlacement::pqDSMBoxPlacement(QObject* parent)
  : QObject(parent)
{
}

pqDSMBoxPlacement::~pqDSMBoxPlacement() = default;

void pqDSMBoxPlacement::OnStartup()
{
  QCoreApplication::instance()->installEventFilter(this);
}

void pqDSMBoxPlacement::OnShutdown()
{
  QCoreApplication::instance()->removeEventFilter(this);
}

bool pqDSMBoxPlacement::eventFilter(QObject* watched, QEvent* event)
{
  if (event->type() != QEvent::Polish || !watched->inherits("pqBoxPropertyWidget"))
  {
    return false;
  }
  auto* const box = qobject_cast<pqPropertyWidget*>(watched);
  if (!box || !box->proxy() || !box->proxy()->GetProperty("DSMCroppingBox"))
  {
    return false;
  }
  // After the widget's own slots, which pass on what has changed.
  const auto place = [box] { QMetaObject::invokeMethod(box, "placeWidget", Qt::QueuedConnection); };
  auto* const uses = box->findChild<QAbstractButton*>("useReferenceBounds");
  auto* const reset = box->findChild<QAbstractButton*>("resetBounds");
  if (uses && reset && !uses->isHidden()) // that of Transforming has none
  {
    QObject::connect(uses, &QAbstractButton::toggled, box, place);
    QObject::connect(reset, &QAbstractButton::clicked, box, place);
  }
  return false;
}
