// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BallPage.h"

#include "Look.h"
#include "StagesView.h"
#include "ui_BallPage.h"

#include <QPainter>
#include <QSignalBlocker>

#include <cmath>

namespace handeye
{

BallPage::BallPage(HandEyeWorkbench& workbench, QWidget* parent)
  : WizardPage(workbench, WizardStep::Ball, parent)
  , ui_(std::make_unique<Ui::BallPage>())
{
  ui_->setupUi(this);
  // What is said of the ball changes with every frame: the page must not move with it.
  constexpr int LinesOfFound = 3;
  ui_->foundLabel->setMinimumHeight(LinesOfFound * ui_->foundLabel->fontMetrics().lineSpacing());
  ui_->foundLabel->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Preferred);
  ui_->foundLabel->setAlignment(Qt::AlignTop | Qt::AlignLeft);
  connect(ui_->radiusSpin, qOverload<double>(&QDoubleSpinBox::valueChanged), &workbench_, &HandEyeWorkbench::setBallRadius);
  connect(ui_->forgetButton, &QToolButton::clicked, &workbench_, &HandEyeWorkbench::forgetBallColor);
  connect(ui_->undoButton, &QToolButton::clicked, &workbench_, &HandEyeWorkbench::takeFormerBallColor);
  connect(ui_->stages, &StagesView::imageClicked, this,
    [this](const QPointF& point_Image) { workbench_.learnBallColor(inStages_, point_Image); });
  connectLatency();
  connect(&workbench_.live(), &LivePipeline::shown, this, &BallPage::showFrame);
}

BallPage::~BallPage() = default;

void BallPage::connectLatency()
{
  ui_->latencyHowLabel->setText(ui_->latencyHowLabel->text().arg(LatencyTask::DefaultSec, 0, 'f', 0));
  connect(ui_->measureButton, &QPushButton::clicked, &workbench_, &HandEyeWorkbench::measureLatency);
  connect(ui_->latencyCancelButton, &QPushButton::clicked, &workbench_.latency(), &LatencyTask::cancel);
  connect(&workbench_.latency(), &LatencyTask::runningChanged, this, [this] { showLatencyProgress(0); });
  connect(&workbench_.latency(), &LatencyTask::progressed, this, &BallPage::showLatencyProgress);
  connect(&workbench_, &HandEyeWorkbench::resultsForgotten, this, [this] { measured_.clear(); });
  connect(&workbench_, &HandEyeWorkbench::latencyChanged, this,
    [this](const QString& words)
    {
      measured_ = words;
      measuredSec_ = workbench_.devices().setup().latencySec;
      refresh();
    });
}

void BallPage::showLatencyProgress(double share)
{
  const double leftSec = (1 - share) * LatencyTask::DefaultSec;
  ui_->latencyProgress->setValue(int(100 * share));
  // A person looks at the ball and the video meanwhile: what to do stands there.
  ui_->latencyProgress->setFormat(tr("swing the ball: %1 s left").arg(std::ceil(leftSec), 0, 'f', 0));
}

/// What is in use, and how well it is known.
void BallPage::showLatency()
{
  const double latencySec = workbench_.devices().setup().latencySec;
  ui_->latencyLabel->setText(latencySec == measuredSec_ && !measured_.isEmpty() ? measured_
      : latencySec != 0
      ? tr("%1 is in use, measured before or typed on the page Devices.").arg(withUnit(1000 * latencySec, 1, tr("ms")))
      : tr("Not measured: right for a ball that is held still. A moving camera needs it."));
}

void BallPage::leave()
{
  workbench_.latency().cancel();
}

void BallPage::clickInVideo(const std::shared_ptr<const LiveView>& shown, const QPointF& point_Image)
{
  workbench_.learnBallColor(shown, point_Image);
}

void BallPage::showFrame()
{
  const std::shared_ptr<const LiveView> view = workbench_.live().newest();
  if (!isVisible())
  {
    return;
  }
  if (!view || (view->problem.isEmpty() && !view->ball))
  {
    ui_->foundLabel->setText(QString(QChar(0x2013)));  // what was said of another picture, or of another lens, is over
    return;
  }
  if (view->stages)
  {
    ui_->stages->setStages(view->image(), *view->stages);
    inStages_ = view;
  }
  if (!view->problem.isEmpty())
  {
    ui_->foundLabel->setText(asSentence(view->problem));
  }
  else if (view->ball)
  {
    ui_->foundLabel->setText(view->ball->isFound() ? tr("%1 px across, %2 mm away, %3 % of its outline seen")
                                                       .arg(2 * view->ball->radiusPx, 0, 'f', 1)
                                                       .arg(view->ball->distanceMm, 0, 'f', 0)
                                                       .arg(100 * view->ball->visibleShare, 0, 'f', 0)
                                                   : asSentence(QString::fromStdString(view->ball->message)));
  }
}

void BallPage::refresh()
{
  const HandEyeWorkbench::Ball& ball = workbench_.ball();
  if (!ui_->radiusSpin->hasFocus())
  {
    const QSignalBlocker blocker(ui_->radiusSpin);
    ui_->radiusSpin->setValue(ball.radiusMm);
  }
  ui_->colorLabel->setText(HandEyeWorkbench::nameOf(ball.color, ball.isColorLearnt));
  ui_->colorLabel->setToolTip(ball.message);
  QPixmap swatch(QSize(18, 18) * devicePixelRatioF());
  swatch.setDevicePixelRatio(devicePixelRatioF());
  const double hueDeg = ball.color.hueDeg < 0 ? ball.color.hueDeg + 360 : ball.color.hueDeg;
  swatch.fill(QColor::fromHsvF(std::min(hueDeg / 360, 0.9999), 0.85, 0.8));
  ui_->swatchLabel->setPixmap(swatch);
  ui_->forgetButton->setEnabled(ball.isColorLearnt);
  ui_->undoButton->setEnabled(ball.former.has_value());
  ui_->undoButton->setToolTip(ball.former
      ? tr("Back to the colour of before: %1").arg(HandEyeWorkbench::nameOf(ball.former->color, ball.former->isLearnt))
      : tr("Back to the colour of before"));
  const bool isMeasuring = workbench_.latency().isRunning();
  ui_->measureButton->setEnabled(!isMeasuring && workbench_.camera() && workbench_.stylus() && workbench_.devices().isConnected());
  ui_->measureButton->setVisible(!isMeasuring);
  ui_->latencyProgress->setVisible(isMeasuring);
  ui_->latencyCancelButton->setVisible(isMeasuring);
  showLatency();
}

}  // namespace handeye
