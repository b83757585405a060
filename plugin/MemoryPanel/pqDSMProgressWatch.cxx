// SPDX-License-Identifier: BSD-3-Clause
#include "pqDSMProgressWatch.h"

#include "pqApplicationCore.h"
#include "pqCoreUtilities.h"
#include "pqServerManagerModel.h"
#include "pqView.h"
#include "vtkCommand.h"
#include "vtkSMProxy.h"

#include <QMainWindow>
#include <QStatusBar>

pqDSMProgressWatch::pqDSMProgressWatch(QObject* parent)
  : QObject(parent)
{
}

pqDSMProgressWatch::~pqDSMProgressWatch() = default;

void pqDSMProgressWatch::OnStartup()
{
  auto* const model = pqApplicationCore::instance()->getServerManagerModel();
  QObject::connect(model, &pqServerManagerModel::viewAdded, this, &pqDSMProgressWatch::Watch);
  for (pqView* const view : model->findItems<pqView*>())
  {
    this->Watch(view);
  }
}

void pqDSMProgressWatch::OnShutdown() {}

void pqDSMProgressWatch::Watch(pqView* view)
{
  view->getProxy()->AddObserver(vtkCommand::ProgressEvent, this, &pqDSMProgressWatch::OnProgress);
}

void pqDSMProgressWatch::OnProgress(vtkObject*, unsigned long, void* state)
{
  auto* const window = qobject_cast<QMainWindow*>(pqCoreUtilities::mainWidget());
  if (!window || !state)
  {
    return;
  }
  const auto* const numbers =
    static_cast<const double*>(state); // as vtkPVDSMFrameReport::GetRefinement
  const auto percent = static_cast<int>(100.0 * numbers[2]);
  if (numbers[2] >= 1.0)
  {
    window->statusBar()->clearMessage();
  }
  else if (numbers[1] > 1.0)
  {
    window->statusBar()->showMessage(
      this->tr("Ray tracing: %1 of %2 samples, %3 %").arg(numbers[0]).arg(numbers[1]).arg(percent));
  }
  else
  {
    window->statusBar()->showMessage(this->tr("Ray tracing: %1 %").arg(percent));
  }
}
