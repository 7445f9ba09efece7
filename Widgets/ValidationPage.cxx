// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ValidationPage.h"

#include "ErrorDistancePlot.h"
#include "Look.h"
#include "SampleRows.h"
#include "StatisticsTable.h"
#include "ui_ValidationPage.h"

#include <QFileDialog>
#include <QSignalBlocker>

#include <algorithm>

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
  connect(&capture, &CaptureTask::accepted, this,
    [this](int id) { ui_->hintLabel->setText(tr("Sample %1 is stored.").arg(sampleNumber(id))); });
  connect(&capture, &CaptureTask::imported, this,
    [this](const QVector<int>& ids, int refused, const QString& reason)
    {
      ui_->handsFreeBox->setChecked(false);  // live samples are not mixed into a recording's unasked
      ui_->hintLabel->setText(importedWords(ids.size(), refused, reason));
    });
  connect(&capture, &CaptureTask::samplesChanged, this, &ValidationPage::showStartOver);
  connect(ui_->startOverButton, &QPushButton::clicked, this, &ValidationPage::startOver);
  connect(ui_->bringBackButton, &QPushButton::clicked, this, &ValidationPage::bringBack);
  connect(&workbench_, &HandEyeWorkbench::resultsForgotten, this,
    [this]
    {
      setAside_.clear();
      ui_->hintLabel->clear();
    });
  connect(&capture, &CaptureTask::opened, this,
    [this]
    {
      // As on the page Capture: what is gone on with takes nothing by itself.
      const QSignalBlocker blocker(ui_->handsFreeBox);
      ui_->handsFreeBox->setChecked(workbench_.validationCapture().storedSampleCount() == 0);
    });
  showStartOver();
  connect(&workbench_.devices(), &DeviceHub::connectionChanged, ui_->hintLabel, &QLabel::clear);
  connect(&workbench_, &HandEyeWorkbench::validationChanged, this, &ValidationPage::showValidation);
}

ValidationPage::~ValidationPage() = default;

void ValidationPage::enter()
{
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

/// A capture is validated as a whole: single placements that look bad are not to be picked out.
void ValidationPage::startOver()
{
  CaptureTask& capture = workbench_.validationCapture();
  QVector<int> ids;
  for (const CaptureSample& sample : capture.samples())
  {
    if (!sample.isDeleted)
    {
      ids << sample.id;
    }
  }
  // The ball rests where it is: nothing is to be taken before the person is ready.
  ui_->handsFreeBox->setChecked(false);
  setAside_ = ids;
  capture.setDeleted(ids, true);
  ui_->hintLabel->setText(counted(ids.size(), tr("1 placement is set aside."), tr("%1 placements are set aside.")) +
    QLatin1Char(' ') + tr("Turn Hands-free on, or take one, to begin anew."));
}

void ValidationPage::bringBack()
{
  const QVector<int> ids = setAside();
  setAside_.clear();
  workbench_.validationCapture().setDeleted(ids, false);
  ui_->hintLabel->setText(tr("The placements of before are back."));
}

/// Those of the last start over; in a session that was opened again, all that were ever set aside.
QVector<int> ValidationPage::setAside() const
{
  QVector<int> ids;
  for (const CaptureSample& sample : workbench_.validationCapture().samples())
  {
    if (sample.isDeleted && (setAside_.isEmpty() || setAside_.contains(sample.id)))
    {
      ids << sample.id;
    }
  }
  return ids;
}

void ValidationPage::showStartOver()
{
  const CaptureTask& capture = workbench_.validationCapture();
  const QMap<int, CaptureSample>& samples = capture.samples();
  const int setAsideCount = setAside().size();
  ui_->startOverButton->setVisible(
    std::any_of(samples.begin(), samples.end(), [](const CaptureSample& sample) { return !sample.isDeleted; }));
  ui_->startOverButton->setEnabled(!capture.isBusy());
  ui_->bringBackButton->setVisible(setAsideCount > 0);
  ui_->bringBackButton->setEnabled(!capture.isBusy());
  ui_->bringBackButton->setText(tr("Bring %1 &back").arg(setAsideCount));
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
  if (isVisible() && isReady && isLive && ui_->handsFreeBox->isChecked())
  {
    workbench_.validationCapture().beginHandsFree();
  }
}

}  // namespace handeye
