// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CaptureTask.h"

#include "CaptureTaskWork.h"
#include "WorkThread.h"

#include <utility>

namespace handeye
{

namespace
{

const char* const DeletedDocument = "deleted";
constexpr int BeginMs = 2000;
constexpr int MostTakeTries = 15;  ///< frames: half a second

bool isSameColor(const BallColor& a, const BallColor& b)
{
  return a.channelOrder == b.channelOrder && a.hueDeg == b.hueDeg && a.hueToleranceDeg == b.hueToleranceDeg &&
    a.minimumSaturation == b.minimumSaturation && a.minimumValue == b.minimumValue && a.minimumChroma == b.minimumChroma &&
    a.minimumMedianSaturation == b.minimumMedianSaturation;
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

CaptureTask::CaptureTask(WorkThread& work, QObject* parent)
  : QObject(parent)
  , thread_(work)
  , work_(std::make_shared<Work>())
{
  begin_.setSingleShot(true);
  begin_.setInterval(BeginMs);
  connect(&begin_, &QTimer::timeout, this, [this] { setHandsFree(true); });
}

CaptureTask::~CaptureTask() = default;

void CaptureTask::tell(std::function<void(CaptureTask&)> news)
{
  QMetaObject::invokeMethod(
    this,
    [this, session = work_->sessionCount, told = std::move(news)]
    {
      if (session == session_)
      {
        told(*this);
      }
    },
    Qt::QueuedConnection);
}

bool CaptureTask::isOutdated(const Work& work) const
{
  return thread_.isEnding() || work.sessionCount != session_;
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
      catch (const std::exception& error)
      {
        tell(
          [message = QString::fromUtf8(error.what())](CaptureTask& task)
          {
            task.close();
            emit task.notOpened(message);
          });
        return;
      }
      std::map<std::string, nlohmann::json> documents;
      for (const std::string& name : work.session->documentNames())
      {
        documents[name] = work.session->document(name).value_or(nlohmann::json());
      }
      const auto deleted = documents.find(DeletedDocument);
      const nlohmann::json ids = deleted != documents.end() && deleted->second.is_object()
        ? deleted->second.value("samples", nlohmann::json())
        : nlohmann::json();
      for (const nlohmann::json& id : ids)
      {
        work.deleted.insert(id.is_number_integer() ? id.get<int>() : -1);
      }
      QStringList problems;
      for (const std::string& problem : work.session->problems())
      {
        problems << QString::fromStdString(problem);
      }
      tell(
        [documents, problems, count = work.shownCount()](CaptureTask& task)
        {
          task.storedSampleCount_ = count;
          emit task.opened(documents, problems);
        });
      evaluateAll(work);
    });
}

void CaptureTask::close()
{
  isOpen_ = false;
  folder_.clear();
  samples_.clear();
  storedSampleCount_ = 0;
  evaluations_ = 0;
  isBroken_ = false;
  setBusy(false);
  post(
    [session = ++session_](Work& work)
    {
      work.sessionCount = session;
      work.takeTries = 0;
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
  evaluateAgain();
}

void CaptureTask::evaluateAgain()
{
  ++evaluations_;
  post(
    [this, inputs = inputs_](Work& work)
    {
      work.inputs = inputs;
      try
      {
        evaluateAll(work);
      }
      catch (...)
      {
        tell([](CaptureTask& task) { task.endEvaluation(false); });
        throw;
      }
      tell([](CaptureTask& task) { task.endEvaluation(true); });
    });
  emit samplesChanged();
}

void CaptureTask::endEvaluation(bool isGood)
{
  --evaluations_;
  isBroken_ = !isGood;
  if (!isGood)
  {
    setBusy(false);
  }
  emit samplesChanged();
}

void CaptureTask::beginHandsFree()
{
  if (!isHandsFree_ && !begin_.isActive())
  {
    begin_.start();
  }
}

void CaptureTask::setHandsFree(bool isHandsFree)
{
  begin_.stop();
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
  post([](Work& work) { work.takeTries = MostTakeTries; });
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
  std::vector<int> known, out, in;  // of which: those that take no part then, and those that do
  for (const int id : ids)
  {
    if (samples_.contains(id))
    {
      samples_[id].isDeleted = isDeleted;
      known.push_back(id);
      (samples_[id].takesPart() ? in : out).push_back(id);
    }
  }
  post(
    [known, out, in, isDeleted](Work& work)
    {
      for (const int id : known)
      {
        isDeleted ? (void)work.deleted.insert(id) : (void)work.deleted.erase(id);
      }
      // The list first: a sample in it is out of sight, whatever the next file says.
      work.session->setDocument(DeletedDocument, { { "samples", work.deleted } });
      work.session->setExcluded(out, true);
      work.session->setExcluded(in, false);
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
  if (!isOpen_)
  {
    emit failed(tr("There is no session to put the samples into: choose a folder that can be written to on the page Devices."));
    return;
  }
  setBusy(true);
  post([this, file = path.toStdString(), tools = inputs_->tools](Work& work) { readRecording(work, file, tools); });
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
