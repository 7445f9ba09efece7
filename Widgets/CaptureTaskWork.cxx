// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CaptureTaskWork.h"

#include "ImageConversion.h"
#include "JsonEigen.h"
#include "SessionCapture.h"
#include "TimedPose.h"
#include "WorkThread.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace handeye
{

namespace
{

constexpr int ThumbnailPx = 96;

nlohmann::json detectionJson(const CapturedFrame& captured)
{
  nlohmann::json json = { { "status", toString(captured.ball.status) }, { "ball_Image_Px", toJson(captured.ball.ball_Image) },
    { "radiusPx", captured.ball.radiusPx }, { "distanceMm", captured.ball.distanceMm },
    { "confidence", captured.ball.confidence } };
  if (captured.tip_Marker)
  {
    json["tip_Marker_Mm"] = toJson(*captured.tip_Marker);
  }
  return json;
}

/// The ball with some of what is around it.
QImage thumbnailOf(const cv::Mat& image, const BallDetection& ball)
{
  cv::Rect part(0, 0, image.cols, image.rows);
  if (ball.isFound())
  {
    const int half = int(2.2 * ball.radiusPx) + 8;
    part &= cv::Rect(int(ball.ball_Image.x()) - half * 4 / 3, int(ball.ball_Image.y()) - half, 2 * half * 4 / 3, 2 * half);
  }
  return toQImage(image(part)).scaled(ThumbnailPx, ThumbnailPx * 3 / 4, Qt::KeepAspectRatio, Qt::SmoothTransformation);
}

}  // namespace

int CaptureTask::Work::shownCount() const
{
  const auto& all = session->samples();
  return int(std::count_if(all.begin(), all.end(), [this](const auto& sample) { return deleted.count(sample.first) == 0; }));
}

void CaptureTask::Work::renewLive()
{
  live.reset();
  if (session && inputs)
  {
    devices::LiveCaptureOptions options;
    options.stylusToTracker = inputs->tools.stylusToTracker;
    options.markerToTracker = inputs->tools.markerToTracker;
    options.ballRadiusMm = inputs->ballRadiusMm;
    options.detection = inputs->detection;
    live = std::make_unique<devices::LiveCapture>(inputs->camera, inputs->tip_Stylus, *session, options);
  }
}

QString CaptureTask::Work::inWords(const std::string& message) const
{
  QString text = QString::fromStdString(message);
  for (const auto& [name, words] :
    { std::pair(inputs->tools.stylusToTracker, tr("stylus")), std::pair(inputs->tools.markerToTracker, tr("camera's marker")) })
  {
    const QString prefix = QString::fromStdString(name) + QLatin1Char(':');
    text = text.startsWith(prefix) ? words + text.mid(prefix.size() - 1) : text;
  }
  return text;
}

CaptureSample CaptureTask::Work::evaluate(int id) const
{
  const io::SessionSample& stored = session->samples().at(id);
  const cv::Mat image = session->image(id);
  const BallDetector detector(inputs->camera.withImageSize(image.cols, image.rows), inputs->ballRadiusMm, inputs->detection);
  CaptureSample sample;
  sample.id = id;
  sample.captured = evaluateSample(stored, image, inputs->tools, detector, inputs->tip_Stylus);
  sample.thumbnail = thumbnailOf(image, sample.captured.ball);
  sample.isDeleted = deleted.count(id) > 0;
  sample.isExcluded = stored.isExcluded && !sample.isDeleted;
  return sample;
}

/// In the work's thread: all samples with the inputs as they are.
void CaptureTask::evaluateAll(Work& work)
{
  work.renewLive();
  if (!work.session || !work.inputs || work.session->samples().empty())
  {
    return;
  }
  tell([](CaptureTask& task) { task.setBusy(true); });
  QMap<int, CaptureSample> samples;
  const int total = int(work.session->samples().size());
  for (const auto& stored : work.session->samples())
  {
    if (isOutdated(work))
    {
      return;
    }
    if (thread_.isCancelled())
    {
      throw std::runtime_error(tr("The stored samples were not looked at to the end, because that was cancelled. Nothing is "
                                  "calibrated from them until they are.")
                                 .toStdString());
    }
    samples.insert(stored.first, work.evaluate(stored.first));
    tell([done = samples.size(), total](CaptureTask& task)
      { emit task.progress(done, total, tr("looking for the ball in the stored samples")); });
  }
  tell(
    [samples](CaptureTask& task)
    {
      // What a person excluded or deleted meanwhile stays so.
      QMap<int, CaptureSample> evaluated = samples;
      for (CaptureSample& sample : evaluated)
      {
        const auto before = task.samples_.constFind(sample.id);
        sample.isExcluded = before == task.samples_.constEnd() ? sample.isExcluded : before->isExcluded;
        sample.isDeleted = before == task.samples_.constEnd() ? sample.isDeleted : before->isDeleted;
      }
      task.samples_ = evaluated;
      task.setBusy(false);
      emit task.samplesChanged();
    });
}

void CaptureTask::onFrame(const devices::PairedFrame& frame)
{
  using Status = devices::LiveCapture::Step::Status;
  Work& work = *work_;
  if (!work.session || !work.inputs || !work.live)
  {
    return;
  }
  try
  {
    if (work.takeTries > 0)
    {
      take(work, frame);
      return;
    }
    if (!work.isHandsFree)
    {
      return;
    }
    const devices::LiveCapture::Step step = work.live->add(frame);
    if (step.status == Status::Accepted)
    {
      tell([sample = work.evaluate(step.sampleId)](CaptureTask& task) { task.addSample(sample, true); });
    }
    // That a sample is stored the page says, which counts as a person does.
    if (step.status != work.lastStatus || step.message != work.lastMessage)
    {
      work.lastStatus = step.status;
      work.lastMessage = step.message;
      if (step.status != Status::Accepted)
      {
        tell([message = work.inWords(step.message)](CaptureTask& task) { task.setHint(message); });
      }
    }
  }
  catch (const std::exception& error)
  {
    // A full disk or another latency is said once, not with every frame.
    if (work.lastMessage != error.what())
    {
      work.lastMessage = error.what();
      tell([message = QString::fromUtf8(error.what())](CaptureTask& task) { emit task.failed(message); });
    }
  }
}

/// In the work's thread: this frame, whether the ball is held still or not; or one of the next, where the tracker blinks.
void CaptureTask::take(Work& work, const devices::PairedFrame& frame)
{
  --work.takeTries;
  const cv::Mat& image = frame.image.frame()->image;
  io::SessionSample stored = devices::toSessionSample(frame);
  for (const std::string& name : { work.inputs->tools.markerToTracker, work.inputs->tools.stylusToTracker })
  {
    const auto pose = frame.poses.find(name);
    if (pose == frame.poses.end() || !pose->second.isUsable())
    {
      if (work.takeTries > 0)
      {
        return;
      }
      const std::string reason = pose == frame.poses.end() ? "no pose was received" : pose->second.message;
      tell([text = work.inWords(name + ": " + reason)](CaptureTask& task) { emit task.failed(tr("Not taken: %1").arg(text)); });
      return;
    }
  }
  work.takeTries = 0;
  const BallDetector detector(
    work.inputs->camera.withImageSize(image.cols, image.rows), work.inputs->ballRadiusMm, work.inputs->detection);
  const CapturedFrame captured = evaluateSample(stored, image, work.inputs->tools, detector, work.inputs->tip_Stylus);
  if (!captured.isSample())
  {
    tell([text = QString::fromStdString(captured.message)](CaptureTask& task) { emit task.failed(tr("Not taken: %1").arg(text)); });
    return;
  }
  stored.detection = detectionJson(captured);
  const int id = work.session->addSample(image, stored);
  work.renewLive();
  tell([sample = work.evaluate(id)](CaptureTask& task) { task.addSample(sample, true); });
}

/// In the work's thread. What was taken is told, to be taken back, whether the rest could be read or not.
void CaptureTask::readRecording(Work& work, const std::string& path, const ToolNames& tools)
{
  QVector<int> taken;
  int refused = 0;
  std::string reason;
  const auto tellImported = [&]
  {
    work.renewLive();
    tell(
      [taken, refused, text = QString::fromStdString(reason)](CaptureTask& task)
      {
        task.setBusy(false);
        emit task.imported(taken, refused, text);
      });
  };
  try
  {
    const io::Recording recording = io::Recording::open(path);
    (void)latencyNotes(recording, tools.latencySec);  // refuses poses that are too far apart for one
    const CameraModel camera = cameraForRecording(work.inputs->camera, recording);
    const BallDetector detector(camera, work.inputs->ballRadiusMm, work.inputs->detection);
    for (int frame = 0; frame < recording.frameCount() && !thread_.isCancelled() && !isOutdated(work); ++frame)
    {
      tell([done = frame + 1, total = recording.frameCount()](CaptureTask& task)
        { emit task.progress(done, total, tr("looking for the ball in the recording")); });
      if (!recording.hasImage(frame))
      {
        continue;
      }
      io::SessionSample stored = sampleOfFrame(recording, frame, tools);
      const cv::Mat image = recording.image(frame);
      const CapturedFrame captured = evaluateSample(stored, image, tools, detector, work.inputs->tip_Stylus);
      if (!captured.isSample())
      {
        ++refused;
        reason = reason.empty() ? "frame " + std::to_string(frame) + " of the file: " + captured.message : reason;
        continue;
      }
      stored.detection = detectionJson(captured);
      const int id = work.session->addSample(image, stored);
      taken << id;
      tell([sample = work.evaluate(id)](CaptureTask& task) { task.addSample(sample, false); });
    }
  }
  catch (...)
  {
    if (!taken.isEmpty())
    {
      tellImported();
    }
    throw;
  }
  tellImported();
}

}  // namespace handeye
