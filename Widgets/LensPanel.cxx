// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LensPanel.h"

#include "BoardPrint.h"
#include "LensCoverageView.h"
#include "Look.h"
#include "ui_LensPanel.h"

#include <QFileDialog>
#include <QFileInfo>

namespace handeye
{

namespace
{

QString resultText(const LensCalibrationResult& result)
{
  const CameraModel& lens = *result.camera;
  const Eigen::Vector4d& sigma = result.cameraMatrixSigmas;
  const auto number = [](double value, int digits) { return QLocale().toString(value, 'f', digits); };
  QString text = LensPanel::tr("<p>%1</p><table cellspacing='4'>"
                               "<tr><td>Focal length:</td><td>%2 x %3 px<br>(± %4, %5 px)</td></tr>"
                               "<tr><td>Principal point:</td><td>%6, %7 px<br>(± %8, %9 px)</td></tr>")
                   .arg(asSentence(QString::fromStdString(result.message)).toHtmlEscaped(), number(lens.fx(), 2),
                     number(lens.fy(), 2), number(sigma(0), 2), number(sigma(1), 2), number(lens.cx(), 2), number(lens.cy(), 2),
                     number(sigma(2), 2), number(sigma(3), 2));
  text += LensPanel::tr("<tr><td>Residuals:</td><td>%1 px RMS, %2 views</td></tr></table>")
            .arg(number(result.rmsPx, 3))
            .arg(result.usedCount);
  if (!result.modelHint.empty())
  {
    text += LensPanel::tr("<p>Lens model: %1</p>").arg(asSentence(QString::fromStdString(result.modelHint)).toHtmlEscaped());
  }
  for (std::size_t i = 0; i < result.views.size(); ++i)
  {
    if (!result.views[i].used)
    {
      text += LensPanel::tr("<p>View %1 left out: %2</p>")
                .arg(i + 1)
                .arg(QString::fromStdString(result.views[i].message).toHtmlEscaped());
    }
  }
  return text;
}

/// The board's description for a person who holds the board in the hands.
QString inWords(const BoardDescription& board)
{
  const QString size = LensPanel::tr("%1 x %2").arg(board.columns).arg(board.rows);
  const QString mm = QLocale().toString(board.spacingMm, 'g', 4);
  switch (board.kind)
  {
    case BoardDescription::Kind::Chessboard:
      return LensPanel::tr("Chessboard: %1 inner corners, squares of %2 mm").arg(size, mm);
    case BoardDescription::Kind::Charuco:
      return LensPanel::tr("ChArUco: %1 squares of %2 mm, markers %3 mm").arg(size, mm, QLocale().toString(board.markerMm, 'g', 4));
    case BoardDescription::Kind::Circles:
      return LensPanel::tr("Circles: %1, %2 mm apart").arg(size, mm);
    case BoardDescription::Kind::AsymmetricCircles:
      return LensPanel::tr("Staggered circles: %1, spacing %2 mm").arg(size, mm);
  }
  return {};
}

}  // namespace

LensPanel::LensPanel(HandEyeWorkbench& workbench, QWidget* parent)
  : QGroupBox(parent)
  , workbench_(workbench)
  , ui_(std::make_unique<Ui::LensPanel>())
{
  ui_->setupUi(this);
  LensTask& lens = workbench_.lens();
  connect(ui_->boardCombo, &QComboBox::editTextChanged, this, &LensPanel::refresh);
  connect(ui_->printButton, &QPushButton::clicked, this, &LensPanel::printBoard);
  connect(ui_->recordingButton, &QPushButton::clicked, this, &LensPanel::openRecording);
  connect(ui_->startButton, &QPushButton::clicked, this, &LensPanel::toggle);
  connect(ui_->calibrateButton, &QPushButton::clicked, this,
    [this] { workbench_.lens().isWorking() ? workbench_.lens().cancel() : workbench_.lens().calibrate(); });
  connect(ui_->clearButton, &QPushButton::clicked, this,
    [this]
    {
      refusal_.clear();
      workbench_.lens().clear();
    });
  connect(ui_->useButton, &QPushButton::clicked, &workbench_, &HandEyeWorkbench::useCalibratedLens);
  connect(&lens, &LensTask::progressed, this, &LensPanel::showProgress);
  connect(&lens, &LensTask::changed, this, &LensPanel::refresh);
  connect(&lens, &LensTask::calibrated, this,
    [this]
    {
      refusal_.clear();
      showResult();
    });
  connect(&lens, &LensTask::refused, this,
    [this](const QString& message)
    {
      refusal_ = message;
      showResult();
    });
  connect(&lens, &LensTask::worked, this,
    [this](int done, int total)
    {
      ui_->progressBar->setRange(0, done < total ? total : 0);
      ui_->progressBar->setValue(done);
    });
  refresh();
}

LensPanel::~LensPanel() = default;

/// What the text describes, which stands below it in words; otherwise why not.
std::optional<BoardDescription> LensPanel::board() const
{
  QString words;
  std::optional<BoardDescription> board;
  try
  {
    board = parseBoard(ui_->boardCombo->currentText().trimmed().toStdString());
  }
  catch (const std::exception& error)
  {
    words = asSentence(QString::fromUtf8(error.what()));
  }
  ui_->boardProblemLabel->setText(board ? inWords(*board) : words);
  return board;
}

void LensPanel::toggle()
{
  LensTask& lens = workbench_.lens();
  if (lens.isCollecting())
  {
    lens.stop();
  }
  else if (const std::optional<BoardDescription> chosen = board())
  {
    refusal_.clear();
    ui_->progressBar->setRange(0, 0);
    lens.start(*chosen);
  }
}

void LensPanel::printBoard()
{
  const std::optional<BoardDescription> chosen = board();
  const QString path = chosen
    ? QFileDialog::getSaveFileName(this, tr("Print the board"), QStringLiteral("board.pdf"), tr("PDF (*.pdf);;Picture (*.png)"))
    : QString();
  if (path.isEmpty())
  {
    return;
  }
  try
  {
    const io::PrintedBoard printed = io::printBoard(path.toStdString(), *chosen);
    ui_->hintLabel->setText(tr("Written to %1 (%2 x %3 mm). Print it at 100 %, glue it onto something flat, and measure its ruler.")
                              .arg(path)
                              .arg(printed.pageWidthMm, 0, 'f', 0)
                              .arg(printed.pageHeightMm, 0, 'f', 0));
  }
  catch (const std::exception& error)
  {
    refusal_ = QString::fromUtf8(error.what());
    showResult();
  }
}

void LensPanel::openRecording()
{
  const std::optional<BoardDescription> chosen = board();
  const QString path = chosen ? QFileDialog::getOpenFileName(this, tr("Recording of the board"), {},
                                  tr("Recordings and pictures (*.mha *.jpg *.jpeg *.png *.bmp *.tif *.tiff);;All files (*)"))
                              : QString();
  if (path.isEmpty())
  {
    return;
  }
  // A picture stands for its recording: the folder that has frames/.
  const QFileInfo file(path);
  refusal_.clear();
  ui_->progressBar->setRange(0, 0);
  workbench_.lens().calibrateRecording(
    file.suffix().toLower() == QLatin1String("mha") ? path : QFileInfo(file.path()).path(), *chosen);
}

void LensPanel::showProgress()
{
  const LensTask::State& state = workbench_.lens().state();
  ui_->calibrateButton->setEnabled(workbench_.lens().isWorking() ? !workbench_.lens().isCancelling() : state.pictures > 0);
  ui_->coverageView->setState(state);
  ui_->countLabel->setText(tr("%1, %2 % of the image covered; the board was seen in %3 of %4 pictures")
                             .arg(counted(state.views, tr("1 view"), tr("%1 views")))
                             .arg(100 * state.coverageShare, 0, 'f', 0)
                             .arg(state.withBoard)
                             .arg(state.pictures));
  QStringList hints;
  for (const QString& hint : { state.wasTaken ? tr("View taken.") : state.seen, state.hint })
  {
    if (!hint.isEmpty() && !hints.contains(hint))
    {
      hints << hint.left(1).toUpper() + hint.mid(1);
    }
  }
  ui_->hintLabel->setText(hints.join(QLatin1Char('\n')));
}

void LensPanel::showResult()
{
  const std::optional<LensTask::Result>& result = workbench_.lens().result();
  const bool isUsable = result && result->calibration.isUsable();
  ui_->resultLabel->setText(!refusal_.isEmpty() ? refusal_.toHtmlEscaped()
      : isUsable                                ? resultText(result->calibration)
                                                : QString());
  ui_->resultLabel->setVisible(!ui_->resultLabel->text().isEmpty());
  ui_->useButton->setVisible(isUsable);
}

void LensPanel::refresh()
{
  const LensTask& lens = workbench_.lens();
  const bool isIdle = !lens.isCollecting() && !lens.isWorking(), hasBoard = board().has_value();
  ui_->boardCombo->setEnabled(isIdle);
  ui_->printButton->setEnabled(hasBoard);
  ui_->recordingButton->setEnabled(isIdle && hasBoard);
  ui_->startButton->setEnabled(hasBoard && !lens.isWorking() && workbench_.devices().isConnected());
  ui_->startButton->setText(lens.isCollecting() ? tr("&Stop taking views") : tr("&Start taking views"));
  ui_->calibrateButton->setText(!lens.isWorking() ? tr("&Calibrate") : lens.isCancelling() ? tr("Stopping…") : tr("&Cancel"));
  ui_->clearButton->setEnabled(isIdle && lens.state().pictures > 0);
  ui_->progressBar->setVisible(lens.isWorking());
  showProgress();
  if (lens.state().pictures == 0 && isIdle)
  {
    ui_->hintLabel->setText(workbench_.devices().isConnected()
        ? tr("Press Start taking views and show the board to the camera from all sides.")
        : tr("No camera is connected: connect one on the page Devices, or take a recording."));
  }
  showResult();
}

}  // namespace handeye
