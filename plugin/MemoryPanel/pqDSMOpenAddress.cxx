// SPDX-License-Identifier: BSD-3-Clause
#include "pqDSMOpenAddress.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqCoreUtilities.h"
#include "pqObjectBuilder.h"
#include "pqUndoStack.h"

#include <QAction>
#include <QInputDialog>
#include <QStringList>

pqDSMOpenAddress::pqDSMOpenAddress(QObject* parent)
  : QActionGroup(parent)
{
  auto* const action = new QAction(tr("Open URL..."), this);
  action->setObjectName("actionDSMOpenAddress");
  action->setToolTip(tr("Open a Zarr volume on a server (https, http or s3)"));
  this->addAction(action);
  QObject::connect(action, &QAction::triggered, this, [this] { this->Ask(); });
}

void pqDSMOpenAddress::Ask()
{
  QInputDialog dialog(pqCoreUtilities::mainWidget());
  dialog.setObjectName("DSMOpenAddress");
  dialog.setWindowTitle(tr("Open URL"));
  dialog.setLabelText(
    tr("Address of a Zarr volume, such as https://HOST/image.zarr or s3://BUCKET/image.zarr:"));
  dialog.resize(600, dialog.sizeHint().height());
  const bool isAccepted = dialog.exec() == QDialog::Accepted;
  const QString address = dialog.textValue().trimmed();
  pqServer* const server = pqActiveObjects::instance().activeServer();
  if (!isAccepted || address.isEmpty() || !server)
  {
    return;
  }
  BEGIN_UNDO_SET(tr("Open URL"));
  pqApplicationCore::instance()->getObjectBuilder()->createReader(
    "sources", "DSMVolumeReader", QStringList(address), server);
  END_UNDO_SET();
}
