// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HostLink.h"

#include "HandEyeWorkbench.h"

namespace handeye
{

namespace
{

NavigationHost::StreamLight toHostLight(StreamList::Light light)
{
  switch (light)
  {
    case StreamList::Light::Live:
      return NavigationHost::StreamLight::Live;
    case StreamList::Light::Stale:
      return NavigationHost::StreamLight::Stale;
    case StreamList::Light::Lost:
      break;
  }
  return NavigationHost::StreamLight::Lost;
}

std::optional<Eigen::Isometry3d> poseOf(const devices::PairedFrame& frame, const QString& name)
{
  const auto pose = frame.poses.find(name.toStdString());
  return pose != frame.poses.end() && pose->second.isUsable() ? std::optional<Eigen::Isometry3d>(pose->second.transform)
                                                              : std::nullopt;
}

}  // namespace

HostLink::HostLink(HandEyeWorkbench& workbench, NavigationHost& host)
  : workbench_(workbench)
  , host_(host)
{
  connect(&workbench_.devices(), &DeviceHub::streamsChanged, this, &HostLink::showStreams);
  connect(&workbench_.live(), &LivePipeline::shown, this, &HostLink::showPoses);
  for (const auto changed : { &HandEyeWorkbench::cameraChanged, &HandEyeWorkbench::stylusChanged, &HandEyeWorkbench::ballChanged,
         &HandEyeWorkbench::calibrationChanged, &HandEyeWorkbench::modelChanged, &HandEyeWorkbench::registrationChanged })
  {
    connect(&workbench_, changed, this, &HostLink::showResults);
  }
  connect(&workbench_, &HandEyeWorkbench::happened, this,
    [this](const QString& message) { host_.log(NavigationHost::LogLevel::Info, message); });
  connect(&workbench_, &HandEyeWorkbench::sessionUsed, this, [this] { host_.addRecentFile(workbench_.sessionFolder()); });
}

HostLink::~HostLink()
{
  exit();
}

void HostLink::enter(QWidget* video, QObject* receiver)
{
  if (isEntered_)
  {
    return;
  }
  isEntered_ = true;
  host_.setVideoWidget(video);
  host_.setFileHandler(receiver);
  scene_.addTo(host_.sceneRenderer());
  showResults();
  showStreams();
  host_.resetSceneCamera();
}

void HostLink::exit()
{
  if (isEntered_)
  {
    isEntered_ = false;
    scene_.addTo(nullptr);
    host_.setVideoWidget(nullptr);
    host_.setFileHandler(nullptr);
    host_.setStreams({});
    host_.requestSceneRender();
  }
}

void HostLink::showStreams()
{
  if (!isEntered_)
  {
    return;
  }
  QVector<NavigationHost::Stream> streams;
  for (const StreamList::Stream& stream : workbench_.devices().streams())
  {
    streams.push_back({ stream.name, stream.source, toHostLight(stream.light), stream.rateHz, stream.ageSec, stream.message });
  }
  host_.setStreams(streams);
}

void HostLink::showPoses()
{
  const std::shared_ptr<const LiveView> view = workbench_.live().newest();
  if (!isEntered_ || !view)
  {
    return;
  }
  const DeviceSetup& setup = workbench_.devices().setup();
  scene_.setMarkerToTracker(poseOf(view->frame, setup.markerToTracker));
  scene_.setStylusToTracker(poseOf(view->frame, setup.stylusToTracker));
  scene_.setPhantomToTracker(poseOf(view->frame, setup.phantomToTracker));
  host_.requestSceneRender();
}

void HostLink::showResults()
{
  if (!isEntered_)
  {
    return;
  }
  const std::optional<CalibrationStepResult>& calibration = workbench_.calibration();
  const bool isUsable = calibration && calibration->isUsable();
  const auto& camera = workbench_.camera();
  // A camera file without an image size is one, too; its frustum is not known.
  const bool hasFrustum = camera && camera->file.camera.hasImageSize();
  scene_.setCameraModel(hasFrustum ? std::optional<CameraModel>(camera->file.camera) : std::nullopt, workbench_.furthestMm());
  scene_.setMarkerToCamera(isUsable ? std::optional<Eigen::Isometry3d>(calibration->calibration.markerToCamera) : std::nullopt);
  scene_.setStylusTip(workbench_.stylus() ? std::optional<Eigen::Vector3d>(workbench_.stylus()->tip_Stylus) : std::nullopt,
    workbench_.ball().radiusMm);
  scene_.setPhantomMesh(workbench_.model());
  scene_.setModelToPhantom(workbench_.registrationOfModel());
  std::vector<HandEyeSceneProps::CapturedPoint> points;
  if (calibration)
  {
    for (const CalibratedFrame& frame : calibration->frames)
    {
      if (frame.captured.tip_Marker)
      {
        points.push_back(
          { *frame.captured.tip_Marker, isUsable ? std::optional<double>(frame.residualPx) : std::nullopt, frame.used });
      }
    }
  }
  scene_.setCapturedPoints(points);
  const bool hasNext = isUsable && calibration->guidance && calibration->guidance->isWorthwhile();
  scene_.setNextPlace(hasNext ? std::optional<Eigen::Vector3d>(calibration->guidance->ball_Camera) : std::nullopt);
  host_.requestSceneRender();
}

}  // namespace handeye
