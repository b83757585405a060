// SPDX-License-Identifier: BSD-3-Clause
#include "pqDSMRankOrder.h"

#include "pqDSMRankTable.h"

pqDSMRankOrder::pqDSMRankOrder(QObject* parent)
  : QSortFilterProxyModel(parent)
{
  this->setSortRole(pqDSMRankTable::ValueRole);
  this->setDynamicSortFilter(true);
}

bool pqDSMRankOrder::lessThan(const QModelIndex& left, const QModelIndex& right) const
{
  const auto* table = static_cast<const pqDSMRankTable*>(this->sourceModel());
  const bool isLeftTotal = table->IsTotal(left.row());
  if (isLeftTotal || table->IsTotal(right.row()))
  {
    // Descending order turns the answer round.
    return isLeftTotal == (this->sortOrder() == Qt::DescendingOrder);
  }
  return this->QSortFilterProxyModel::lessThan(left, right);
}
