// SPDX-License-Identifier: BSD-3-Clause
#include "pqDSMWidgetWatch.h"

#include "pqInteractivePropertyWidget.h"
#include "pqUndoStack.h"
#include "vtkSMProxy.h"

#include <QAbstractButton>
#include <QCoreApplication>
#include <QEvent>
#include <QTabBar>

namespace
{

constexpr const char* PageTitle = "DSM Ray Tracer"; ///< dsm_settings.xml

/// Has one undo step for each drag of a widget, which owns it.
class UndoStep : public QObject
{
public:
  explicit UndoStep(pqInteractivePropertyWidget* widget)
    : QObject(widget)
  {
    QObject::connect(
      widget, &pqInteractivePropertyWidget::startInteraction, this, [this] { this->Begin(); });
    // After what the widget still has to apply.
    QObject::connect(
      widget, &pqInteractivePropertyWidget::endInteraction, this, [this] { this->End(); },
      Qt::QueuedConnection);
  }
  ~UndoStep() override { this->End(); }

private:
  void Begin()
  {
    if (!this->IsOpen)
    {
      this->IsOpen = true;
      BEGIN_UNDO_SET("Drag");
    }
  }
  void End()
  {
    if (this->IsOpen)
    {
      this->IsOpen = false;
      END_UNDO_SET();
    }
  }

  bool IsOpen = false;
};

void PlaceAgain(pqInteractivePropertyWidget* box)
{
  // After the widget's own slots, which pass on what has changed.
  const auto place = [box] { QMetaObject::invokeMethod(box, "placeWidget", Qt::QueuedConnection); };
  auto* const uses = box->findChild<QAbstractButton*>("useReferenceBounds");
  auto* const reset = box->findChild<QAbstractButton*>("resetBounds");
  if (uses && reset && !uses->isHidden()) // that of Transforming has none
  {
    QObject::connect(uses, &QAbstractButton::toggled, box, place);
    QObject::connect(reset, &QAbstractButton::clicked, box, place);
  }
}

void OpenOnGeneral(QTabBar* pages)
{
  if (pages && pages->count() > 1 && pages->tabText(0) == PageTitle)
  {
    pages->setCurrentIndex(1);
  }
}

} // namespace

pqDSMWidgetWatch::pqDSMWidgetWatch(QObject* parent)
  : QObject(parent)
{
}

pqDSMWidgetWatch::~pqDSMWidgetWatch() = default;

void pqDSMWidgetWatch::OnStartup()
{
  QCoreApplication::instance()->installEventFilter(this);
}

void pqDSMWidgetWatch::OnShutdown()
{
  QCoreApplication::instance()->removeEventFilter(this);
}

bool pqDSMWidgetWatch::eventFilter(QObject* watched, QEvent* event)
{
  if (event->type() != QEvent::Polish)
  {
    return false;
  }
  if (watched->inherits("pqSettingsDialog"))
  {
    OpenOnGeneral(watched->findChild<QTabBar*>("tabBar"));
  }
  auto* const widget = qobject_cast<pqInteractivePropertyWidget*>(watched);
  if (widget && widget->proxy() && widget->proxy()->GetProperty("DSMCroppingBox"))
  {
    new UndoStep(widget);
    if (widget->inherits("pqBoxPropertyWidget"))
    {
      PlaceAgain(widget);
    }
  }
  return false;
}
