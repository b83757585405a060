// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqDSMServerWatch_h
#define pqDSMServerWatch_h

#include <QObject>

class pqServer;

/// A server that the application connects to is told to load DSMRayTracer, by its name, where it is on the server's
/// plugin search paths: ParaView tells only the first one of --plugins. Where it is not, nothing happens, and ParaView
/// asks for it. The application's thread.
class pqDSMServerWatch : public QObject
{
  Q_OBJECT

public:
  explicit pqDSMServerWatch(QObject* parent = nullptr);
  ~pqDSMServerWatch() override;

  // Of an auto start plugin.
  void OnStartup();
  void OnShutdown();

private:
  void OnServerReady(pqServer* server);
};

#endif
