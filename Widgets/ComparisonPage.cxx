// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ComparisonPage.h"

#include "ComparisonTable.h"
#include "ErrorDistancePlot.h"
#include "Look.h"
#include "ReportPlots.h"
#include "ui_ComparisonPage.h"

#include <QDesktopServices>
#include <QFileDialog>
#include <QFileInfo>
#include <QHeaderView>
#include <QLineEdit>
#include <QLocale>
#include <QUrl>

namespace handeye
{

namespace
{

/// What the report draws, for the window.
QVector<ErrorSeries> seriesOf(const ComparisonResult& result, const std::optional<report::Plot>& plot)
{
  QVector<ErrorSeries> all;
  for (std::size_t index = 0; index < result.methods.size(); ++index)
  {
    const MethodResult& method = result.methods[index];
    ErrorSeries series;
    series.look = lookOfMethod(result, index);
    series.name = QString::fromStdString(method.name);
    series.errorPx = method.errorPx;
    for (const report::PlotSeries& drawn : plot ? plot->series : std::vector<report::PlotSeries>())
    {
      for (std::size_t i = 0; drawn.label == method.name && i < drawn.x.size(); ++i)
      {
        series.points.push_back(QPointF(drawn.x[i], drawn.y[i]));
      }
    }
    all.push_back(series);
  }
  return all;
}

QString recordingOf(const QString& path)
{
  // A picture stands for its recording: the folder that has frames/; a session's file for the session.
  const QFileInfo file(path);
  const QString ending = file.suffix().toLower();
  return ending == QLatin1String("json")             ? file.path()
    : ending == QLatin1String("mha") || file.isDir() ? path
                                                     : QFileInfo(file.path()).path();
}

}  // namespace

ComparisonPage::ComparisonPage(HandEyeWorkbench& workbench, QWidget* parent)
  : WizardPage(workbench, WizardStep::Comparison, parent)
  , ui_(std::make_unique<Ui::ComparisonPage>())
{
  ui_->setupUi(this);
  ui_->repeatabilityTable->horizontalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
  ui_->repeatabilityTable->horizontalHeader()->setSectionResizeMode(0, QHeaderView::Stretch);
  ui_->boardCombo->lineEdit()->setCursorPosition(0);  // the kind of board is what comes first
  connectButtons();
  ComparisonTask& task = workbench_.comparison();
  connect(&task, &ComparisonTask::progressed, this, &ComparisonPage::showProgress);
  connect(&task, &ComparisonTask::changed, this, &ComparisonPage::refresh);
  connect(&task, &ComparisonTask::reportWritten, this, &ComparisonPage::showReport);
  connect(&task, &ComparisonTask::finished, this, &ComparisonPage::showResult);
  connect(&workbench_, &HandEyeWorkbench::sessionOpened, this,
    [this]
    {
      boardRecording_.clear();
      otherCaptures_.clear();
      ui_->reportLabel->hide();
      showResult();
      const QString report = workbench_.comparisonFolder() + QStringLiteral("/report.html");
      if (!workbench_.storedComparison().isEmpty() && QFileInfo::exists(report))
      {
        linkReport(report);
      }
    });
  showResult();
}

ComparisonPage::~ComparisonPage() = default;

void ComparisonPage::connectButtons()
{
  const QString kinds = tr("Recordings and pictures (*.mha *.jpg *.jpeg *.png *.bmp session.json);;All files (*)");
  connect(ui_->boardCombo, &QComboBox::editTextChanged, this, &ComparisonPage::refresh);
  connect(ui_->boardButton, &QPushButton::clicked, this,
    [this, kinds]
    {
      const QString path = QFileDialog::getOpenFileName(this, tr("Recording of a board that stands still"), {}, kinds);
      if (!path.isEmpty())
      {
        chooseBoardRecording(recordingOf(path));
      }
    });
  connect(ui_->noBoardButton, &QPushButton::clicked, this, [this] { chooseBoardRecording({}); });
  connect(ui_->captureButton, &QPushButton::clicked, this,
    [this, kinds]
    {
      const QString path = QFileDialog::getOpenFileName(this, tr("Another capture of the ball"), {}, kinds);
      if (!path.isEmpty())
      {
        addCapture(recordingOf(path));
      }
    });
  connect(ui_->noCaptureButton, &QPushButton::clicked, this,
    [this]
    {
      otherCaptures_.clear();
      refresh();
    });
  connect(ui_->compareButton, &QPushButton::clicked, this, &ComparisonPage::start);
  connect(ui_->stopButton, &QPushButton::clicked, &workbench_.comparison(), &ComparisonTask::cancel);
  connect(
    ui_->reportButton, &QPushButton::clicked, this, [this] { workbench_.comparison().writeReport(workbench_.comparisonFolder()); });
}

void ComparisonPage::chooseBoardRecording(const QString& path)
{
  boardRecording_ = path;
  refresh();
}

void ComparisonPage::addCapture(const QString& path)
{
  if (!otherCaptures_.contains(path))
  {
    otherCaptures_ << path;
  }
  refresh();
}

/// What the text describes; otherwise why not stands below it.
std::optional<BoardDescription> ComparisonPage::board() const
{
  QString problem;
  std::optional<BoardDescription> board;
  try
  {
    board = parseBoard(ui_->boardCombo->currentText().trimmed().toStdString());
  }
  catch (const std::exception& error)
  {
    problem = boardRecording_.isEmpty() ? QString() : QString::fromUtf8(error.what());
  }
  ui_->boardProblemLabel->setText(problem);
  ui_->boardProblemLabel->setVisible(!problem.isEmpty());
  return board;
}

void ComparisonPage::start()
{
  HandEyeWorkbench::ComparisonExtras extras;
  extras.boardRecording = boardRecording_;
  extras.board = board();
  extras.otherCaptures = otherCaptures_;
  extras.branchAndBoundSec = ui_->limitSpin->value();
  ui_->reportLabel->hide();
  workbench_.compare(extras);
}

void ComparisonPage::showProgress(const QString& what, int done, int total)
{
  ui_->progressBar->setRange(0, total);
  ui_->progressBar->setValue(done);
  ui_->progressLabel->setText(total > 0 ? tr("%1: %2 of %3").arg(what).arg(done).arg(total) : what + QChar(0x2026));
}

void ComparisonPage::refresh()
{
  if (ui_->reportLabel->isVisibleTo(this) && !linkedReport_.isEmpty())
  {
    linkReport(linkedReport_);  // with the links' colour of now
  }
  const ComparisonTask& task = workbench_.comparison();
  const bool isIdle = !task.isWorking(), isReady = workbench_.missingFor(step()).isEmpty();
  const bool hasBoard = board().has_value() || boardRecording_.isEmpty();
  for (QWidget* choice : std::initializer_list<QWidget*>{ ui_->boardCombo, ui_->boardButton, ui_->captureButton, ui_->limitSpin })
  {
    choice->setEnabled(isIdle);
  }
  ui_->noBoardButton->setEnabled(isIdle && !boardRecording_.isEmpty());
  ui_->noCaptureButton->setEnabled(isIdle && !otherCaptures_.isEmpty());
  ui_->boardLabel->setText(boardRecording_.isEmpty()
      ? tr("No board: only the methods with the ball are compared. With a recording of a board that stands still while the camera "
           "moves, the classical ones are, too.")
      : tr("Board: %1").arg(boardRecording_));
  ui_->captureLabel->setText(otherCaptures_.isEmpty()
      ? tr("Repeatability: from random halves of this session's samples; better from captures that are independent.")
      : tr("Further captures: %1").arg(otherCaptures_.join(QStringLiteral(", "))));
  ui_->compareButton->setEnabled(isIdle && isReady && hasBoard);
  ui_->stopButton->setEnabled(task.isWorking() && !task.isCancelling());
  ui_->stopButton->setText(task.isCancelling() ? tr("Stopping…") : tr("&Stop"));
  ui_->progressBar->setVisible(task.isWorking());
  ui_->progressLabel->setVisible(task.isWorking());
  ui_->reportButton->setEnabled(isIdle && task.result() != nullptr);
  ui_->staleLabel->setVisible(workbench_.isComparisonStale());
}

void ComparisonPage::showResult()
{
  const std::shared_ptr<const SessionComparison> comparison = workbench_.comparison().result();
  const bool hasResult = comparison != nullptr;
  const ComparisonResult result = hasResult ? comparison->result : ComparisonResult();
  const QString& stored = workbench_.storedComparison();
  ui_->verdictLabel->setText(hasResult ? QString::fromStdString(result.message)
      : stored.isEmpty()               ? QString()
                                       : tr("Compared before: %1 Compare again for the table and the plots.").arg(stored));
  ui_->verdictLabel->setVisible(!ui_->verdictLabel->text().isEmpty());
  ui_->table->setResult(result);
  ui_->table->setVisible(hasResult);
  ui_->signsLabel->setVisible(hasResult);
  ui_->tabs->setVisible(hasResult);
  showPlots(result);
  showRepeatability(result);
  refresh();
}

void ComparisonPage::showPlots(const ComparisonResult& result)
{
  const std::optional<report::Plot> distance = report::errorAgainstDistance(result.methods);
  ErrorPlotAxes axes;
  axes.isLogarithmic = distance && distance->isLogarithmic;
  ui_->distancePlot->setAxes(axes);
  ui_->distancePlot->setSeries(seriesOf(result, distance));
  const std::optional<report::Plot> samples = report::errorAgainstSamples(result.methods);
  axes.isLogarithmic = samples && samples->isLogarithmic;
  axes.isJoined = true;
  axes.xTitle = tr("Samples in random subsets");
  axes.yTitle = tr("Median of the mean errors [px]");
  axes.xUnit = tr("samples");
  axes.description =
    tr("Median of the mean projection errors (px) of random subsets against their number of samples, a line a method.");
  axes.leastAir = 0.5;
  ui_->samplesPlot->setAxes(axes);
  ui_->samplesPlot->setSeries(seriesOf(result, samples));
}

void ComparisonPage::showRepeatability(const ComparisonResult& result)
{
  const QLocale locale;
  QTableWidget* table = ui_->repeatabilityTable;
  table->setRowCount(0);
  bool areHalves = false;
  for (const int index : comparisonOrder(result))
  {
    const MethodResult& method = result.methods[std::size_t(index)];
    const Repeatability& spread = method.repeatability;
    if (spread.attempts == 0)
    {
      continue;
    }
    areHalves = areHalves || spread.areHalves;
    const bool isKnown = spread.calibrations > 1;
    const auto number = [&](double value, int digits)
    { return isKnown ? locale.toString(value, 'f', digits) : QString(QChar(0x2013)); };
    const QString texts[] = { QString::fromStdString(method.name), number(spread.rotationDeg, 2), number(spread.translationMm, 2),
      number(spread.projectionPx, 2), tr("%1 of %2").arg(spread.calibrations).arg(spread.attempts) };
    const int row = table->rowCount();
    table->insertRow(row);
    for (int column = 0; column < table->columnCount(); ++column)
    {
      auto* item = new QTableWidgetItem(texts[column]);
      item->setTextAlignment(int((column == 0 ? Qt::AlignLeft : Qt::AlignRight) | Qt::AlignVCenter));
      table->setItem(row, column, item);
    }
  }
  ui_->repeatabilityLabel->setText(areHalves
      ? tr("How far calibrations from random halves of the samples are from each other (RMS); whole captures would be about 1.4 "
           "times "
           "more alike. What is wrong in all of them is not seen.")
      : tr("How far the calibrations of the captures are from each other (RMS). What is wrong in all of them is not seen."));
}

void ComparisonPage::linkReport(const QString& path)
{
  linkedReport_ = path;
  const QUrl report = QUrl::fromLocalFile(path), folder = QUrl::fromLocalFile(QFileInfo(path).path());
  ui_->reportLabel->setText(
    tr("<a href=\"%1\" style=\"color:%4\">report.html</a> and report.pdf are in <a href=\"%2\" style=\"color:%4\">%3</a>.")
      .arg(report.toString(), folder.toString(), QFileInfo(path).path().toHtmlEscaped(), linkColor(palette()).name()));
  ui_->reportLabel->show();
}

/// The browser shows it; where it is stands on the page, for whoever has none.
void ComparisonPage::showReport(const QString& path)
{
  linkReport(path);
  const QUrl report = QUrl::fromLocalFile(path), folder = QUrl::fromLocalFile(QFileInfo(path).path());
  if (!QDesktopServices::openUrl(report))
  {
    QDesktopServices::openUrl(folder);
  }
}

}  // namespace handeye
