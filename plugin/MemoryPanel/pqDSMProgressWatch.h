// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqDSMProgressWatch_h
#define pqDSMProgressWatch_h

#include <QObject>

class pqView;
class vtkObject;

/// Shows in the status bar how far a picture is that is traced while the application handles events: the same for one
/// that a server traces. The application's thread.
class pqDSMProgressWatch : public QObject
{
  Q_OBJECT

public:
  explicit pqDSMProgressWatch(QObject* parent = nullptr);
  ~pqDSMProgressWatch() override;

  // Interface of an auto start plugin.
  void OnStartup();
  void OnShutdown();

private:
  void Watch(pqView* view);
  void OnProgress(vtkObject* view, unsigned long event, void* state);
};

#endif
