// SPDX-License-Identifier: BSD-3-Clause
#include "pqDSMMemoryPanel.h"

#include "pqDSMRankOrder.h"
#include "pqDSMRankTable.h"

#include "pqActiveObjects.h"
#include "pqServer.h"
#include "pqView.h"
#include "vtkCommand.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkSMViewProxy.h"

#include <QAction>
#include <QHeaderView>
#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>
#include <QLabel>
#include <QMainWindow>
#include <QTableView>
#include <QVBoxLayout>

#include <cstring>

namespace
{

/// While a picture is refined, it is rendered several times a second.
constexpr int MillisecondsToWait = 200;

/// As large whatever its text says: another hint would resize the view, which would be traced again.
class Body : public QWidget
{
public:
  using QWidget::QWidget;
  QSize sizeHint() const override { return QSize(256, 240); }
};

} // namespace

pqDSMMemoryPanel::pqDSMMemoryPanel(QWidget* parent)
  : QDockWidget(parent)
{
  this->setWindowTitle(this->tr("Ray Tracing Memory"));
  auto* body = new Body(this);
  this->Words = new QLabel(body);
  this->Words->setObjectName("words");
  this->Words->setWordWrap(true);
  // A text of more lines takes room from the table.
  QSizePolicy policy(QSizePolicy::Ignored, QSizePolicy::Ignored);
  policy.setHeightForWidth(true);
  this->Words->setSizePolicy(policy);
  this->Words->setMinimumHeight(2 * this->Words->fontMetrics().lineSpacing());
  this->Words->setTextInteractionFlags(Qt::TextSelectableByMouse);
  this->Ranks = new pqDSMRankTable(this);
  auto* order = new pqDSMRankOrder(this);
  order->setSourceModel(this->Ranks);
  this->Table = new QTableView(body);
  this->Table->setObjectName("table");
  this->Table->setModel(order);
  this->Table->setSelectionBehavior(QAbstractItemView::SelectRows);
  this->Table->setAlternatingRowColors(true);
  this->Table->verticalHeader()->hide();
  this->Table->setSortingEnabled(true);
  this->Table->sortByColumn(0, Qt::AscendingOrder);
  // Names of hosts may be long: their column takes the room that the numbers leave.
  this->Table->horizontalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
  this->Table->horizontalHeader()->setSectionResizeMode(
    pqDSMRankTable::HostColumn, QHeaderView::Stretch);
  auto* layout = new QVBoxLayout(body);
  layout->addWidget(this->Words);
  layout->addWidget(this->Table, 1);
  this->setWidget(body);

  this->Soon.setSingleShot(true);
  this->Soon.setInterval(MillisecondsToWait);
  QObject::connect(&this->Soon, &QTimer::timeout, this, &pqDSMMemoryPanel::Update);
  QObject::connect(this->toggleViewAction(), &QAction::triggered, this, &QWidget::raise);
  QObject::connect(
    this, &QDockWidget::visibilityChanged, this, &pqDSMMemoryPanel::OnVisibilityChanged);
  QObject::connect(&pqActiveObjects::instance(), &pqActiveObjects::viewChanged, this,
    &pqDSMMemoryPanel::OnActiveViewChanged);
  this->hide();
  // As soon as the application has placed it, and while it is hidden: beside others it could widen the window.
  QTimer::singleShot(0, this, &pqDSMMemoryPanel::BecomeTab);
}

pqDSMMemoryPanel::~pqDSMMemoryPanel()
{
  this->Watch(nullptr);
}

int pqDSMMemoryPanel::GetNumberOfRanks() const
{
  return this->Ranks->GetNumberOfRanks();
}

bool pqDSMMemoryPanel::IsTraced() const
{
  const int total = this->Ranks->rowCount() - 1;
  for (int column = 0; total > 0 && column < this->Ranks->columnCount(); ++column)
  {
    if (this->Ranks->headerData(column, Qt::Horizontal).toString() == this->tr("Hits"))
    {
      return this->Ranks->index(total, column).data(pqDSMRankTable::ValueRole).toDouble() > 0.0;
    }
  }
  return false;
}

QString pqDSMMemoryPanel::GetWords() const
{
  return this->Words->text();
}

bool pqDSMMemoryPanel::IsTab() const
{
  // Newer Qt does not count docks that are hidden among those that share a place.
  const auto* const window = qobject_cast<QMainWindow*>(this->parentWidget());
  auto* const panel = const_cast<pqDSMMemoryPanel*>(this);
  return window && this->Neighbor &&
    (window->tabifiedDockWidgets(panel).contains(this->Neighbor) ||
      (!this->Neighbor->isVisible() &&
        window->dockWidgetArea(this->Neighbor) == window->dockWidgetArea(panel)));
}

void pqDSMMemoryPanel::BecomeTab()
{
  auto* const window = qobject_cast<QMainWindow*>(this->parentWidget());
  const auto area = window ? window->dockWidgetArea(this) : Qt::NoDockWidgetArea;
  if (area == Qt::NoDockWidgetArea)
  {
    return;
  }
  QDockWidget* neighbor = nullptr;
  for (auto* dock : window->findChildren<QDockWidget*>())
  {
    const bool isBeside =
      dock != this && !dock->isFloating() && window->dockWidgetArea(dock) == area;
    if (isBeside && (!neighbor || dock->isVisible()))
    {
      neighbor = dock;
    }
  }
  if (neighbor)
  {
    window->tabifyDockWidget(neighbor, this);
    this->Neighbor = neighbor;
  }
}

void pqDSMMemoryPanel::Watch(pqView* view)
{
  if (this->Observer != 0 && this->View)
  {
    this->View->getProxy()->RemoveObserver(this->Observer);
  }
  this->Observer = 0;
  this->View = view;
  if (view)
  {
    this->Observer =
      view->getProxy()->AddObserver(vtkCommand::EndEvent, this, &pqDSMMemoryPanel::OnRendered);
  }
}

void pqDSMMemoryPanel::OnVisibilityChanged(bool visible)
{
  this->Watch(visible ? pqActiveObjects::instance().activeView() : nullptr);
  if (visible)
  {
    this->Update();
  }
  else
  {
    this->Soon.stop();
  }
}

void pqDSMMemoryPanel::OnActiveViewChanged(pqView* view)
{
  if (this->isVisible())
  {
    this->Watch(view);
    this->Soon.start();
  }
}

void pqDSMMemoryPanel::OnRendered(vtkObject*, unsigned long, void* interactive)
{
  if (!(interactive && *static_cast<int*>(interactive)) && !this->Soon.isActive())
  {
    this->Soon.start();
  }
}

vtkSMProxy* pqDSMMemoryPanel::FindTraced() const
{
  vtkSMProxy* view = this->View ? this->View->getProxy() : nullptr;
  if (!view || !view->GetProperty("Representations"))
  {
    return nullptr;
  }
  const vtkSMPropertyHelper displays(view, "Representations");
  for (unsigned int number = 0; number < displays.GetNumberOfElements(); ++number)
  {
    vtkSMProxy* display = displays.GetAsProxy(number);
    if (display && display->GetProperty("DSMStatistics") &&
      vtkSMPropertyHelper(display, "Visibility", true).GetAsInt() != 0 &&
      std::strncmp(vtkSMPropertyHelper(display, "Representation", true).GetAsString(), "DSM ", 4) ==
        0)
    {
      return display;
    }
  }
  return nullptr;
}

void pqDSMMemoryPanel::Update()
{
  pqServer* const server = this->View ? this->View->getServer() : nullptr;
  if (server && (server->isProgressPending() || server->isProcessingPending()))
  {
    this->Soon.start();
    return;
  }
  vtkSMProxy* const display = this->FindTraced();
  QJsonArray ranks;
  if (display)
  {
    display->UpdatePropertyInformation(display->GetProperty("DSMStatistics"));
    const char* const text = vtkSMPropertyHelper(display, "DSMStatistics").GetAsString();
    ranks = QJsonDocument::fromJson(QByteArray(text)).array();
  }
  this->Ranks->SetRanks(ranks);
  this->Table->setEnabled(!ranks.isEmpty());
  const QString words = !ranks.isEmpty() ? ranks.first().toObject().value("Explanation").toString()
    : display                            ? this->tr("This view has no traced picture yet.")
              : this->tr("The active view has no DSM Ray Traced datasets.");
  this->Words->setText(words);
}
