// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "StylusPage.h"

#include "Look.h"
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
  for (QLabel* const label : { ui_->errorLabel, ui_->posesLabel })
  {
    label->setMinimumHeight(2 * label->fontMetrics().lineSpacing());
    label->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Preferred);  // a form gives others the width of their words only
  }
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
  connect(&workbench_, &HandEyeWorkbench::stylusChanged, this, &StylusPage::refresh);
}

StylusPage::~StylusPage() = default;

void StylusPage::leave()
{
  workbench_.pivot().cancel();
}

void StylusPage::showProgress()
{
  const PivotTask::State& state = workbench_.pivot().state();
  const PivotCalibrationResult& estimate = state.estimate;
  ui_->dome->setCoverage(state.coverage);
  const bool isKnown = estimate.isUsable() && std::isfinite(state.predictedTipErrorMm);
  const QString error = isKnown ? tr("%1 predicted (residuals %2 RMS)")
                                    .arg(withUnit(state.predictedTipErrorMm, 2, tr("mm")), withUnit(estimate.rmsMm, 2, tr("mm")))
                                : tr("not known yet");
  ui_->errorLabel->setText(error);
  ui_->dome->setErrorText(isKnown ? tr("tip error %1").arg(withUnit(state.predictedTipErrorMm, 2, tr("mm"))) : QString(),
    state.isEnough ? Level::Good : Level::Info);
  ui_->posesLabel->setText(tr("%1 of %2 kept; %3 not seen by the tracker, %4 disagree with the rest")
                             .arg(state.counts.kept)
                             .arg(state.counts.total())
                             .arg(state.counts.invalid)
                             .arg(state.counts.disagreeing));
  const bool isHidden = workbench_.devices().stream(workbench_.devices().setup().stylusToTracker).light != StreamList::Light::Live;
  ui_->dome->setHint(isHidden                         ? tr("the tracker does not see the stylus")
      : state.hasTipMoved                             ? tr("the tip has moved: start again")
      : state.isEnough                                ? tr("enough")
      : !estimate.isUsable() && state.counts.kept > 0 ? QString::fromStdString(estimate.message)
                                                      : tr("lean it in all directions"));
  if (state.isEnough && state.coverage.share() > 0.7)
  {
    workbench_.pivot().finish();
  }
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
}

}  // namespace handeye
