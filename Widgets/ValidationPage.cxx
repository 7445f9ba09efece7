// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ValidationPage.h"

#include "ErrorDistancePlot.h"
#include "Look.h"
#include "SampleRows.h"
#include "StatisticsTable.h"
#include "ui_ValidationPage.h"

#include <QFileDialog>

#include <algorithm>
#include <utility>

namespace handeye
{

namespace
{

ErrorSeries seriesOf(const ValidationStepResult& validation)
{
  ErrorSeries series;
  series.name = ValidationPage::tr("validation");
  series.errorPx = validation.projectionErrorPx;
  for (const ValidatedFrame& frame : validation.frames)
  {
    if (frame.validated && frame.status == "ok")
    {
      series.points.push_back(QPointF(frame.validated->distanceMm, frame.validated->errorPx));
    }
  }
  return series;
}

}  // namespace

ValidationPage::ValidationPage(HandEyeWorkbench& workbench, QWidget* parent)
  : WizardPage(workbench, WizardStep::Validation, parent)
  , ui_(std::make_unique<Ui::ValidationPage>())
{
  ui_->setupUi(this);
  CaptureTask& capture = workbench_.validationCapture();
  ui_->handsFreeBox->setChecked(true);
  ui_->table->setEditable(false);
  ui_->table->setResidualTitle(tr("Error"));
  connect(ui_->handsFreeBox, &QCheckBox::toggled, &capture, &CaptureTask::setHandsFree);
  connect(ui_->takeButton, &QPushButton::clicked, &capture, &CaptureTask::takeNow);
  connect(ui_->recordingButton, &QPushButton::clicked, this,
    [this]
    {
      const QString path = QFileDialog::getOpenFileName(
        this, tr("Recording to validate on"), {}, tr("Sequence metafiles (*.mha *.igs.mha);;All files (*)"));
      if (!path.isEmpty())
      {
        workbench_.validationCapture().importRecording(path);
      }
    });
  connect(ui_->againButton, &QPushButton::clicked, &capture, &CaptureTask::evaluateAgain);
  connect(&capture, &CaptureTask::hintChanged, this,
    [this] { ui_->hintLabel->setText(asSentence(workbench_.validationCapture().hint())); });
  connect(&capture, &CaptureTask::accepted, this, [this](int id) { ui_->hintLabel->setText(tr("Sample %1 is stored.").arg(sampleNumber(id))); });
  connect(&capture, &CaptureTask::imported, this,
    [this](const QVector<int>& ids, int refused, const QString& reason)
    { ui_->hintLabel->setText(importedWords(ids.size(), refused, reason)); });
  connect(&capture, &CaptureTask::samplesChanged, this, &ValidationPage::showStartOver);
  connect(ui_->startOverButton, &QPushButton::clicked, this, &ValidationPage::startOver);
  connect(&workbench_, &HandEyeWorkbench::resultsForgotten, this,
    [this]
    {
      setAside_.clear();
      ui_->hintLabel->clear();
    });
  showStartOver();
  connect(&workbench_.devices(), &DeviceHub::connectionChanged, ui_->hintLabel, &QLabel::clear);
  connect(&workbench_, &HandEyeWorkbench::validationChanged, this, &ValidationPage::showValidation);
}

ValidationPage::~ValidationPage() = default;

void ValidationPage::enter()
{
  if (ui_->handsFreeBox->isChecked() && workbench_.missingFor(step()).isEmpty())
  {
    workbench_.validationCapture().beginHandsFree();
  }
  showValidation();
}

bool ValidationPage::keyInVideo(int key)
{
  if (key == Qt::Key_Space)
  {
    workbench_.validationCapture().takeNow();
    return true;
  }
  return false;
}

void ValidationPage::showValidation()
{
  const std::optional<ValidationStepResult>& validation = workbench_.validation();
  const QVector<ErrorSeries> series = validation ? QVector<ErrorSeries>{ seriesOf(*validation) } : QVector<ErrorSeries>();
  ui_->plot->setSeries(series);
  ui_->statistics->setSeries(series);
  ui_->table->setRows(validationRows(workbench_.validationCapture().samples(), validation));
  // A verdict that opens Next stands beside it.
  const QString verdict =
    validation ? asSentence(QString::fromStdString(validation->message)) : tr("No placements to test on yet.");
  ui_->verdictLabel->setText(workbench_.problemOf(WizardStep::Validation).isEmpty() ? QString() : verdict);
  ui_->verdictLabel->setVisible(!ui_->verdictLabel->text().isEmpty());
}

/// A page is validated as a whole: single placements that look bad are not to be picked out.
void ValidationPage::startOver()
{
  CaptureTask& capture = workbench_.validationCapture();
  if (!setAside_.isEmpty())
  {
    capture.setDeleted(std::exchange(setAside_, {}), false);
    ui_->hintLabel->setText(tr("The placements of before are back."));
    return;
  }
  QVector<int> ids;
  for (const CaptureSample& sample : capture.samples())
  {
    if (!sample.isDeleted)
    {
      ids << sample.id;
    }
  }
  setAside_ = ids;
  capture.setDeleted(ids, true);
  ui_->hintLabel->setText(counted(ids.size(), tr("1 placement is set aside; the next one begins a new validation."),
    tr("%1 placements are set aside; the next one begins a new validation.")));
}

void ValidationPage::showStartOver()
{
  const QMap<int, CaptureSample>& samples = workbench_.validationCapture().samples();
  const bool isAny = std::any_of(samples.begin(), samples.end(), [](const CaptureSample& sample) { return !sample.isDeleted; });
  if (isAny)
  {
    setAside_.clear();
  }
  ui_->startOverButton->setText(setAside_.isEmpty() ? tr("Start &over") : tr("Bring &back"));
  ui_->startOverButton->setToolTip(setAside_.isEmpty()
      ? tr("Sets all placements of the validation aside, which a wrong recording may have brought, and begins anew")
      : tr("Brings the placements back that were set aside"));
  ui_->startOverButton->setVisible(isAny || !setAside_.isEmpty());
  ui_->startOverButton->setEnabled(!workbench_.validationCapture().isBusy());
}

void ValidationPage::refresh()
{
  const bool isReady = workbench_.missingFor(WizardStep::Validation).isEmpty();
  const bool isLive = workbench_.devices().isConnected();
  ui_->handsFreeBox->setEnabled(isReady && isLive);
  ui_->takeButton->setEnabled(isReady && isLive);
  ui_->recordingButton->setEnabled(isReady && !workbench_.validationCapture().isBusy());
  ui_->againButton->setVisible(workbench_.validationCapture().isBroken());
  showStartOver();
}

}  // namespace handeye
