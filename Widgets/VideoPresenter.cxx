// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "VideoPresenter.h"

#include "EightBitImage.h"
#include "SphereCone.h"
#include "vtkHandEyeOverlayPipeline.h"

#include <algorithm>
#include <cmath>

namespace handeye
{

namespace
{

constexpr int OutlinePoints = 64;
/// Without a picture for so long a video has stopped; one that has few pictures a second may take longer.
constexpr int SilenceMs = 1500, LongestSilenceMs = 5000;
constexpr double SilentIntervals = 2.5;

QPointF toPoint(const Eigen::Vector2d& point_Image)
{
  return { point_Image.x(), point_Image.y() };
}

/// The outline that a ball has in the image; empty where it is not seen.
QPolygonF outlineOf(const Eigen::Vector3d& ball_Camera, double radiusMm, const CameraModel& camera)
{
  QPolygonF polygon;
  const double distanceMm = ball_Camera.norm();
  if (distanceMm > radiusMm)
  {
    const SphereCone cone{ ball_Camera / distanceMm, std::asin(radiusMm / distanceMm) };
    for (const Eigen::Vector2d& point_Image : cone.outline(camera, OutlinePoints).points_Image)
    {
      polygon << toPoint(point_Image);
    }
  }
  return polygon;
}

}  // namespace

VideoPresenter::VideoPresenter(HandEyeWorkbench& workbench, VideoView& view, QObject* parent)
  : QObject(parent)
  , workbench_(workbench)
  , view_(view)
  , overlay_(new OverlayPresenter(workbench, view, this))
{
  connect(&workbench_.live(), &LivePipeline::shown, this, &VideoPresenter::showFrame);
  connect(&view_, &VideoView::rendered, this, [this] { onScreen_ = given_; });
  connect(&workbench_, &HandEyeWorkbench::cameraChanged, this, &VideoPresenter::setLens);
  connect(&workbench_, &HandEyeWorkbench::calibrationChanged, this, &VideoPresenter::showGhost);
  connect(&workbench_, &HandEyeWorkbench::stepEntered, this,
    [this]
    {
      // What belonged to the page before goes at once, not with the next frame.
      sinceShown_.invalidate();
      showFrame();
      showGhost();
    });
  connect(&workbench_.capture(), &CaptureTask::accepted, &view_, &VideoView::flash);
  connect(&workbench_.validationCapture(), &CaptureTask::accepted, &view_, &VideoView::flash);
  // A picture that stands still looks live, and is not.
  silence_.setSingleShot(true);
  silence_.setInterval(SilenceMs);
  connect(&silence_, &QTimer::timeout, this,
    [this]
    {
      view_.setBanner(tr("No new picture arrives: this one is old."), Level::Error);
      overlay_->leaveOldPicture(silence_.interval());
    });
  connect(&workbench_.devices(), &DeviceHub::connectionChanged, this,
    [this]
    {
      if (!workbench_.devices().isConnected())
      {
        silence_.stop();
        given_.reset();
        onScreen_.reset();
        view_.setFrame({});
        view_.setDetection({});
        view_.setBanner({}, Level::Info);
      }
    });
  catchUp_.setSingleShot(true);
  connect(&catchUp_, &QTimer::timeout, this, &VideoPresenter::showFrame);
  view_.setPlaceholderText(tr("No video. Connect devices on the page Devices."));
  setLens();
}

void VideoPresenter::setLens()
{
  if (workbench_.camera())
  {
    view_.pipeline()->SetCameraModel(workbench_.camera()->file.camera);
    hasLens_ = true;
    view_.requestRender();
  }
}

void VideoPresenter::showFrame()
{
  const std::shared_ptr<const LiveView> shown = workbench_.live().newest();
  if (!shown)
  {
    given_.reset();
    onScreen_.reset();
    view_.setFrame({});
    view_.setDetection({});
    overlay_->hide({});
    return;
  }
  // Where drawing is slow (OpenGL in software), at least half of the time is left to everything else.
  const qint64 waitMs = sinceShown_.isValid() ? 2 * costMs_ - sinceShown_.elapsed() : 0;
  if (waitMs > 0)
  {
    if (!catchUp_.isActive())
    {
      catchUp_.start(int(waitMs));
    }
    return;
  }
  catchUp_.stop();
  if (sinceShown_.isValid())
  {
    silence_.setInterval(std::clamp(int(SilentIntervals * double(sinceShown_.elapsed())), SilenceMs, LongestSilenceMs));
  }
  silence_.start();
  sinceShown_.start();
  QTimer::singleShot(0, this, [this] { costMs_ = sinceShown_.elapsed(); });
  try
  {
    view_.setFrame(toEightBit(shown->image()));
    given_ = shown;
    view_.setBanner(shown->problem, Level::Error);
    showBall(*shown);
    overlay_->show(*shown);
  }
  catch (const std::invalid_argument& error)
  {
    view_.setBanner(QString::fromUtf8(error.what()), Level::Error);
  }
}

void VideoPresenter::showBall(const LiveView& shown)
{
  if (!shown.ball || !workbench_.live().settings().detects)
  {
    view_.setDetection({});
    return;
  }
  VideoView::DetectionMark mark;
  const BallDetection& ball = *shown.ball;
  mark.level = ball.isFound() ? Level::Good : Level::Warning;
  if (ball.isFound() && workbench_.camera())
  {
    mark.ball_Image_Px = toPoint(ball.ball_Image);
    mark.outline_Image_Px =
      outlineOf(ball.ray_Camera * ball.distanceMm, workbench_.ball().radiusMm, workbench_.camera()->file.camera);
    view_.setDetection(mark);
    return;
  }
  view_.setDetection({});
  if (shown.problem.isEmpty())
  {
    view_.setBanner(QString::fromStdString(ball.message), Level::Warning);
  }
}

void VideoPresenter::showGhost()
{
  const std::optional<CalibrationStepResult>& calibration = workbench_.calibration();
  const bool isWanted = workbench_.step() == WizardStep::Capture && calibration && calibration->guidance &&
    calibration->guidance->status != HandEyeGuidance::Status::NoPlace && workbench_.camera();
  if (!isWanted)
  {
    view_.setGhostBall({});
    return;
  }
  VideoView::GhostBall ghost;
  ghost.outline_Image_Px =
    outlineOf(calibration->guidance->ball_Camera, workbench_.ball().radiusMm, workbench_.camera()->file.camera);
  ghost.hint = tr("next: %1 mm away").arg(calibration->guidance->ball_Camera.z(), 0, 'f', 0);
  view_.setGhostBall(ghost);
}

}  // namespace handeye
