// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CaptureTask.h"

#include "FileError.h"
#include "ImageConversion.h"
#include "JsonEigen.h"
#include "LiveCapture.h"
#include "SessionCapture.h"
#include "WorkThread.h"

#include <QPointer>

#include <set>
#include <utility>

namespace handeye
{

namespace
{

constexpr int ThumbnailPx = 96;
const char* const DeletedDocument = "deleted";

bool isSameColor(const BallColor& a, const BallColor& b)
{
  return a.channelOrder == b.channelOrder && a.hueDeg == b.hueDeg && a.hueToleranceDeg == b.hueToleranceDeg &&
    a.minimumSaturation == b.minimumSaturation && a.minimumValue == b.minimumValue && a.minimumChroma == b.minimumChroma &&
    a.minimumMedianSaturation == b.minimumMedianSaturation;
}

nlohmann::json detectionJson(const CapturedFrame& captured)
{
  nlohmann::json json = { { "status", toString(captured.ball.status) }, { "ball_Image_Px", toJson(captured.ball.ball_Image) },
    { "radiusPx", captured.ball.radiusPx }, { "distanceMm", captured.ball.distanceMm }, { "confidence", captured.ball.confidence } };
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

bool CaptureInputs::operator==(const CaptureInputs& other) const
{
  return camera.width() == other.camera.width() && camera.height() == other.camera.height() &&
    camera.cameraMatrix() == other.camera.cameraMatrix() &&
    camera.distortionCoefficients() == other.camera.distortionCoefficients() && tip_Stylus == other.tip_Stylus &&
    ballRadiusMm == other.ballRadiusMm && isSameColor(detection.color, other.detection.color) &&
    tools.stylusToTracker == other.tools.stylusToTracker && tools.markerToTracker == other.tools.markerToTracker &&
    tools.latencySec == other.tools.latencySec;
}

/// What belongs to the work's thread.
struct CaptureTask::Work
{
  std::optional<io::Session> session;
  std::optional<CaptureInputs> inputs;
  std::unique_ptr<devices::LiveCapture> live;
  std::set<int> deleted;
  bool isHandsFree = false, isTakeAsked = false;
  devices::LiveCapture::Step::Status lastStatus = devices::LiveCapture::Step::Status::Accepted;
  std::string lastMessage;

  /// The places that are taken are looked at anew.
  void renewLive()
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

  CaptureSample evaluate(int id) const
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
};

CaptureTask::CaptureTask(WorkThread& work, QObject* parent)
  : QObject(parent)
  , thread_(work)
  , work_(std::make_shared<Work>())
{
}

CaptureTask::~CaptureTask() = default;

/// News from the work's thread to this one.
void CaptureTask::tell(std::function<void(CaptureTask&)> news)
{
  QMetaObject::invokeMethod(
    this, [this, told = std::move(news)] { told(*this); }, Qt::QueuedConnection);
}

/// A step in the work's thread; what goes wrong there is told.
void CaptureTask::post(std::function<void(Work&)> step)
{
  thread_.post(
    [this, work = work_, todo = std::move(step)]
    {
      try
      {
        todo(*work);
      }
      catch (const std::exception& error)
      {
        tell(
          [message = QString::fromUtf8(error.what())](CaptureTask& task)
          {
            task.setBusy(false);
            emit task.failed(message);
          });
      }
    });
}

void CaptureTask::setBusy(bool isBusy)
{
  if (isBusy_ != isBusy)
  {
    isBusy_ = isBusy;
    emit busyChanged();
  }
}

void CaptureTask::setHint(const QString& hint)
{
  if (hint_ != hint)
  {
    hint_ = hint;
    emit hintChanged();
  }
}

void CaptureTask::openFolder(const QString& folder)
{
  close();
  folder_ = folder;
  isOpen_ = true;
  post(
    [this, path = folder.toStdString()](Work& work)
    {
      try
      {
        work.session.emplace(io::Session::openOrCreate(path));
      }
      catch (...)
      {
        tell([](CaptureTask& task) { task.close(); });
        throw;
      }
      std::map<std::string, nlohmann::json> documents;
      for (const std::string& name : work.session->documentNames())
      {
        documents[name] = work.session->document(name).value_or(nlohmann::json());
      }
      const auto deleted = documents.find(DeletedDocument);
      const nlohmann::json ids =
        deleted != documents.end() && deleted->second.is_object() ? deleted->second.value("samples", nlohmann::json()) : nlohmann::json();
      for (const nlohmann::json& id : ids)
      {
        work.deleted.insert(id.is_number_integer() ? id.get<int>() : -1);
      }
      QStringList problems;
      for (const std::string& problem : work.session->problems())
      {
        problems << QString::fromStdString(problem);
      }
      tell([documents, problems](CaptureTask& task) { emit task.opened(documents, problems); });
      evaluateAll(work);
    });
}

void CaptureTask::close()
{
  isOpen_ = false;
  folder_.clear();
  samples_.clear();
  post(
    [](Work& work)
    {
      work.live.reset();
      work.session.reset();
      work.deleted.clear();
    });
  emit samplesChanged();
}

void CaptureTask::setInputs(const std::optional<CaptureInputs>& inputs)
{
  if (inputs_ == inputs)
  {
    return;
  }
  inputs_ = inputs;
  post(
    [this, inputs](Work& work)
    {
      work.inputs = inputs;
      evaluateAll(work);
    });
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
    samples.insert(stored.first, work.evaluate(stored.first));
    tell([done = samples.size(), total](CaptureTask& task)
      { emit task.progress(done, total, tr("looking for the ball in the stored samples")); });
  }
  tell(
    [samples](CaptureTask& task)
    {
      task.samples_ = samples;
      task.setBusy(false);
      emit task.samplesChanged();
    });
}

void CaptureTask::setHandsFree(bool isHandsFree)
{
  isHandsFree_ = isHandsFree;
  if (!isHandsFree)
  {
    setHint({});
  }
  post(
    [isHandsFree](Work& work)
    {
      work.isHandsFree = isHandsFree;
      work.lastMessage.clear();
      work.renewLive();
    });
}

void CaptureTask::takeNow()
{
  post([](Work& work) { work.isTakeAsked = true; });
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
    if (std::exchange(work.isTakeAsked, false))
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
    if (step.status != work.lastStatus || step.message != work.lastMessage)
    {
      work.lastStatus = step.status;
      work.lastMessage = step.message;
      tell([message = QString::fromStdString(step.message)](CaptureTask& task) { task.setHint(message); });
    }
  }
  catch (const std::exception& error)
  {
    tell([message = QString::fromUtf8(error.what())](CaptureTask& task) { emit task.failed(message); });
  }
}

/// In the work's thread: this frame, whether the ball is held still or not.
void CaptureTask::take(Work& work, const devices::PairedFrame& frame)
{
  const cv::Mat& image = frame.image.frame()->image;
  io::SessionSample stored = devices::toSessionSample(frame);
  for (const std::string& name : { work.inputs->tools.markerToTracker, work.inputs->tools.stylusToTracker })
  {
    const auto pose = frame.poses.find(name);
    if (pose == frame.poses.end() || !pose->second.isUsable())
    {
      const std::string reason = pose == frame.poses.end() ? "no pose was received" : pose->second.message;
      tell([text = QString::fromStdString(name + ": " + reason)](CaptureTask& task)
        { emit task.failed(tr("Not taken: %1").arg(text)); });
      return;
    }
  }
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

void CaptureTask::addSample(const CaptureSample& sample, bool isNew)
{
  samples_.insert(sample.id, sample);
  if (isNew)
  {
    emit accepted(sample.id);
  }
  emit samplesChanged();
}

void CaptureTask::setExcluded(const QVector<int>& ids, bool isExcluded)
{
  for (const int id : ids)
  {
    if (samples_.contains(id))
    {
      samples_[id].isExcluded = isExcluded;
    }
  }
  post(
    [ids, isExcluded](Work& work)
    {
      for (const int id : ids)
      {
        work.session->setExcluded(id, isExcluded || work.deleted.count(id) > 0);
      }
      work.renewLive();
    });
  emit samplesChanged();
}

void CaptureTask::setDeleted(const QVector<int>& ids, bool isDeleted)
{
  QVector<QPair<int, bool>> excluded;
  for (const int id : ids)
  {
    if (samples_.contains(id))
    {
      samples_[id].isDeleted = isDeleted;
      excluded.push_back({ id, samples_[id].isExcluded || isDeleted });
    }
  }
  post(
    [excluded, isDeleted](Work& work)
    {
      for (const auto& [id, isOut] : excluded)
      {
        isDeleted ? (void)work.deleted.insert(id) : (void)work.deleted.erase(id);
      }
      // The list first: a sample in it is out of sight, whatever the next file says.
      work.session->setDocument(DeletedDocument, { { "samples", work.deleted } });
      for (const auto& [id, isOut] : excluded)
      {
        work.session->setExcluded(id, isOut);
      }
      work.renewLive();
    });
  emit samplesChanged();
}

void CaptureTask::importRecording(const QString& path)
{
  if (!inputs_)
  {
    emit failed(tr("A camera, a stylus and the ball's radius are needed first."));
    return;
  }
  setBusy(true);
  post([this, file = path.toStdString(), tools = inputs_->tools](Work& work) { readRecording(work, file, tools); });
}

/// In the work's thread.
void CaptureTask::readRecording(Work& work, const std::string& path, const ToolNames& tools)
{
  const io::Recording recording = io::Recording::open(path);
  const CameraModel camera = cameraForRecording(work.inputs->camera, recording);
  const BallDetector detector(camera, work.inputs->ballRadiusMm, work.inputs->detection);
  int taken = 0, refused = 0;
  std::string reason;
  for (int frame = 0; frame < recording.frameCount() && !thread_.isCancelled(); ++frame)
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
      reason = reason.empty() ? "frame " + std::to_string(frame) + ": " + captured.message : reason;
      continue;
    }
    stored.detection = detectionJson(captured);
    const int id = work.session->addSample(image, stored);
    ++taken;
    tell([sample = work.evaluate(id)](CaptureTask& task) { task.addSample(sample, false); });
  }
  work.renewLive();
  tell(
    [taken, refused, text = QString::fromStdString(reason)](CaptureTask& task)
    {
      task.setBusy(false);
      emit task.imported(taken, refused, text);
    });
}

void CaptureTask::setDocument(const std::string& name, const nlohmann::json& document)
{
  if (isOpen_)
  {
    post(
      [name, document](Work& work)
      {
        if (work.session)
        {
          work.session->setDocument(name, document);
        }
      });
  }
}

std::vector<CapturedFrame> CaptureTask::frames() const
{
  std::vector<CapturedFrame> frames;
  for (const CaptureSample& sample : samples_)
  {
    if (sample.takesPart())
    {
      frames.push_back(sample.captured);
    }
  }
  return frames;
}

}  // namespace handeye
