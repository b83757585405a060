// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqDSMBoxPlacement_h
#define pqDSMBoxPlacement_h

#include <QObject>

/// The cropping boxes of our displays, in the view: ParaView's widget draws a box of its own relative to where it was
/// placed last, and does not place it anew where *Use Reference Bounds* is ticked or not, or its bounds are reset. Here
/// it is told to. The application's thread.
class pqDSMBoxPlacement : public QObject
{
  Q_OBJECT

public:
  explicit pqDSMBoxPlacement(QObject* parent = nullptr);
  ~pqDSMBoxPlacement() override;

  // Of an auto start plugin.
  void OnStartup();
  void OnShutdown();

  /// Of the application: hears of widgets that are shown for the first time.
  bool eventFilter(QObject* watched, QEvent* event) override;
};

#endif
