// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqDSMRankOrder_h
#define pqDSMRankOrder_h

#include <QSortFilterProxyModel> // for superclass

/// Puts the rows of a pqDSMRankTable in order by value; the sum stays at the bottom.
class pqDSMRankOrder : public QSortFilterProxyModel
{
  Q_OBJECT

public:
  explicit pqDSMRankOrder(QObject* parent);

protected:
  bool lessThan(const QModelIndex& left, const QModelIndex& right) const override;
};

#endif
