// SPDX-License-Identifier: BSD-3-Clause
#include "pqDSMLevelWidget.h"

#include "pqCoreUtilities.h"
#include "vtkCommand.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"

#include <QComboBox>
#include <QStringList>
#include <QVBoxLayout>

pqDSMLevelWidget::pqDSMLevelWidget(vtkSMProxy* reader, vtkSMProperty* level, QWidget* parent)
  : pqPropertyWidget(reader, parent)
  , List(new QComboBox(this))
{
  this->List->setObjectName("ComboBox");
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(this->List);
  this->Fill(0);
  this->addPropertyLink(this, "level", SIGNAL(LevelChosen()), level);
  QObject::connect(
    this->List, QOverload<int>::of(&QComboBox::activated), this, &pqDSMLevelWidget::LevelChosen);
  pqCoreUtilities::connect(
    reader->GetProperty("LevelNames"), vtkCommand::ModifiedEvent, this, SLOT(Fill()));
}

pqDSMLevelWidget::~pqDSMLevelWidget() = default;

int pqDSMLevelWidget::GetLevel() const
{
  return this->List->currentData().toInt();
}

void pqDSMLevelWidget::SetLevel(int level)
{
  if (level != this->GetLevel())
  {
    this->Fill(level);
  }
}

void pqDSMLevelWidget::Fill()
{
  this->Fill(this->GetLevel());
}

void pqDSMLevelWidget::Fill(int level)
{
  const QString names = vtkSMPropertyHelper(this->proxy(), "LevelNames").GetAsString();
  this->List->clear();
  for (const QString& name : names.split('\n', Qt::SkipEmptyParts))
  {
    this->List->addItem(name, this->List->count());
  }
  if (level < 0 || level >= this->List->count())
  {
    this->List->addItem(names.isEmpty() ? QString::number(level)
                                        : this->tr("%1: not available in the file").arg(level),
      level);
  }
  this->List->setCurrentIndex(this->List->findData(level));
}
