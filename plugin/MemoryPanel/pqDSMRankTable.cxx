// SPDX-License-Identifier: BSD-3-Clause
#include "pqDSMRankTable.h"

#include "vtkDSMCounters.h"

#include <QFont>
#include <QJsonObject>
#include <QLocale>
#include <QStringList>

#include <iterator>

namespace
{

enum class Unit
{
  Name,
  Count,
  Bytes,
  Seconds
};

struct Column
{
  const char* Title;
  Unit Is;
  /// False for memory that the ranks of a host share: each rank shows it, but it exists once on the
  /// host.
  bool HasTotal;
  const char* Description;
  /// Keys of the summands.
  QStringList Keys;
};

#define DSM_COLUMN(title, unit, hasTotal, description, ...)                                        \
  { title, unit, hasTotal, description, { __VA_ARGS__ } },
const Column Columns[] = { { "Rank", Unit::Name, false, "MPI rank.", { "Rank" } },
  { "Host", Unit::Name, false, "Host that runs the rank.", { "Host" } },
  DSM_PANEL_COLUMNS(DSM_COLUMN) };

constexpr int NumberOfColumns = static_cast<int>(std::size(Columns));

QString ToText(const QVariant& value, Unit unit)
{
  const QLocale locale;
  switch (unit)
  {
    case Unit::Count:
      return locale.toString(value.toLongLong());
    case Unit::Bytes:
      return locale.toString(value.toDouble() / (1024.0 * 1024.0), 'f', 1);
    case Unit::Seconds:
      return locale.toString(value.toDouble(), 'f', 3);
    default:
      return value.toString();
  }
}

} // namespace

pqDSMRankTable::pqDSMRankTable(QObject* parent)
  : QAbstractTableModel(parent)
{
}

void pqDSMRankTable::SetRanks(const QJsonArray& ranks)
{
  if (ranks.size() != this->Ranks.size())
  {
    this->beginResetModel();
    this->Ranks = ranks;
    this->endResetModel();
    return;
  }
  // Selection and scroll position of the table stay.
  this->Ranks = ranks;
  if (!ranks.isEmpty())
  {
    Q_EMIT this->dataChanged(
      this->index(0, 0), this->index(this->rowCount() - 1, NumberOfColumns - 1));
  }
}

int pqDSMRankTable::rowCount(const QModelIndex& parent) const
{
  return parent.isValid() || this->Ranks.isEmpty() ? 0 : this->Ranks.size() + 1;
}

int pqDSMRankTable::columnCount(const QModelIndex& parent) const
{
  return parent.isValid() ? 0 : NumberOfColumns;
}

QVariant pqDSMRankTable::GetValue(int row, int number) const
{
  const Column& column = Columns[number];
  if (this->IsTotal(row))
  {
    if (!column.HasTotal)
    {
      return number == 0 ? QVariant(this->tr("All")) : QVariant();
    }
    double sum = 0.0;
    for (int rank = 0; rank < this->Ranks.size(); ++rank)
    {
      sum += this->GetValue(rank, number).toDouble();
    }
    return sum;
  }
  const QJsonObject rank = this->Ranks.at(row).toObject();
  if (column.Is == Unit::Name)
  {
    return rank.value(column.Keys.front()).toVariant();
  }
  double sum = 0.0;
  for (const QString& key : column.Keys)
  {
    sum += rank.value(key).toDouble();
  }
  return sum;
}

QVariant pqDSMRankTable::data(const QModelIndex& index, int role) const
{
  if (!index.isValid())
  {
    return QVariant();
  }
  const Column& column = Columns[index.column()];
  const QVariant value = this->GetValue(index.row(), index.column());
  switch (role)
  {
    case Qt::DisplayRole:
      return value.isValid() ? ToText(value, column.Is) : QVariant();
    case ValueRole:
      return value;
    case Qt::ToolTipRole:
      return this->tr(column.Description);
    case Qt::TextAlignmentRole:
      return QVariant(
        (column.Is == Unit::Name ? Qt::AlignLeft : Qt::AlignRight) | Qt::AlignVCenter);
    case Qt::FontRole:
    {
      QFont font;
      font.setBold(this->IsTotal(index.row()));
      return font;
    }
    default:
      return QVariant();
  }
}

QVariant pqDSMRankTable::headerData(int section, Qt::Orientation orientation, int role) const
{
  if (orientation != Qt::Horizontal || section < 0 || section >= NumberOfColumns)
  {
    return QVariant();
  }
  const Column& column = Columns[section];
  if (role == Qt::DisplayRole)
  {
    return column.Is == Unit::Bytes ? this->tr("%1\n(MiB)").arg(this->tr(column.Title))
                                    : this->tr(column.Title);
  }
  return role == Qt::ToolTipRole ? QVariant(this->tr(column.Description)) : QVariant();
}
