// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "StylusPage.h"

#include "Look.h"
#include "PivotCollector.h"
#include "ui_StylusPage.h"

#include <QFileDialog>

#include <cmath>

namespace handeye
{

StylusPage::StylusPage(HandEyeWorkbench& workbench, QWidget* parent)
  : WizardPage(workbench, WizardStep::Stylus, parent)
  , ui_(std::make_unique<Ui::StylusPage>())
{
  ui_->setupUi(this);
  // Both change while a person pivots: there is room for the longest of them, and the page does not move.
  for (const auto& [label, lines] : { std::pair(ui_->errorLabel, 1), std::pair(ui_->posesLabel, 2) })
  {
    label->setMinimumHeight(lines * label->fontMetrics().lineSpacing());
    label->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Preferred);  // a form gives others the width of their words only
  }
  ui_->introLabel->setMinimumHeight(3 * ui_->introLabel->fontMetrics().lineSpacing());
  ui_->introLabel->setAlignment(Qt::AlignTop | Qt::AlignLeft);
  // Its words change while the stylus is spun, too.
  ui_->shaftLabel->setMinimumHeight(2 * ui_->shaftLabel->fontMetrics().lineSpacing());
  ui_->shaftLabel->setAlignment(Qt::AlignTop | Qt::AlignLeft);
  // With the shaft below it, all of the page fits into 800 px.
  constexpr int MostDomePx = 250;
  ui_->dome->setMaximumHeight(MostDomePx);
  connectPivot();
  connectSpin();
  connect(&workbench_, &HandEyeWorkbench::stylusChanged, this, &StylusPage::refresh);
}

StylusPage::~StylusPage() = default;

void StylusPage::connectPivot()
{
  PivotTask& pivot = workbench_.pivot();
  connect(ui_->startButton, &QPushButton::clicked, this,
    [this] { workbench_.pivot().start(workbench_.devices().setup().stylusToTracker); });
  connect(ui_->finishButton, &QPushButton::clicked, &pivot, &PivotTask::finish);
  connect(ui_->loadButton, &QPushButton::clicked, this,
    [this]
    {
      const QString path = QFileDialog::getOpenFileName(this, tr("Stylus file"), {}, tr("Stylus files (*.json);;All files (*)"));
      if (!path.isEmpty())
      {
        workbench_.loadStylus(path);
      }
    });
  connect(ui_->recordingButton, &QPushButton::clicked, this,
    [this]
    {
      const QString path = QFileDialog::getOpenFileName(
        this, tr("Recording of the pivoting"), {}, tr("Sequence metafiles (*.mha *.igs.mha);;All files (*)"));
      if (!path.isEmpty())
      {
        workbench_.pivot().calibrateRecording(path, workbench_.devices().setup().stylusToTracker);
      }
    });
  connect(&pivot, &PivotTask::progressed, this, &StylusPage::showProgress);
}

void StylusPage::connectSpin()
{
  SpinTask& spin = workbench_.spin();
  connect(ui_->spinButton, &QPushButton::clicked, &workbench_, &HandEyeWorkbench::spinStylus);
  connect(ui_->spinFinishButton, &QPushButton::clicked, &spin, &SpinTask::finish);
  connect(ui_->spinCancelButton, &QPushButton::clicked, &spin, &SpinTask::cancel);
  connect(&spin, &SpinTask::progressed, this, &StylusPage::showSpin);
}

void StylusPage::leave()
{
  workbench_.pivot().cancel();
  workbench_.spin().cancel();
}

QString StylusPage::intro() const
{
  const PivotTask::State& state = workbench_.pivot().state();
  const QString limit = withUnit(PivotTask::enoughTipErrorMm(), 1, tr("mm"));
  if (state.end == PivotTask::End::Enough)
  {
    return tr(
      "Enough: poses from %1 of %2 directions agree on one tip, and its error, which is predicted from all of them, is below %3. "
      "More directions would hardly change it.")
      .arg(state.coverage.covered())
      .arg(DomeCoverage::Cells)
      .arg(limit);
  }
  return tr(
    "Rest the tip in a divot and lean the stylus in all directions. It ends by itself once the tip is known to %1 and %2 of the "
    "%3 directions are covered: the rest is not needed then.")
    .arg(limit)
    .arg(DomeCoverage::EnoughCells)
    .arg(DomeCoverage::Cells);
}

/// What to do next, or why nothing more has to be done.
QString StylusPage::hint() const
{
  const PivotTask::State& state = workbench_.pivot().state();
  if (state.end == PivotTask::End::Enough)
  {
    return tr("enough, the rest is not needed");
  }
  if (state.end == PivotTask::End::ByPerson)
  {
    return tr("finished by you");
  }
  if (!workbench_.pivot().isCollecting())
  {
    return {};
  }
  const QString name = workbench_.devices().setup().stylusToTracker;
  if (workbench_.devices().stream(name).light != StreamList::Light::Live)
  {
    return tr("the tracker does not see the stylus");
  }
  if (state.hasTipMoved)
  {
    return tr("the tip has moved: start again");
  }
  if (state.isExact)
  {
    return tr("the tip is exact enough; go on to %1 directions").arg(DomeCoverage::EnoughCells);
  }
  if (state.coverage.isEnough())
  {
    return tr("go on: the tip is not exact enough yet");
  }
  const bool isRefused = !state.estimate.isUsable() && state.counts.kept > 0;
  return isRefused ? QString::fromStdString(state.estimate.message) : tr("lean it in all directions");
}

void StylusPage::showProgress()
{
  const PivotTask::State& state = workbench_.pivot().state();
  const PivotCalibrationResult& estimate = state.estimate;
  ui_->dome->setCoverage(state.coverage);
  const bool isKnown = estimate.isUsable() && std::isfinite(state.predictedTipErrorMm);
  const bool hasPoses = state.counts.total() > 0;
  const QString errorMm = withUnit(state.predictedTipErrorMm, 2, tr("mm"));
  const QString error = tr("%1 predicted (residuals %2 RMS)").arg(errorMm, withUnit(estimate.rmsMm, 2, tr("mm")));
  ui_->errorLabel->setText(isKnown ? error : hasPoses ? tr("not known yet") : tr("–"));
  ui_->posesLabel->setText(hasPoses ? PivotTask::wordsOf(state.counts) : tr("–"));
  ui_->dome->setHint(hint());
  ui_->introLabel->setText(intro());
  // Of a stylus that came from a file or a session, directions and poses are not known.
  const bool isPivotKnown = hasPoses || workbench_.pivot().isCollecting() || !workbench_.stylus();
  ui_->dome->setVisible(isPivotKnown);
  ui_->countsBox->setVisible(isPivotKnown);
}

void StylusPage::refresh()
{
  const bool isCollecting = workbench_.pivot().isCollecting();
  const QString missing = workbench_.devices().isConnected() ? QString() : tr("No tracker is connected.");
  ui_->startButton->setEnabled(missing.isEmpty());
  ui_->startButton->setText(isCollecting || workbench_.stylus() ? tr("&Start again") : tr("&Start pivoting"));
  ui_->finishButton->setEnabled(isCollecting);
  const std::optional<HandEyeWorkbench::Stylus>& stylus = workbench_.stylus();
  ui_->tipLabel->setText(stylus ? tr("Tip at %1, %2, %3 mm from the origin of the stylus' marker")
                                    .arg(stylus->tip_Stylus.x(), 0, 'f', 2)
                                    .arg(stylus->tip_Stylus.y(), 0, 'f', 2)
                                    .arg(stylus->tip_Stylus.z(), 0, 'f', 2)
                                : QString());
  showProgress();
  refreshSpin();
}

void StylusPage::showSpin()
{
  const SpinTask::State& state = workbench_.spin().state();
  const SpinCalibrationResult& estimate = state.estimate;
  constexpr double Degrees = 180 / M_PI;
  ui_->spinProgress->setValue(int(100 * state.share()));
  ui_->spinFinishButton->setEnabled(estimate.isUsable());
  const QString turned = tr("Spun by %1 deg RMS (wanted: %2), %3 poses (wanted: %4), %5 hidden.")
                           .arg(estimate.spin * Degrees, 0, 'f', 0)
                           .arg(SpinTask::EnoughSpin * Degrees, 0, 'f', 0)
                           .arg(estimate.used.size())
                           .arg(SpinTask::EnoughPoses)
                           .arg(state.hidden);
  const QString found = estimate.isUsable() ? tr("The shaft is known to %1 deg.").arg(estimate.shaftSigma * Degrees, 0, 'f', 3)
                                            : QString::fromStdString(estimate.message);
  ui_->shaftLabel->setText(turned + QLatin1Char(' ') + found);
}

void StylusPage::refreshSpin()
{
  const bool isSpinning = workbench_.spin().isCollecting();
  const QString missing = !workbench_.devices().isConnected() ? tr("No tracker is connected.")
    : workbench_.pivot().isCollecting()                       ? tr("The pivoting is still under way.")
    : !workbench_.stylus()                                    ? tr("Pivot the stylus, or load a stylus file, first.")
                                                              : QString();
  ui_->spinButton->setVisible(!isSpinning);
  ui_->spinButton->setEnabled(missing.isEmpty());
  ui_->spinButton->setToolTip(
    missing.isEmpty() ? tr("Collects poses while you turn the stylus, until the shaft is known well enough") : missing);
  for (QWidget* const widget : std::initializer_list<QWidget*>{ ui_->spinFinishButton, ui_->spinCancelButton, ui_->spinProgress })
  {
    widget->setVisible(isSpinning);
  }
  if (isSpinning)
  {
    showSpin();
    return;
  }
  const QString words = workbench_.shaftWords();
  ui_->shaftLabel->setText(!words.isEmpty() ? words.left(1).toUpper() + words.mid(1) + QLatin1Char('.')
      : missing.isEmpty()                   ? tr("The direction of the shaft is not known; the calibration needs only the tip.")
                                            : missing);
}

}  // namespace handeye
