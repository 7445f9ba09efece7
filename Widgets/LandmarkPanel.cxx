// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LandmarkPanel.h"

#include "FileError.h"
#include "LandmarkFiles.h"
#include "ui_LandmarkPanel.h"

#include <QFileDialog>
#include <QFileInfo>
#include <QHeaderView>
#include <QShortcut>
#include <QTableWidget>

#include <algorithm>
#include <stdexcept>

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

constexpr int FewestLandmarks = 3;

Level levelOf(const LandmarkRegistrationResult& result)
{
  return result.isUsable()                                              ? Level::Good
    : result.status == LandmarkRegistrationResult::Status::TooFewPoints ? Level::Info
                                                                        : Level::Error;
}

}  // namespace

class LandmarkPanel::Private
{
public:
  explicit Private(LandmarkPanel& panel)
    : q(panel)
  {
  }

  void setUpUi();
  void connectButtons();
  void addShortcut(const QKeySequence& key, void (LandmarkPanel::*slot)());
  void update();
  void updateRow(int row, const QVector<int>& paired);
  void updateButtons();
  void updateVerdict();
  QString usableVerdict() const;
  QString refusal() const;
  void showVerdict(const QString& text, Level level);
  QString stateOf(int row) const;
  int nextUntouched(int after) const;
  void changed();

  LandmarkPanel& q;
  Ui::LandmarkPanel ui;
  QVector<Landmark> landmarks;
  int current = -1;
  bool tipAvailable = false;
  QString tipReason;
  QString fileError;
  std::optional<LandmarkRegistrationResult> result;
  std::optional<Eigen::Vector3d> lastTaken_Phantom;
};

void LandmarkPanel::Private::setUpUi()
{
  ui.setupUi(&q);
  ui.table->setColumnCount(ColumnCount);
  QHeaderView* header = ui.table->horizontalHeader();
  header->setSectionResizeMode(QHeaderView::ResizeToContents);
  header->setSectionResizeMode(NameColumn, QHeaderView::Stretch);
  ui.openLandmarksButton->setIcon(icon(QStringLiteral("open")));
  ui.touchButton->setIcon(icon(QStringLiteral("landmark")));
  ui.redoButton->setIcon(icon(QStringLiteral("undo")));
  ui.skipButton->setIcon(icon(QStringLiteral("skip")));
  ui.loadButton->setIcon(icon(QStringLiteral("open")));
  ui.saveButton->setIcon(icon(QStringLiteral("save")));
  ui.clearButton->setIcon(icon(QStringLiteral("delete")));
}

void LandmarkPanel::Private::addShortcut(const QKeySequence& key, void (LandmarkPanel::*slot)())
{
  auto* shortcut = new QShortcut(key, ui.table);
  shortcut->setContext(Qt::WidgetShortcut);
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
  connect(ui.redoButton, &QPushButton::clicked, &q, &LandmarkPanel::redoCurrent);
  connect(ui.skipButton, &QPushButton::clicked, &q, &LandmarkPanel::skipCurrent);
  connect(ui.clearButton, &QPushButton::clicked, &q, &LandmarkPanel::clearTouched);
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
  this->addShortcut(Qt::Key_Backspace, &LandmarkPanel::redoCurrent);
  this->addShortcut(Qt::Key_Delete, &LandmarkPanel::redoCurrent);
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
}

void LandmarkPanel::Private::updateButtons()
{
  const bool any = current >= 0;
  const bool touched = any && landmarks[current].touched_Phantom.has_value();
  ui.touchButton->setEnabled(any && tipAvailable && !landmarks[current].skipped);
  ui.touchButton->setText(touched ? LandmarkPanel::tr("&Touch again") : LandmarkPanel::tr("&Touch"));
  ui.redoButton->setEnabled(touched);
  ui.skipButton->setEnabled(any);
  ui.skipButton->setText(any && landmarks[current].skipped ? LandmarkPanel::tr("Do not s&kip") : LandmarkPanel::tr("S&kip"));
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
  QPalette palette = q.palette();
  palette.setColor(QPalette::WindowText, levelColor(level, palette));
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
    this->showVerdict(LandmarkPanel::tr("%1 of at least %2 landmarks touched.").arg(touched).arg(FewestLandmarks), Level::Info);
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

/// The points are others: the result is of the past.
void LandmarkPanel::Private::changed()
{
  result.reset();
  this->update();
  emit q.pairsChanged();
}

LandmarkPanel::LandmarkPanel(QWidget* parent)
  : QWidget(parent)
  , d(std::make_unique<Private>(*this))
{
  d->setUpUi();
  d->connectButtons();
  d->update();
}

LandmarkPanel::~LandmarkPanel()
{
  d->ui.table->disconnect(this);
}

bool LandmarkPanel::loadModelLandmarks(const QString& path)
{
  try
  {
    const std::filesystem::path file = path.toStdString();
    const std::vector<Eigen::Vector3d> points = readModelLandmarks(file);
    if (points.size() < std::size_t(FewestLandmarks))
    {
      throw io::FileError(file, "at least " + std::to_string(FewestLandmarks) + " landmarks are expected");
    }
    const std::vector<std::string> names = readLandmarkNames(file);
    QVector<Landmark> landmarks;
    for (std::size_t index = 0; index < points.size(); ++index)
    {
      Landmark landmark;
      landmark.name = names.size() == points.size() ? QString::fromStdString(names[index]) : QString();
      landmark.point_Model = points[index];
      landmarks.append(landmark);
    }
    d->fileError.clear();
    d->ui.fileLabel->setText(
      QFileInfo(path).fileName() + QStringLiteral(": ") + counted(landmarks.size(), tr("1 landmark"), tr("%1 landmarks")));
    d->ui.fileLabel->setToolTip(path);
    this->setLandmarks(landmarks);
    return true;
  }
  catch (const std::exception& error)
  {
    d->fileError = QString::fromUtf8(error.what());
    d->update();
    return false;
  }
}

void LandmarkPanel::setLandmarks(const QVector<Landmark>& landmarks)
{
  d->landmarks = landmarks;
  d->lastTaken_Phantom.reset();
  d->current = landmarks.isEmpty() ? -1 : d->nextUntouched(-1);
  d->changed();
  emit currentLandmarkChanged(d->current);
}

const QVector<LandmarkPanel::Landmark>& LandmarkPanel::landmarks() const
{
  return d->landmarks;
}

LandmarkPanel::Pairs LandmarkPanel::pairs() const
{
  Pairs pairs;
  for (int index = 0; index < d->landmarks.size(); ++index)
  {
    const Landmark& landmark = d->landmarks[index];
    if (landmark.touched_Phantom && !landmark.skipped)
    {
      pairs.landmarks.append(index);
      pairs.points_Model.push_back(landmark.point_Model);
      pairs.points_Phantom.push_back(*landmark.touched_Phantom);
    }
  }
  return pairs;
}

int LandmarkPanel::currentLandmark() const
{
  return d->current;
}

void LandmarkPanel::setCurrentLandmark(int index)
{
  const int current = index >= 0 && index < d->landmarks.size() ? index : -1;
  if (current != d->current)
  {
    d->current = current;
    d->update();
    emit currentLandmarkChanged(current);
  }
}

bool LandmarkPanel::isHandsFree() const
{
  return d->ui.handsFreeBox->isChecked();
}

void LandmarkPanel::setTipAvailable(bool available, const QString& reason)
{
  if (available != d->tipAvailable || reason != d->tipReason)
  {
    d->tipAvailable = available;
    d->tipReason = reason;
    d->updateButtons();
  }
}

void LandmarkPanel::setResult(const std::optional<LandmarkRegistrationResult>& result)
{
  d->result = result;
  d->update();
}

const std::optional<LandmarkRegistrationResult>& LandmarkPanel::result() const
{
  return d->result;
}

void LandmarkPanel::setTouched(const Eigen::Vector3d& tip_Phantom)
{
  if (!tip_Phantom.allFinite())
  {
    throw std::invalid_argument("tip_Phantom holds a number that is not finite");
  }
  if (d->current < 0)
  {
    return;
  }
  const int before = d->current;
  d->landmarks[before].touched_Phantom = tip_Phantom;
  d->landmarks[before].skipped = false;
  d->lastTaken_Phantom = tip_Phantom;
  d->current = d->nextUntouched(before);
  d->fileError.clear();
  d->changed();
  if (d->current != before)
  {
    emit currentLandmarkChanged(d->current);
  }
}

bool LandmarkPanel::offerTip(const Eigen::Vector3d& tip_Phantom, double differentPlaceMm)
{
  const bool isOpen = d->current >= 0 && !d->landmarks[d->current].touched_Phantom && !d->landmarks[d->current].skipped;
  const bool isNew = !d->lastTaken_Phantom || (tip_Phantom - *d->lastTaken_Phantom).norm() > differentPlaceMm;
  if (!this->isHandsFree() || !isOpen || !isNew || !d->tipAvailable)
  {
    return false;
  }
  this->setTouched(tip_Phantom);
  return true;
}

void LandmarkPanel::redoCurrent()
{
  if (d->current >= 0 && d->landmarks[d->current].touched_Phantom)
  {
    d->landmarks[d->current].touched_Phantom.reset();
    d->changed();
  }
}

void LandmarkPanel::skipCurrent()
{
  if (d->current < 0)
  {
    return;
  }
  const int before = d->current;
  Landmark& landmark = d->landmarks[before];
  landmark.skipped = !landmark.skipped;
  const int next = landmark.skipped ? d->nextUntouched(before) : -1;
  d->current = next >= 0 ? next : before;
  d->changed();
  if (d->current != before)
  {
    emit currentLandmarkChanged(d->current);
  }
}

void LandmarkPanel::clearTouched()
{
  QVector<Landmark> landmarks = d->landmarks;
  for (Landmark& landmark : landmarks)
  {
    landmark.touched_Phantom.reset();
    landmark.skipped = false;
  }
  this->setLandmarks(landmarks);
}

}  // namespace handeye
