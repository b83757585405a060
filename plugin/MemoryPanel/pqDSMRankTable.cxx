// SPDX-License-Identifier: BSD-3-Clause
#include "pqDSMRankTable.h"

#include <QFont>
#include <QJsonObject>
#include <QLocale>
#include <QStringList>

#include <iterator>

namespace
{

enum class Kind
{
  Name,
  Count,
  Bytes,
  Seconds
};

struct Column
{
  const char* Title;
  /// What is added up.
  QStringList Keys;
  Kind Is;
  /// What ranks share on a host is each one's, but not several times the host's.
  bool HasTotal;
  const char* Description;
};

const Column Columns[] = {
  { "Rank", { "Rank" }, Kind::Name, false, "Number of the rank, in the order of MPI" },
  { "Host", { "Host" }, Kind::Name, false, "The machine on which the rank runs" },
  { "Bricks", { "BytesResident", "BytesCopied" }, Kind::Bytes, true,
    "Memory of the bricks that the rank owns, and of its copies of others' when they are "
    "replicated" },
  { "Shared", { "BytesShared" }, Kind::Bytes, false,
    "Bricks of other ranks of the host, which are read in place and take no memory" },
  { "Limit", { "MemoryBudget" }, Kind::Bytes, true, "What the rank may take for all of this" },
  { "Cache", { "BytesCached" }, Kind::Bytes, true,
    "Memory of bricks that other ranks own, or a file has, and that were fetched" },
  { "Cache Limit", { "CacheCapacity" }, Kind::Bytes, true, "What fetched bricks may take" },
  { "Hits", { "Hits" }, Kind::Count, true,
    "How often a ray found the brick that it needed in memory" },
  { "Misses", { "Misses" }, Kind::Count, true,
    "How often it was not there, and had to be fetched" },
  { "Tiles", { "Tiles" }, Kind::Count, true, "Parts of the picture that the rank traced" },
  { "Seconds", { "Seconds" }, Kind::Seconds, true, "Processor time of tracing, of all threads" },
};

constexpr int NumberOfColumns = static_cast<int>(std::size(Columns));

QString ToText(const QVariant& value, Kind kind)
{
  const QLocale locale;
  switch (kind)
  {
    case Kind::Count:
      return locale.toString(value.toLongLong());
    case Kind::Bytes:
      return locale.toString(value.toDouble() / (1024.0 * 1024.0), 'f', 1);
    case Kind::Seconds:
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
  // What is selected, and where the table is scrolled to, stays.
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
  if (column.Is == Kind::Name)
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
        (column.Is == Kind::Name ? Qt::AlignLeft : Qt::AlignRight) | Qt::AlignVCenter);
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
    return column.Is == Kind::Bytes ? this->tr("%1\n(MiB)").arg(this->tr(column.Title))
                                    : this->tr(column.Title);
  }
  return role == Qt::ToolTipRole ? QVariant(this->tr(column.Description)) : QVariant();
}
