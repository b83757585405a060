// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqDSMMemoryPanel_h
#define pqDSMMemoryPanel_h

#include <QDockWidget> // for superclass
#include <QPointer>    // for ivars
#include <QString>     // for ivars
#include <QTimer>      // for ivars

class QLabel;
class QTableView;
class pqDSMRankTable;
class pqView;
class vtkObject;
class vtkSMProxy;

/**
 * View > Ray Tracing Memory: what each rank holds, and what it did for the last still picture of the active view.
 * Hidden at first; while it is hidden it watches nothing and asks nothing. In ParaView's client, on its only
 * thread with a user interface.
 */
class pqDSMMemoryPanel : public QDockWidget
{
  Q_OBJECT
  /// For test players, which read properties: rows without the sum, the words above the table,
  /// and so on.
  Q_PROPERTY(int ranks READ GetNumberOfRanks)
  Q_PROPERTY(bool traced READ IsTraced)
  Q_PROPERTY(QString words READ GetWords)
  Q_PROPERTY(bool beside READ IsTab)

public:
  explicit pqDSMMemoryPanel(QWidget* parent = nullptr);
  ~pqDSMMemoryPanel() override;

  int GetNumberOfRanks() const;
  /// Returns whether the totals show that rays met bricks.
  bool IsTraced() const;
  QString GetWords() const;
  /// Returns whether the panel is a tab beside another dock.
  bool IsTab() const;

private:
  /// Beside the application's other docks at the bottom.
  void BecomeTab();
  void Watch(pqView* view);
  void OnVisibilityChanged(bool visible);
  void OnActiveViewChanged(pqView* view);
  void OnRendered(vtkObject*, unsigned long, void* interactive);
  /// Asks the server, once the application has nothing else to do.
  void Update();
  /// A display of the view that is traced; null without one.
  vtkSMProxy* FindTraced() const;

  QLabel* Words;
  QTableView* Table;
  pqDSMRankTable* Ranks;
  QTimer Soon;
  QPointer<QDockWidget> Neighbor; ///< that it became a tab beside
  QPointer<pqView> View;
  unsigned long Observer = 0;
};

#endif
