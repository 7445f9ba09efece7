// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CapturePage.h"

#include "FoldBehind.h"
#include "Look.h"
#include "SampleRows.h"
#include "ui_CapturePage.h"

#include <QApplication>
#include <QFileDialog>
#include <QSignalBlocker>

namespace handeye
{

CapturePage::CapturePage(HandEyeWorkbench& workbench, QWidget* parent)
  : WizardPage(workbench, WizardStep::Capture, parent)
  , ui_(std::make_unique<Ui::CapturePage>())
{
  ui_->setupUi(this);
  foldBehind(*ui_->moreButton, *ui_->limitsBox);
  ui_->limitsBox->layout()->setContentsMargins(0, 0, 0, 0);
  CaptureTask& capture = workbench_.capture();
  ui_->handsFreeBox->setChecked(true);
  connect(ui_->handsFreeBox, &QCheckBox::toggled, &capture, &CaptureTask::setHandsFree);
  connect(ui_->takeButton, &QPushButton::clicked, &capture, &CaptureTask::takeNow);
  connect(ui_->recordingButton, &QPushButton::clicked, this,
    [this]
    {
      const QString path = QFileDialog::getOpenFileName(
        this, tr("Recording of placements"), {}, tr("Sequence metafiles (*.mha *.igs.mha);;All files (*)"));
      if (!path.isEmpty())
      {
        workbench_.capture().importRecording(path);
      }
    });
  connect(ui_->againButton, &QPushButton::clicked, &capture, &CaptureTask::evaluateAgain);
  connect(ui_->loadButton, &QPushButton::clicked, this,
    [this]
    {
      const QString path = QFileDialog::getOpenFileName(this, tr("Calibration"), {}, tr("Calibrations (*.json);;All files (*)"));
      if (!path.isEmpty())
      {
        workbench_.loadCalibration(path);
      }
    });
  connect(ui_->table, &SampleTable::excludeRequested, &capture, &CaptureTask::setExcluded);
  connect(
    ui_->table, &SampleTable::deleteRequested, &capture, [&capture](const QVector<int>& ids) { capture.setDeleted(ids, true); });
  connect(
    ui_->table, &SampleTable::restoreRequested, &capture, [&capture](const QVector<int>& ids) { capture.setDeleted(ids, false); });
  connect(ui_->nearestSpin, &QDoubleSpinBox::editingFinished, this,
    [this] { workbench_.setWorkingDepths(ui_->nearestSpin->value(), ui_->furthestSpin->value()); });
  connect(ui_->furthestSpin, &QDoubleSpinBox::editingFinished, this,
    [this] { workbench_.setWorkingDepths(ui_->nearestSpin->value(), ui_->furthestSpin->value()); });
  connect(ui_->enoughSpin, qOverload<double>(&QDoubleSpinBox::valueChanged), &workbench_, &HandEyeWorkbench::setEnoughPx);
  connect(&capture, &CaptureTask::samplesChanged, this, &CapturePage::showSamples);
  connect(&capture, &CaptureTask::hintChanged, this, [this] { ui_->hintLabel->setText(asSentence(workbench_.capture().hint())); });
  connect(&capture, &CaptureTask::accepted, this,
    [this](int id)
    {
      ui_->hintLabel->setText(tr("Sample %1 is stored.").arg(sampleNumber(id)));
      if (ui_->soundBox->isChecked())
      {
        QApplication::beep();
      }
    });
  connect(&capture, &CaptureTask::imported, this,
    [this](const QVector<int>& ids, int refused, const QString& reason)
    {
      ui_->handsFreeBox->setChecked(false);  // live samples are not mixed into a recording's unasked
      ui_->hintLabel->setText(importedWords(ids.size(), refused, reason));
      if (!ids.isEmpty())
      {
        ui_->hintLabel->setText(ui_->hintLabel->text() + QLatin1Char(' ') + tr("Undo takes them out again."));
        ui_->table->addUndoableSamples(
          ids, counted(ids.size(), tr("take a sample of a recording"), tr("take %1 samples of a recording")));
      }
    });
  connect(&workbench_, &HandEyeWorkbench::calibrationChanged, this, &CapturePage::showCalibration);
  connect(&workbench_, &HandEyeWorkbench::sessionOpened, this,
    [this]
    {
      ui_->table->clearHistory();
      // A session that is gone on with takes nothing by itself before it is asked to.
      const int stored = workbench_.capture().storedSampleCount();
      const QSignalBlocker blocker(ui_->handsFreeBox);
      ui_->handsFreeBox->setChecked(stored == 0);
      workbench_.capture().setHandsFree(false);
      if (isVisible() && stored == 0)
      {
        workbench_.capture().beginHandsFree();
      }
      ui_->hintLabel->setText(stored > 0 && workbench_.devices().isConnected()
          ? tr("This session has samples already: turn Hands-free on to add others by itself.")
          : QString());
    });
  // What was said of the last picture is over when there are none.
  connect(&workbench_.devices(), &DeviceHub::connectionChanged, ui_->hintLabel, &QLabel::clear);
}

CapturePage::~CapturePage() = default;

void CapturePage::enter()
{
  if (ui_->handsFreeBox->isChecked())
  {
    workbench_.capture().beginHandsFree();
  }
  showSamples();
  showCalibration();
}

bool CapturePage::keyInVideo(int key)
{
  if (key == Qt::Key_Space)
  {
    workbench_.capture().takeNow();
    return true;
  }
  return false;
}

void CapturePage::showSamples()
{
  ui_->table->setRows(calibrationRows(workbench_.capture().samples(), workbench_.calibration()));
}

void CapturePage::showCalibration()
{
  showSamples();
  const std::optional<CalibrationStepResult>& calibration = workbench_.calibration();
  QVector<CoverageView::Place> places;
  for (const CapturedFrame& frame : workbench_.capture().frames())
  {
    if (frame.isSample())
    {
      places.push_back({ QPointF(frame.ball.ball_Image.x(), frame.ball.ball_Image.y()), frame.ball.distanceMm });
    }
  }
  if (workbench_.camera() && workbench_.camera()->file.camera.hasImageSize())
  {
    ui_->coverage->setImageSize(QSize(workbench_.camera()->file.camera.width(), workbench_.camera()->file.camera.height()));
  }
  ui_->coverage->setWorkingRange(workbench_.nearestMm(), workbench_.furthestMm());
  ui_->coverage->setPlaces(places);
  std::optional<CoverageView::Place> next;
  if (calibration && calibration->guidance && calibration->guidance->status != HandEyeGuidance::Status::NoPlace)
  {
    const HandEyeGuidance& guidance = *calibration->guidance;
    next = CoverageView::Place{ QPointF(guidance.ball_Image.x(), guidance.ball_Image.y()), guidance.ball_Camera.norm() };
    ui_->guidanceLabel->setText(tr("Next: %1").arg(QString::fromStdString(guidance.message)));
  }
  else
  {
    ui_->guidanceLabel->clear();
  }
  ui_->coverage->setNextPlace(next);
  const bool isUsable = calibration && calibration->isUsable();
  // The verdict itself stands beside Next.
  const QString limit = withUnit(workbench_.enoughPx(), 2, tr("px"));
  const QString worst = isUsable ? withUnit(calibration->calibration.predicted.maximumPx, 2, tr("px")) : QString();
  ui_->verdictLabel->setText(!calibration ? tr("No samples yet.")
      : !isUsable                         ? tr("Not enough yet.")
      : workbench_.isEnough()             ? tr("<b>Enough:</b> %1 at worst, limit %2").arg(worst, limit)
                                          : tr("Not enough: %1 at worst, limit %2").arg(worst, limit));
  const bool isNews = workbench_.isEnough() && !isEnoughSaid_;
  isEnoughSaid_ = isUsable && workbench_.isEnough();
  if (isNews && ui_->soundBox->isChecked())
  {
    QApplication::beep();
  }
}

void CapturePage::refresh()
{
  const bool isReady = workbench_.missingFor(WizardStep::Capture).isEmpty();
  const bool isLive = workbench_.devices().isConnected();
  ui_->handsFreeBox->setEnabled(isReady && isLive);
  ui_->takeButton->setEnabled(isReady && isLive);
  ui_->recordingButton->setEnabled(isReady && !workbench_.capture().isBusy());
  ui_->againButton->setVisible(workbench_.capture().isBroken());
  const QString offline = tr("Nothing is connected: see the page Devices. A recording can be taken without.");
  if (isReady && !isLive && ui_->hintLabel->text().isEmpty())
  {
    ui_->hintLabel->setText(offline);
  }
  else if (isLive && ui_->hintLabel->text() == offline)
  {
    ui_->hintLabel->clear();
  }
  for (const auto& [spin, value] : { std::pair{ ui_->nearestSpin, workbench_.nearestMm() },
         std::pair{ ui_->furthestSpin, workbench_.furthestMm() }, std::pair{ ui_->enoughSpin, workbench_.enoughPx() } })
  {
    if (!spin->hasFocus())
    {
      const QSignalBlocker blocker(spin);
      spin->setValue(value);
    }
  }
}

}  // namespace handeye
