// SPDX-License-Identifier: BSD-3-Clause
#include "pqDSMWidgetWatch.h"

#include "pqDoubleRangeWidget.h"
#include "pqDoubleVectorPropertyWidget.h"
#include "pqHighlightableToolButton.h"
#include "pqInteractivePropertyWidget.h"
#include "pqScaleByButton.h"
#include "pqUndoStack.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"

#include <QAbstractButton>
#include <QCoreApplication>
#include <QEvent>
#include <QLabel>
#include <QSlider>
#include <QTabBar>

namespace
{

constexpr int LeastSliderWidth = 60;                ///< pixels
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

/// ParaView makes the reset button green when the range changes, as it does when the data have been shown.
void KeepResetButtonPlain(const pqDoubleVectorPropertyWidget* isovalue)
{
  auto* const button = isovalue->findChild<pqHighlightableToolButton*>("Reset");
  vtkSMProperty* const automatic = isovalue->proxy()->GetProperty("DSMIsoValueAutomatic");
  if (!button || !automatic)
  {
    return;
  }
  const auto clear = [button, automatic]
  {
    if (vtkSMPropertyHelper(automatic).GetAsInt() != 0)
    {
      button->clear();
    }
  };
  QObject::connect(isovalue, &pqDoubleVectorPropertyWidget::highlightResetButton, button, clear);
  clear();
}

/// Makes the isovalue's slider wide enough to drag, and hides the multiply button beside it.
void WidenSlider(const pqPropertyWidget* isovalue)
{
  auto* const range = isovalue->findChild<pqDoubleRangeWidget*>();
  auto* const slider = range ? range->findChild<QSlider*>() : nullptr;
  auto* const scale = isovalue->findChild<pqScaleByButton*>();
  if (slider && scale)
  {
    slider->setMinimumWidth(LeastSliderWidth);
    scale->hide();
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
  const auto* const ofProperty = qobject_cast<pqPropertyWidget*>(watched);
  const auto isOf = [ofProperty](const char* name)
  {
    return ofProperty && ofProperty->property() && ofProperty->proxy() &&
      ofProperty->property() == ofProperty->proxy()->GetProperty(name);
  };
  if (isOf("DSMIsoValue"))
  {
    WidenSlider(ofProperty);
    if (const auto* const number = qobject_cast<const pqDoubleVectorPropertyWidget*>(ofProperty))
    {
      KeepResetButtonPlain(number);
    }
  }
  auto* const range =
    isOf("DSMIsoValues") ? ofProperty->findChild<QLabel*>("ScalarRangeLabel") : nullptr;
  if (range)
  {
    range->hide();
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
