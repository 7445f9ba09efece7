// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FinishPage.h"

#include "CalibrationExport.h"
#include "Look.h"
#include "ui_FinishPage.h"

#include <QFileInfo>
#include <QUrl>

namespace handeye
{

FinishPage::FinishPage(HandEyeWorkbench& workbench, QWidget* parent)
  : WizardPage(workbench, WizardStep::Finish, parent)
  , ui_(std::make_unique<Ui::FinishPage>())
{
  ui_->setupUi(this);
  ui_->sessionLabel->setOpenExternalLinks(true);
  connect(ui_->exports, &ExportPanel::reportRequested, &workbench_,
    [this](const QString& folder) { workbench_.writeReport(folder + QStringLiteral("/report")); });
  connect(&workbench_, &HandEyeWorkbench::reportWritten, this,
    [this](const QString& path)
    {
      ui_->exports->addWrittenFile(path, tr("report of the validation"));
      refresh();
    });
  connect(ui_->exports, &ExportPanel::exported, &workbench_,
    [this](const QStringList& files)
    {
      if (!files.isEmpty())
      {
        workbench_.setExported(ui_->exports->folder());
      }
    });
  ui_->reportLabel->setOpenExternalLinks(true);
  // What could be exported was the session's before; a page that is shown has the new one's at once.
  connect(&workbench_, &HandEyeWorkbench::resultsForgotten, this, [this] { ui_->exports->setSources({}); });
  connect(&workbench_, &HandEyeWorkbench::calibrationChanged, this, &FinishPage::renew);
  connect(&workbench_, &HandEyeWorkbench::validationChanged, this, &FinishPage::renew);
  connect(&workbench_, &HandEyeWorkbench::registrationChanged, this, &FinishPage::renew);
  connect(&workbench_, &HandEyeWorkbench::sessionOpened, this, &FinishPage::renew);
  connect(&workbench_, &HandEyeWorkbench::refused, this,
    [this](WizardStep step, const QString& message)
    {
      if (step == WizardStep::Finish)
      {
        ui_->exports->showError(message);
      }
    });
}

FinishPage::~FinishPage() = default;

void FinishPage::renew()
{
  if (isVisible())
  {
    enter();
  }
}

void FinishPage::enter()
{
  const auto fileOf = [this](const char* name) { return workbench_.documentPath(QString::fromLatin1(name)).toStdString(); };
  ExportSources sources;
  const bool isCalibrated = workbench_.calibration() && workbench_.calibration()->isUsable();
  if (isCalibrated)
  {
    sources.calibration = fileOf("calibration");
  }
  if (isCalibrated && workbench_.stylus())
  {
    sources.stylus = fileOf("stylus");
  }
  if (isCalibrated && workbench_.registrationOfModel())
  {
    sources.registration = fileOf("phantom");
    sources.model = workbench_.modelPath().toStdString();
  }
  ui_->exports->setSources(sources);
  // Another session's exports are not put beside those of the one before.
  if (ui_->exports->folder().isEmpty() || exportsOf_ != workbench_.sessionFolder())
  {
    exportsOf_ = workbench_.sessionFolder();
    ui_->exports->setFolder(workbench_.sessionFolder() + QStringLiteral("/export"));
  }
  const bool isValidated = workbench_.validation() && workbench_.validation()->isUsable();
  ui_->exports->setReportEnabled(isValidated, isValidated ? QString() : tr("There is no validation yet: see the page Validation."));
}

/// With its colour: a label does not look at the palette's again when that changes.
QString FinishPage::linkTo(const QString& path, const QString& words) const
{
  return QStringLiteral("<a href=\"%1\" style=\"color:%3\">%2</a>")
    .arg(QUrl::fromLocalFile(path).toString(), words.toHtmlEscaped(), linkColor(palette()).name());
}

void FinishPage::refresh()
{
  const QString folder = workbench_.sessionFolder();
  ui_->sessionLabel->setText(folder.isEmpty()
      ? tr("No session is open.")
      : tr("Everything is stored in %1; nothing needs to be saved.").arg(linkTo(folder, folder)));
  // Where it is seen without scrolling.
  const QString report = workbench_.reportFile();
  ui_->reportLabel->setVisible(!report.isEmpty());
  ui_->reportLabel->setText(tr("Report of the validation: %1").arg(linkTo(report, QFileInfo(report).fileName())));
  QStringList lines;
  for (const WizardStep step : { WizardStep::Stylus, WizardStep::Capture, WizardStep::Validation, WizardStep::Overlay })
  {
    const QString verdict = workbench_.verdictOf(step);
    const QString problem = workbench_.problemOf(step);
    const char* const names[] = { "", "", QT_TR_NOOP("Stylus"), "", QT_TR_NOOP("Calibration"), QT_TR_NOOP("Validation"), "",
      QT_TR_NOOP("Phantom") };
    const Level level = problem.isEmpty() ? workbench_.levelOf(step) : Level::Info;
    lines << QStringLiteral("<tr><td>%1: </td><td style=\"color:%3\">%2</td></tr>")
               .arg(tr(names[int(step)]), asSentence(problem.isEmpty() ? verdict : problem).toHtmlEscaped(),
                 levelColor(level, palette()).name());
  }
  ui_->summaryLabel->setText(QStringLiteral("<table cellspacing='4'>") + lines.join(QString()) + QStringLiteral("</table>"));
}

}  // namespace handeye
