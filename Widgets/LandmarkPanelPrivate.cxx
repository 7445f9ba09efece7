// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LandmarkPanelPrivate.h"

#include <QFileDialog>
#include <QHeaderView>
#include <QShortcut>
#include <QStyle>
#include <QTableWidget>

#include <algorithm>

namespace handeye
{

namespace
{

enum Column
{
  NumberColumn,
  NameColumn,
  StateColumn,
  ResidualColumn,
  ColumnCount
};

Level levelOf(const LandmarkRegistrationResult& result)
{
  return result.isUsable()                                              ? Level::Good
    : result.status == LandmarkRegistrationResult::Status::TooFewPoints ? Level::Info
                                                                        : Level::Error;
}

}  // namespace

void LandmarkPanel::Private::setUpUi()
{
  ui.setupUi(&q);
  ui.table->setColumnCount(ColumnCount);
  ui.table->setWordWrap(false);
  QHeaderView* header = ui.table->horizontalHeader();
  header->setSectionResizeMode(QHeaderView::ResizeToContents);
  header->setSectionResizeMode(NameColumn, QHeaderView::Stretch);
  // However little room there is: three rows, and each sentence in its own two lines.
  constexpr int LeastTableHeight = 130;
  ui.table->setMinimumHeight(LeastTableHeight);
  for (QLabel* const label : { ui.tipLabel, ui.verdictLabel })
  {
    label->setMinimumHeight(2 * label->fontMetrics().lineSpacing());
  }
  ui.openLandmarksButton->setIcon(icon(QStringLiteral("open")));
  ui.touchButton->setIcon(icon(QStringLiteral("landmark")));
  ui.undoButton->setIcon(icon(QStringLiteral("undo")));
  ui.skipButton->setIcon(icon(QStringLiteral("skip")));
  ui.loadButton->setIcon(icon(QStringLiteral("open")));
  ui.saveButton->setIcon(icon(QStringLiteral("save")));
  ui.clearButton->setIcon(icon(QStringLiteral("delete")));
}

void LandmarkPanel::Private::addShortcut(
  const QKeySequence& key, QWidget* where, Qt::ShortcutContext context, void (LandmarkPanel::*slot)())
{
  auto* shortcut = new QShortcut(key, where);
  shortcut->setContext(context);
  connect(shortcut, &QShortcut::activated, &q, slot);
}

void LandmarkPanel::Private::connectButtons()
{
  connect(ui.openLandmarksButton, &QPushButton::clicked, &q,
    [this]
    {
      const QString path = QFileDialog::getOpenFileName(&q, LandmarkPanel::tr("Landmarks of the model"), QString(),
        LandmarkPanel::tr("Landmarks (*.txt *.csv *.xyz *.json);;All files (*)"));
      if (!path.isEmpty())
      {
        q.loadModelLandmarks(path);
      }
    });
  connect(ui.touchButton, &QPushButton::clicked, &q,
    [this]
    {
      if (current >= 0)
      {
        emit q.touchRequested(current);
      }
    });
  connect(ui.handsFreeBox, &QCheckBox::toggled, &q,
    [this](bool on)
    {
      this->update();
      emit q.handsFreeChanged(on);
    });
  connect(ui.takeBackButton, &QPushButton::clicked, &q, &LandmarkPanel::takeBackCurrent);
  connect(ui.undoButton, &QToolButton::clicked, &q, &LandmarkPanel::undo);
  connect(ui.skipButton, &QPushButton::clicked, &q, &LandmarkPanel::skipCurrent);
  connect(ui.clearButton, &QPushButton::clicked, &q,
    [this]
    {
      q.clearTouched();
      ui.table->setFocus();  // the button is disabled now: the keyboard stays in the panel, where Ctrl+Z undoes this
    });
  connect(ui.table, &QTableWidget::currentCellChanged, &q, [this](int row) { q.setCurrentLandmark(row); });
  connect(ui.saveButton, &QPushButton::clicked, &q,
    [this]
    {
      const QString path = QFileDialog::getSaveFileName(
        &q, LandmarkPanel::tr("Save the registration"), QStringLiteral("phantom.json"), LandmarkPanel::tr("Registration (*.json)"));
      if (!path.isEmpty())
      {
        emit q.saveRequested(path);
      }
    });
  connect(ui.loadButton, &QPushButton::clicked, &q,
    [this]
    {
      const QString path =
        QFileDialog::getOpenFileName(&q, LandmarkPanel::tr("Registration"), QString(), LandmarkPanel::tr("Registration (*.json)"));
      if (!path.isEmpty())
      {
        emit q.loadRequested(path);
      }
    });
  this->addShortcut(Qt::Key_Backspace, ui.table, Qt::WidgetShortcut, &LandmarkPanel::takeBackCurrent);
  this->addShortcut(Qt::Key_Delete, ui.table, Qt::WidgetShortcut, &LandmarkPanel::takeBackCurrent);
  // Wherever the last click has left the keyboard.
  this->addShortcut(QKeySequence::Undo, &q, Qt::WidgetWithChildrenShortcut, &LandmarkPanel::undo);
  auto* touch = new QShortcut(Qt::Key_Space, ui.table);
  touch->setContext(Qt::WidgetShortcut);
  connect(touch, &QShortcut::activated, ui.touchButton, [this] { ui.touchButton->click(); });
}

QString LandmarkPanel::Private::stateOf(int row) const
{
  const Landmark& landmark = landmarks[row];
  if (landmark.skipped)
  {
    return LandmarkPanel::tr("skipped");
  }
  if (landmark.touched_Phantom)
  {
    return LandmarkPanel::tr("touched");
  }
  return row == current ? LandmarkPanel::tr("touch now") : LandmarkPanel::tr("open");
}

void LandmarkPanel::Private::updateRow(int row, const QVector<int>& paired)
{
  const Landmark& landmark = landmarks[row];
  QString residual = QString(QChar(0x2013));
  const int pair = paired.indexOf(row);
  const bool isWorst = result && pair >= 0 && !result->isUsable() && pair == result->worst;
  if (result && pair >= 0 && std::size_t(pair) < result->residualsMm.size())
  {
    residual = QLocale().toString(result->residualsMm[std::size_t(pair)], 'f', 2);
  }
  const QString name = landmark.name.isEmpty() ? LandmarkPanel::tr("Landmark %1").arg(row + 1) : landmark.name;
  const QString texts[ColumnCount] = { QString::number(row + 1), name, this->stateOf(row), residual };
  QString about = LandmarkPanel::tr("%1\nin the model: %2, %3, %4 mm")
                    .arg(name)
                    .arg(landmark.point_Model.x(), 0, 'f', 1)
                    .arg(landmark.point_Model.y(), 0, 'f', 1)
                    .arg(landmark.point_Model.z(), 0, 'f', 1);
  if (landmark.touched_Phantom)
  {
    const Eigen::Vector3d& touched = *landmark.touched_Phantom;
    about += LandmarkPanel::tr("\ntouched at: %1, %2, %3 mm in the frame of the phantom's marker")
               .arg(touched.x(), 0, 'f', 1)
               .arg(touched.y(), 0, 'f', 1)
               .arg(touched.z(), 0, 'f', 1);
  }
  for (int column = 0; column < ColumnCount; ++column)
  {
    QTableWidgetItem* item = ui.table->item(row, column);
    if (!item)
    {
      item = new QTableWidgetItem();
      ui.table->setItem(row, column, item);
    }
    const bool isNumber = column == NumberColumn || column == ResidualColumn;
    item->setTextAlignment(int((isNumber ? Qt::AlignRight : Qt::AlignLeft) | Qt::AlignVCenter));
    item->setText(texts[column]);
    item->setToolTip(about);
    item->setIcon({});
  }
  const bool isNext = row == current && !landmark.touched_Phantom && !landmark.skipped;
  ui.table->item(row, StateColumn)
    ->setIcon(landmark.skipped     ? icon(QStringLiteral("skip"))
        : landmark.touched_Phantom ? icon(QStringLiteral("ok"))
        : isNext                   ? icon(QStringLiteral("landmark"))
                                   : QIcon());
  ui.table->item(row, ResidualColumn)->setIcon(isWorst ? levelIcon(Level::Error) : QIcon());
}

void LandmarkPanel::Private::update()
{
  const QVector<int> paired = q.pairs().landmarks;
  ui.table->setRowCount(landmarks.size());
  for (int row = 0; row < landmarks.size(); ++row)
  {
    this->updateRow(row, paired);
  }
  const QSignalBlocker blocker(ui.table);
  if (current >= 0)
  {
    ui.table->setCurrentCell(current, NameColumn);
  }
  else
  {
    ui.table->clearSelection();
  }
  this->updateButtons();
  this->updateVerdict();
  this->fitTable();
}

/// Three rows are seen in a low window, all of them in a high one.
void LandmarkPanel::Private::fitTable()
{
  constexpr int LeastRows = 3;
  constexpr int HeaderLines = 2;
  const QHeaderView* titles = ui.table->horizontalHeader();
  const int header = HeaderLines * titles->fontMetrics().lineSpacing() +
    2 * titles->style()->pixelMetric(QStyle::PM_HeaderMargin, nullptr, titles) + 1 + 2 * ui.table->frameWidth();
  const int row = ui.table->verticalHeader()->defaultSectionSize();
  const int most = std::max(LeastRows, int(landmarks.size()));
  ui.table->setMinimumHeight(header + LeastRows * row);
  ui.table->setMaximumHeight(header + most * row);
}

void LandmarkPanel::Private::updateButtons()
{
  const bool any = current >= 0;
  const bool touched = any && landmarks[current].touched_Phantom.has_value();
  ui.touchButton->setEnabled(any && tipAvailable && !landmarks[current].skipped);
  ui.touchButton->setText(touched ? LandmarkPanel::tr("&Touch again") : LandmarkPanel::tr("&Touch"));
  ui.takeBackButton->setEnabled(touched);
  ui.undoButton->setEnabled(!history.isEmpty());
  ui.undoButton->setToolTip(history.isEmpty()
      ? LandmarkPanel::tr("Nothing to undo")
      : LandmarkPanel::tr("Undo: %1 (%2)")
          .arg(history.last().what, QKeySequence(QKeySequence::Undo).toString(QKeySequence::NativeText)));
  ui.skipButton->setEnabled(any);
  ui.skipButton->setText(any && landmarks[current].skipped ? LandmarkPanel::tr("Do not sk&ip") : LandmarkPanel::tr("Sk&ip"));
  ui.clearButton->setEnabled(
    std::any_of(landmarks.begin(), landmarks.end(), [](const Landmark& one) { return one.touched_Phantom || one.skipped; }));
  ui.saveButton->setEnabled(result && result->isUsable());
  ui.handsFreeBox->setEnabled(!landmarks.isEmpty());
  QString words;
  if (landmarks.isEmpty())
  {
    words = LandmarkPanel::tr("Load the model's landmarks first.");
  }
  else if (!tipAvailable)
  {
    words = tipReason.isEmpty() ? LandmarkPanel::tr("The stylus' tip is not known now.") : tipReason;
  }
  else if (any && !touched && !landmarks[current].skipped)
  {
    const QString name =
      landmarks[current].name.isEmpty() ? LandmarkPanel::tr("landmark %1").arg(current + 1) : landmarks[current].name;
    words = ui.handsFreeBox->isChecked() ? LandmarkPanel::tr("Rest the tip on: %1").arg(name)
                                         : LandmarkPanel::tr("Put the tip on: %1, and press Touch").arg(name);
  }
  ui.tipLabel->setText(words);
  ui.tipLabel->setVisible(!words.isEmpty());
}

void LandmarkPanel::Private::showVerdict(const QString& text, Level level)
{
  const int side = q.fontMetrics().height() + 2;
  ui.verdictIcon->setPixmap(levelIcon(level).pixmap(q.window()->windowHandle(), QSize(side, side)));
  ui.verdictLabel->setText(text);
  // Of the palette only this role: the rest follows the application's.
  QPalette palette;
  palette.setColor(QPalette::WindowText, levelColor(level, q.palette()));
  ui.verdictLabel->setPalette(palette);
}

/// The fit's residual, and what to expect elsewhere, which is another thing.
QString LandmarkPanel::Private::usableVerdict() const
{
  const int count = int(result->residualsMm.size());
  QString text = LandmarkPanel::tr("RMS %1 over %2.")
                   .arg(withUnit(result->rmsMm, 2, LandmarkPanel::tr("mm")),
                     counted(count, LandmarkPanel::tr("1 landmark"), LandmarkPanel::tr("%1 landmarks")));
  if (!result->landmarkTreMm.empty())
  {
    const double largest = *std::max_element(result->landmarkTreMm.begin(), result->landmarkTreMm.end());
    text += LandmarkPanel::tr(" The expected error at them is up to %1.").arg(withUnit(largest, 2, LandmarkPanel::tr("mm")));
  }
  if (!result->suggestedOrder.empty())
  {
    text += LandmarkPanel::tr(" They fit about as well in another order: check that they were touched in the order of the list.");
  }
  return text;
}

/// The sentence that came, whose numbers count the landmarks that were touched.
QString LandmarkPanel::Private::refusal() const
{
  QString text = QString::fromStdString(result->message);
  if (!text.isEmpty())
  {
    text[0] = text[0].toUpper();
  }
  const QVector<int> paired = q.pairs().landmarks;
  if (!paired.isEmpty() && paired.last() != paired.size() - 1)
  {
    text += LandmarkPanel::tr(" (Numbers count the touched landmarks only.)");
  }
  return text;
}

void LandmarkPanel::Private::updateVerdict()
{
  const int touched = q.pairs().landmarks.size();
  if (!fileError.isEmpty())
  {
    this->showVerdict(fileError, Level::Error);
  }
  else if (result)
  {
    const QString text = result->isUsable() ? this->usableVerdict() : this->refusal();
    this->showVerdict(text, levelOf(*result));
  }
  else if (touched < FewestLandmarks)
  {
    QString text = LandmarkPanel::tr("%1 of at least %2 landmarks touched.").arg(touched).arg(FewestLandmarks);
    const int before = touchedBefore();
    if (before > touched)
    {
      text += QLatin1Char(' ') +
        counted(
          before, LandmarkPanel::tr("Undo brings 1 touched point back."), LandmarkPanel::tr("Undo brings %1 touched points back."));
    }
    this->showVerdict(text, Level::Info);
  }
  else
  {
    this->showVerdict(
      counted(touched, LandmarkPanel::tr("1 landmark touched."), LandmarkPanel::tr("%1 landmarks touched.")), Level::Info);
  }
}

int LandmarkPanel::Private::nextUntouched(int after) const
{
  for (int step = 1; step <= landmarks.size(); ++step)
  {
    const int row = (after + step) % landmarks.size();
    if (!landmarks[row].touched_Phantom && !landmarks[row].skipped)
    {
      return row;
    }
  }
  return -1;
}

/// What takes touched points away can be undone.
void LandmarkPanel::Private::remember(const QString& what)
{
  constexpr int MostSteps = 200;
  history.append({ what, landmarks, current, ui.fileLabel->text(), ui.fileLabel->toolTip() });
  if (history.size() > MostSteps)
  {
    history.removeFirst();
  }
}

/// How many points there were before the last step.
int LandmarkPanel::Private::touchedBefore() const
{
  const auto isPair = [](const Landmark& landmark) { return landmark.touched_Phantom && !landmark.skipped; };
  return history.isEmpty() ? 0 : int(std::count_if(history.last().landmarks.begin(), history.last().landmarks.end(), isPair));
}

void LandmarkPanel::Private::replace(const QVector<Landmark>& with, int newCurrent)
{
  landmarks = with;
  current = newCurrent;
  this->changed();
  emit q.currentLandmarkChanged(current);
}

/// The points are others: the result is of the past, and so is what was said of a file.
void LandmarkPanel::Private::changed()
{
  result.reset();
  fileError.clear();
  this->update();
  emit q.pairsChanged();
}

}  // namespace handeye
