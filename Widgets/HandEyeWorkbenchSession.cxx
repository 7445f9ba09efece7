// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeWorkbench.h"

#include "ResultFiles.h"
#include "SessionDocuments.h"
#include "SessionMemory.h"
#include "WorkThread.h"

#include <QDateTime>
#include <QDir>
#include <QFileInfo>

#include <algorithm>
#include <array>
#include <set>
#include <utility>

namespace handeye
{

namespace
{

using nlohmann::json;

/// Of the steps in the session's files, in the wizard's order.
constexpr std::array<const char*, WizardStepCount> StepWords = { "devices", "camera", "stylus", "ball", "capture", "validation",
  "comparison", "overlay", "finish" };

std::optional<WizardStep> stepOf(const std::string& word)
{
  const auto found = std::find(StepWords.begin(), StepWords.end(), word);
  return found == StepWords.end() ? std::nullopt : std::optional(WizardStep(found - StepWords.begin()));
}

}  // namespace

QString HandEyeWorkbench::newSessionFolder()
{
  const QDir folder(sessionsFolder());
  const QString name = QDateTime::currentDateTime().toString(QStringLiteral("yyyy-MM-dd_HH-mm-ss"));
  QString path = folder.filePath(name);
  for (int i = 2; QFileInfo::exists(path); ++i)
  {
    path = folder.filePath(name + QLatin1Char('_') + QString::number(i));
  }
  return path;
}

void HandEyeWorkbench::openSession(const QString& folder)
{
  ++session_;
  isCalibrating_ = isCalibrationStale_ = false;
  camera_.reset();
  stylus_.reset();
  ball_ = {};
  calibration_.reset();
  isCalibrationLoaded_ = false;
  validation_.reset();
  model_ = {};
  modelPath_.clear();
  wantedModelPath_.clear();
  registeredModelPath_.clear();
  modelToPhantom_.reset();
  registration_.reset();
  storedLandmarks_ = {};
  isTouchingAnew_ = false;
  comparison_->clear();
  storedComparison_.clear();
  sessionProblems_.clear();
  isSessionUsed_ = false;
  exported_.reset();
  report_ = {};
  storedStep_.reset();
  nearestMm_ = DefaultNearestMm;
  furthestMm_ = DefaultFurthestMm;
  enoughPx_ = DefaultEnoughPx;
  pivot_->forget();
  spin_->cancel();
  latency_->cancel();
  capture_->setHandsFree(false);
  validationCapture_->setHandsFree(false);
  emit resultsForgotten();
  emit modelChanged();
  emit registrationChanged();
  capture_->setInputs({});
  validationCapture_->setInputs({});
  updateLive();  // the ball is not looked for with the lens of before
  QDir().mkpath(folder);
  capture_->openFolder(folder);
  validationCapture_->openFolder(folder + QStringLiteral("/validation"));
}

/// What is done from now on is stored, in a new session; why not in the one that was wanted, is said when it is open.
void HandEyeWorkbench::openAnother(const QString& problem)
{
  if (openProblem_.isEmpty())
  {
    openProblem_ = problem;
    openSession(newSessionFolder());
    return;
  }
  refuse(WizardStep::Devices, std::exchange(openProblem_, {}));
}

QString HandEyeWorkbench::documentPath(const QString& name) const
{
  return capture_->isOpen() ? capture_->folder() + QStringLiteral("/documents/") + name + QStringLiteral(".json") : QString();
}

void HandEyeWorkbench::afterStoring(std::function<void()> then)
{
  post([this, then = std::move(then)] { tell(then); });
}

void HandEyeWorkbench::store(const std::string& name, const json& document)
{
  capture_->setDocument(name, document);
  static const std::set<std::string> results = { "stylus", "calibration", "validation", "phantom" };
  if (!document.is_null() && results.count(name) > 0)
  {
    setSessionUsed();
  }
}

/// From now on it is the one to be gone on with next time.
void HandEyeWorkbench::setSessionUsed()
{
  if (!isSessionUsed_ && capture_->isOpen())
  {
    isSessionUsed_ = true;
    rememberSession(sessionFolder());
    storeStep();
    emit sessionUsed();
  }
}

/// An empty session is not written to for having been looked at.
void HandEyeWorkbench::storeStep()
{
  if (isSessionUsed_)
  {
    store("wizard", { { "step", StepWords[std::size_t(step_)] } });
  }
}

BallDocument HandEyeWorkbench::ballDocument() const
{
  return { ball_.radiusMm, ball_.isColorLearnt, ball_.message, ball_.color, nearestMm_, furthestMm_, enoughPx_ };
}

void HandEyeWorkbench::storeBall()
{
  store("ball", ballJson(ballDocument()));
}

void HandEyeWorkbench::storeDevices()
{
  store("devices", devicesJson(devices_->setup()));
}

/// What a session holds becomes the state; a document that cannot be read is a problem, and the rest comes back.
void HandEyeWorkbench::takeDocuments(const std::map<std::string, json>& documents, const QStringList& problems)
{
  sessionProblems_ = problems;
  storedComparison_ = textOf(entryOf(documents, "comparison"), "message", {});
  const BallDocument ball = ballOf(entryOf(documents, "ball"), ballDocument());
  ball_.radiusMm = ball.radiusMm;
  ball_.isColorLearnt = ball.isColorLearnt;
  ball_.message = ball.message;
  ball_.color = ball.color;
  nearestMm_ = ball.nearestMm;
  furthestMm_ = ball.furthestMm;
  enoughPx_ = ball.enoughPx;
  const DeviceSetup setup = devicesOf(entryOf(documents, "devices"), devices_->setup());
  devices_->prepare(setup);
  // It belongs to the samples as well, whatever is connected.
  devices_->setLatency(setup.latencySec);
  exported_ = exportOf(entryOf(documents, "export"));
  storedLandmarks_ = entryOf(documents, "landmarks");
  report_ = entryOf(documents, "report");
  storedStep_ = stepOf(textOf(entryOf(documents, "wizard"), "step", {}).toStdString());
  restoreFiles(documents);
  if (capture_->storedSampleCount() > 0 || entryOf(documents, "stylus").is_object() ||
    entryOf(documents, "calibration").is_object() || entryOf(documents, "phantom").is_object())
  {
    setSessionUsed();
  }
  emit ballChanged();
  if (!openProblem_.isEmpty())
  {
    storedStep_ = WizardStep::Devices;
  }
  emit sessionOpened();
  if (!openProblem_.isEmpty())
  {
    refuse(WizardStep::Devices, tr("%1. A new session was begun instead.").arg(std::exchange(openProblem_, {})));
  }
  emit happened(tr("session %1").arg(capture_->folder()));
  emit stateChanged();
}

/// Results by the readers of their files, so that a damaged one is refused like any other.
void HandEyeWorkbench::restoreFiles(const std::map<std::string, json>& documents)
{
  const json camera = entryOf(documents, "camera");
  if (camera.is_object())
  {
    beside(WizardStep::Camera,
      [this, path = documentPath(QStringLiteral("camera")), origin = textOf(camera, "origin", tr("the session"))]
      {
        const io::CameraFile file = io::readCameraFile(path.toStdString());
        tell(
          [this, file, origin]
          {
            camera_ = Camera{ file, origin };
            emit cameraChanged();
            updateInputs();
          });
      });
  }
  else
  {
    takeRoomCamera();  // the room that is connected shows its pictures in this session, too
  }
  if (const json stylus = entryOf(documents, "stylus"); stylus.is_object())
  {
    beside(WizardStep::Stylus,
      [this, stylus, path = std::filesystem::path(documentPath(QStringLiteral("stylus")).toStdString())]
      {
        const Stylus restored{ readStylusTip(path), readStylusTipCovariance(path), numberOf(stylus, "rmsMm", 0),
          textOf(stylus, "message", {}), stylus, readStylusTipFrame(path) };
        tell([this, restored] { setStylus(restored, false); });
      });
  }
  if (entryOf(documents, "calibration").is_object() && QDir(capture_->folder() + QStringLiteral("/samples")).isEmpty())
  {
    loadCalibration(documentPath(QStringLiteral("calibration")));
  }
  const json model = entryOf(documents, "model");
  if (model.is_object())
  {
    loadModel(textOf(model, "file", {}));
  }
  if (entryOf(documents, "phantom").is_object())
  {
    loadRegistration(documentPath(QStringLiteral("phantom")), model.is_object() ? textOf(model, "registeredFile", {}) : QString());
  }
}

}  // namespace handeye
