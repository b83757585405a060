// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqDSMLevelWidget_h
#define pqDSMLevelWidget_h

#include "pqPropertyWidget.h" // for superclass

class QComboBox;

/**
 * The list of a reader's levels of detail with their sizes, for the integer property that chooses one (panel_widget
 * "DSMLevel"). The reader's property LevelNames has a line for each level, in order. The application's thread.
 */
class pqDSMLevelWidget : public pqPropertyWidget
{
  Q_OBJECT
  Q_PROPERTY(int level READ GetLevel WRITE SetLevel NOTIFY LevelChosen)

public:
  pqDSMLevelWidget(vtkSMProxy* reader, vtkSMProperty* level, QWidget* parent = nullptr);
  ~pqDSMLevelWidget() override;

  int GetLevel() const;
  /// A level that the file lacks has an entry, too, as long as it is chosen.
  void SetLevel(int level);

Q_SIGNALS:
  /// By the user.
  void LevelChosen();

private Q_SLOTS:
  /// The reader has other levels.
  void Fill();

private:
  void Fill(int level);

  QComboBox* List;
};

#endif
