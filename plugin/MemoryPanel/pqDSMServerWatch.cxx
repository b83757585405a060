// SPDX-License-Identifier: BSD-3-Clause
#include "pqDSMServerWatch.h"

#include "pqApplicationCore.h"
#include "pqCoreUtilities.h"
#include "pqSaveStateReaction.h"
#include "pqServer.h"
#include "pqServerManagerModel.h"
#include "pqSettings.h"
#include "pqView.h"
#include "vtkClientSocket.h"
#include "vtkMultiProcessController.h"
#include "vtkNetworkAccessManager.h"
#include "vtkOutputWindow.h"
#include "vtkPVPluginsInformation.h"
#include "vtkProcessModule.h"
#include "vtkSMPluginManager.h"
#include "vtkSMProxyManager.h"
#include "vtkSMSession.h"
#include "vtkSocketCommunicator.h"

#include <QDateTime>
#include <QDir>
#include <QPixmap>
#include <QWidget>

#include <poll.h>

#include <cstring>
#include <string>

namespace
{

constexpr const char* Plugin = "DSMRayTracer";

/// Milliseconds from one look at the connection to the next.
constexpr int LookInterval = 500;

/// Priority of an observer that is before all others.
constexpr float FirstOfAll = 100.0f;

bool IsLoaded(vtkPVPluginsInformation* plugins)
{
  for (unsigned int number = 0; plugins && number < plugins->GetNumberOfPlugins(); ++number)
  {
    if (std::strcmp(plugins->GetPluginName(number), Plugin) == 0)
    {
      return plugins->GetPluginLoaded(number);
    }
  }
  return false;
}

/// Returns whether the server has sent something that is not read yet, or has closed its connection.
bool HasSent(vtkSMSession* session)
{
  vtkMultiProcessController* const server = session->GetController(vtkPVSession::DATA_SERVER_ROOT);
  auto* const communicator =
    server ? vtkSocketCommunicator::SafeDownCast(server->GetCommunicator()) : nullptr;
  if (!communicator || !communicator->GetSocket())
  {
    return false;
  }
  pollfd connection{ communicator->GetSocket()->GetSocketDescriptor(), POLLIN, 0 };
  return poll(&connection, 1, 0) > 0;
}

/// Saves the pictures that all views show, with names that begin so.
void SavePictures(const QString& name)
{
  int number = 0;
  for (pqView* view : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqView*>())
  {
    if (QWidget* const shown = view->widget())
    {
      shown->grab().save(name + "-" + QString::number(++number) + ".png");
    }
  }
}

} // namespace

pqDSMServerWatch::pqDSMServerWatch(QObject* parent)
  : QObject(parent)
{
}

pqDSMServerWatch::~pqDSMServerWatch() = default;

void pqDSMServerWatch::OnStartup()
{
  // Before ParaView looks for what the server lacks, which it does when the server has been added.
  pqServerManagerModel* const model = pqApplicationCore::instance()->getServerManagerModel();
  QObject::connect(
    model, &pqServerManagerModel::serverReady, this, &pqDSMServerWatch::OnServerReady);
  QObject::connect(&this->Timer, &QTimer::timeout, this, &pqDSMServerWatch::LookForEnd);
  // The one of --server-url may be there already.
  for (pqServer* server : model->findItems<pqServer*>())
  {
    this->OnServerReady(server);
  }
}

void pqDSMServerWatch::OnShutdown()
{
  this->Timer.stop();
  QObject::disconnect(
    pqApplicationCore::instance()->getServerManagerModel(), nullptr, this, nullptr);
}

void pqDSMServerWatch::OnServerReady(pqServer* server)
{
  vtkSMPluginManager* const plugins = vtkSMProxyManager::GetProxyManager()->GetPluginManager();
  vtkSMSession* const session = server && server->isRemote() ? server->session() : nullptr;
  if (session)
  {
    this->Session = session;
    this->Timer.start(LookInterval);
    // Before ParaView ends the application because of it.
    session->AddObserver(
      vtkPVSessionBase::ConnectionLost, this, &pqDSMServerWatch::OnServerLost, FirstOfAll);
  }
  if (!session || IsLoaded(plugins->GetRemoteInformation(session)))
  {
    return;
  }
  const std::string wish =
    std::string("<Plugins><Plugin name=\"") + Plugin + "\" auto_load=\"1\"/></Plugins>";
  plugins->LoadPluginConfigurationXMLFromString(wish.c_str(), session, true);
}

/// ParaView itself hears of a server's end when it asks for something.
void pqDSMServerWatch::LookForEnd()
{
  vtkSMSession* const session = this->Session;
  if (session && !session->IsMultiClients() && !session->GetPendingProgress() && HasSent(session))
  {
    vtkProcessModule::GetProcessModule()->GetNetworkAccessManager()->ProcessEvents(1);
  }
}

void pqDSMServerWatch::OnServerLost()
{
  if (!this->Session)
  {
    return; // it was lost before
  }
  this->Session = nullptr;
  this->Timer.stop();
  const QString name =
    QDir(pqCoreUtilities::getParaViewUserDirectory())
      .filePath("server-lost-" + QDateTime::currentDateTime().toString("yyyy-MM-dd-hh-mm-ss"));
  SavePictures(name);
  const QString state = name + ".pvsm";
  const bool isSaved = pqSaveStateReaction::saveState(state);
  pqApplicationCore::instance()->settings()->sync(); // ParaView does not when it ends now
  // ParaView shows it beside its question whether to save the state.
  vtkOutputWindowDisplayWarningText(
    (isSaved ? "DSM Ray Tracer saved the state of the lost server in " + state +
          ", and a picture of each view beside it. Start ParaView and a server again, connect, and "
          "choose this state in File > Recent Files."
             : "DSM Ray Tracer cannot save the state of the lost server in " + state + ".")
      .toUtf8()
      .constData());
}
