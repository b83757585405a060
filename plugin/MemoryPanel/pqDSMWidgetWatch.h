// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqDSMWidgetWatch_h
#define pqDSMWidgetWatch_h

#include <QObject>

/// Corrects ParaView's own widgets when they are shown for the first time. The application's thread.
/// - The cropping box of a display: ParaView draws it relative to where it was placed last, and does not place it anew
///   when *Use Reference Bounds* is toggled, or the bounds are reset. Here it is placed.
/// - The widgets in the view of a display, such as that box: each mouse move was an undo step. Here a drag is one.
/// - The isovalue: in a panel of ordinary width its slider had 25 pixels. Here it gets those of the button that
///   multiplies the value. Its reset button was green from the start. Here it is plain while the isovalue is
///   automatic.
/// - The list of isovalues: it told the range of the values once more, below the property that does. Here it does not.
/// - The settings dialog: its pages are in the order of their proxies' names, and it opens on the first one, which
///   is the plugin's. Here it opens on the next one, *General*.
class pqDSMWidgetWatch : public QObject
{
  Q_OBJECT

public:
  explicit pqDSMWidgetWatch(QObject* parent = nullptr);
  ~pqDSMWidgetWatch() override;

  // Interface of an auto start plugin.
  void OnStartup();
  void OnShutdown();

  /// Event filter of the application.
  bool eventFilter(QObject* watched, QEvent* event) override;
};

#endif
