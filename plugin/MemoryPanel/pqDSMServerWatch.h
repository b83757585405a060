// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqDSMServerWatch_h
#define pqDSMServerWatch_h

#include <QObject>

class pqServer;

/// Makes a server that the application connects to load DSMRayTracer, by name, if it is on the server's plugin
/// search paths: ParaView itself does this only for the first one of --plugins. If the plugin is missing there,
/// nothing happens, and ParaView asks for it. The application's thread.
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
};

#endif
