// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqDSMRankTable_h
#define pqDSMRankTable_h

#include <QAbstractTableModel> // for superclass
#include <QJsonArray>          // for ivars

/**
 * Table of what each rank holds and did for a frame: a row for each rank, and below them their sum. It is made from
 * the JSON of vtkDSMStatistics, whose keys are the columns' contents. Memory is in MiB.
 */
class pqDSMRankTable : public QAbstractTableModel
{
  Q_OBJECT

public:
  /// Role of a cell's value for sorting rows; the text of a cell is its DisplayRole.
  static constexpr int ValueRole = Qt::UserRole;
  /// The only column of names that may be long.
  static constexpr int HostColumn = 1;

  explicit pqDSMRankTable(QObject* parent);

  /// One object for each rank; none: no frame.
  void SetRanks(const QJsonArray& ranks);
  int GetNumberOfRanks() const { return this->Ranks.size(); }
  /// Returns whether the row is the ranks' total. It stays below them in any sort order.
  bool IsTotal(int row) const { return row == this->Ranks.size(); }

  int rowCount(const QModelIndex& parent = QModelIndex()) const override;
  int columnCount(const QModelIndex& parent = QModelIndex()) const override;
  QVariant data(const QModelIndex& index, int role = Qt::DisplayRole) const override;
  QVariant headerData(
    int section, Qt::Orientation orientation, int role = Qt::DisplayRole) const override;

private:
  QVariant GetValue(int row, int column) const;

  QJsonArray Ranks;
};

#endif
