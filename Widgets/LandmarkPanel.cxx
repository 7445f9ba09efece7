// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LandmarkPanelPrivate.h"

#include "FileError.h"
#include "LandmarkFiles.h"

#include <QFileInfo>

#include <stdexcept>

namespace handeye
{

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

void LandmarkPanel::changeEvent(QEvent* event)
{
  QWidget::changeEvent(event);
  if (event->type() == QEvent::PaletteChange && d->ui.verdictLabel)
  {
    d->updateVerdict();
  }
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
    if (!d->landmarks.isEmpty())
    {
      d->remember(tr("load landmarks"));
    }
    d->ui.fileLabel->setText(
      QFileInfo(path).fileName() + QStringLiteral(": ") + counted(landmarks.size(), tr("1 landmark"), tr("%1 landmarks")));
    d->ui.fileLabel->setToolTip(path);
    d->replace(landmarks, 0);
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
  d->history.clear();
  d->lastTaken_Phantom.reset();
  d->ui.fileLabel->setText(landmarks.isEmpty()
      ? tr("No landmarks loaded")
      : counted(landmarks.size(), tr("1 landmark of the session"), tr("%1 landmarks of the session")));
  d->ui.fileLabel->setToolTip(QString());
  d->landmarks = landmarks;
  d->replace(landmarks, landmarks.isEmpty() ? -1 : d->nextUntouched(-1));
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
  // The one to be touched again is at hand.
  const QVector<int> touched = this->pairs().landmarks;
  if (result && !result->isUsable() && d->current < 0 && result->worst >= 0 && result->worst < touched.size())
  {
    this->setCurrentLandmark(touched[result->worst]);
  }
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
  d->remember(tr("touch"));
  d->landmarks[before].touched_Phantom = tip_Phantom;
  d->landmarks[before].skipped = false;
  d->lastTaken_Phantom = tip_Phantom;
  d->current = d->nextUntouched(before);
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

void LandmarkPanel::takeBackCurrent()
{
  if (d->current >= 0 && d->landmarks[d->current].touched_Phantom)
  {
    d->remember(tr("take back"));
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
  d->remember(d->landmarks[before].skipped ? tr("do not skip") : tr("skip"));
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
  d->remember(tr("start over"));
  QVector<Landmark> landmarks = d->landmarks;
  for (Landmark& landmark : landmarks)
  {
    landmark.touched_Phantom.reset();
    landmark.skipped = false;
  }
  d->replace(landmarks, landmarks.isEmpty() ? -1 : 0);
}

void LandmarkPanel::forgetTouched()
{
  this->clearTouched();
  d->history.clear();
  d->update();
}

void LandmarkPanel::undo()
{
  if (!d->history.isEmpty())
  {
    const Private::Before before = d->history.takeLast();
    d->ui.fileLabel->setText(before.fileWords);
    d->ui.fileLabel->setToolTip(before.filePath);
    d->replace(before.landmarks, before.current);
  }
}

}  // namespace handeye
