// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqDSMServerWatch_h
#define pqDSMServerWatch_h

#include "vtkWeakPointer.h"

#include <QObject>
#include <QTimer>

class pqServer;
class vtkSMSession;

/// Makes a server that the application connects to load DSMRayTracer, by name, if it is on the server's plugin
/// search paths: ParaView itself does this only for the first one of --plugins. If the plugin is missing there,
/// nothing happens, and ParaView asks for it.
///
/// When a server ends, the application hears of it at once, and of the reason, if the server sent it
/// (vtkPVDSMRankWatch). Before ParaView asks what to do, the state and the pictures of all views are saved in the
/// user's folder of settings. The application's thread.
class pqDSMServerWatch : public QObject
{
  Q_OBJECT

public:
  explicit pqDSMServerWatch(QObject* parent = nullptr);
  ~pqDSMServerWatch() override;

  // Interface of an auto start plugin.
  void OnStartup();
  void OnShutdown();

private:
  void OnServerReady(pqServer* server);
  void LookForEnd();
  void OnServerLost();

  vtkWeakPointer<vtkSMSession> Session; ///< with the server that was connected last
  QTimer Timer;
};

#endif
