// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeWorkbench.h"

#include "ResultFiles.h"
#include "SessionMemory.h"
#include "WorkThread.h"

#include <QDateTime>
#include <QDir>
#include <QFileInfo>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

namespace handeye
{

namespace
{

using nlohmann::json;

double number(const json& object, const char* key, double otherwise)
{
  const json value = object.is_object() ? object.value(key, json()) : json();
  return value.is_number() ? value.get<double>() : otherwise;
}

QString text(const json& object, const char* key, const QString& otherwise)
{
  const json value = object.is_object() ? object.value(key, json()) : json();
  return value.is_string() ? QString::fromStdString(value.get<std::string>()) : otherwise;
}

/// Of the steps in the session's files, in the wizard's order.
constexpr std::array<const char*, WizardStepCount> StepWords = { "devices", "camera", "stylus", "ball", "capture", "validation",
  "comparison", "overlay", "finish" };

std::optional<WizardStep> stepOf(const std::string& word)
{
  const auto found = std::find(StepWords.begin(), StepWords.end(), word);
  return found == StepWords.end() ? std::nullopt : std::optional(WizardStep(found - StepWords.begin()));
}

/// Of a matrix, row by row; empty if it is none.
std::vector<double> numbersOf(const json& rows)
{
  std::vector<double> numbers;
  for (const json& row : rows.is_array() ? rows : json::array())
  {
    for (const json& each : row.is_array() ? row : json::array())
    {
      numbers.push_back(each.is_number() ? each.get<double>() : std::nan(""));
    }
  }
  return numbers;
}

json entry(const std::map<std::string, json>& documents, const char* name)
{
  const auto found = documents.find(name);
  return found == documents.end() || !found->second.is_object() ? json() : found->second;
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
  exportedFolder_.clear();
  storedStep_.reset();
  pivot_->forget();
  spin_->cancel();
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

void HandEyeWorkbench::storeBall()
{
  const BallColor& color = ball_.color;
  store("ball",
    { { "radiusMm", ball_.radiusMm }, { "isColorLearnt", ball_.isColorLearnt }, { "message", ball_.message.toStdString() },
      { "hueDeg", color.hueDeg }, { "hueToleranceDeg", color.hueToleranceDeg }, { "minimumSaturation", color.minimumSaturation },
      { "minimumValue", color.minimumValue }, { "minimumChroma", color.minimumChroma },
      { "minimumMedianSaturation", color.minimumMedianSaturation }, { "nearestMm", nearestMm_ }, { "furthestMm", furthestMm_ },
      { "enoughPx", enoughPx_ } });
}

void HandEyeWorkbench::storeDevices()
{
  const DeviceSetup& setup = devices_->setup();
  json servers = json::array();
  for (const QString& server : setup.servers)
  {
    servers.push_back(server.toStdString());
  }
  store("devices",
    { { "kind", int(setup.kind) }, { "servers", servers }, { "camera", setup.camera.toStdString() },
      { "recording", setup.recording.toStdString() }, { "stylusToTracker", setup.stylusToTracker.toStdString() },
      { "markerToTracker", setup.markerToTracker.toStdString() }, { "phantomToTracker", setup.phantomToTracker.toStdString() },
      { "image", setup.image.toStdString() }, { "rightImage", setup.rightImage.toStdString() },
      { "latencySec", setup.latencySec } });
}

/// What a session holds becomes the state; a document that cannot be read is a problem, and the rest comes back.
void HandEyeWorkbench::takeDocuments(const std::map<std::string, json>& documents, const QStringList& problems)
{
  sessionProblems_ = problems;
  storedComparison_ = text(entry(documents, "comparison"), "message", {});
  const json ball = entry(documents, "ball");
  const auto positive = [&](const char* key, double otherwise)
  {
    const double value = number(ball, key, otherwise);
    return value > 0 && std::isfinite(value) ? value : otherwise;
  };
  ball_.radiusMm = positive("radiusMm", ball_.radiusMm);
  ball_.isColorLearnt = ball.is_object() && ball.value("isColorLearnt", json()) == json(true);
  ball_.message = text(ball, "message", {});
  BallColor color;
  color.hueDeg = number(ball, "hueDeg", color.hueDeg);
  color.hueToleranceDeg = number(ball, "hueToleranceDeg", color.hueToleranceDeg);
  color.minimumSaturation = number(ball, "minimumSaturation", color.minimumSaturation);
  color.minimumValue = number(ball, "minimumValue", color.minimumValue);
  color.minimumChroma = number(ball, "minimumChroma", color.minimumChroma);
  color.minimumMedianSaturation = number(ball, "minimumMedianSaturation", color.minimumMedianSaturation);
  ball_.color = color;
  const double nearestMm = positive("nearestMm", nearestMm_), furthestMm = positive("furthestMm", furthestMm_);
  if (nearestMm < furthestMm)
  {
    nearestMm_ = nearestMm;
    furthestMm_ = furthestMm;
  }
  enoughPx_ = positive("enoughPx", enoughPx_);
  const json devices = entry(documents, "devices");
  if (devices.is_object() && !devices_->isConnected())
  {
    DeviceSetup setup = devices_->setup();
    const int kind = int(number(devices, "kind", double(setup.kind)));
    setup.kind = kind >= 0 && kind <= int(DeviceSetup::Kind::Recording) ? DeviceSetup::Kind(kind) : setup.kind;
    const json servers = devices.value("servers", json());
    setup.servers.clear();
    for (const json& server : servers.is_array() ? servers : json::array())
    {
      setup.servers << (server.is_string() ? QString::fromStdString(server.get<std::string>()) : QString());
    }
    setup.servers.removeAll({});
    setup.camera = text(devices, "camera", {});
    setup.recording = text(devices, "recording", {});
    setup.stylusToTracker = text(devices, "stylusToTracker", setup.stylusToTracker);
    setup.markerToTracker = text(devices, "markerToTracker", setup.markerToTracker);
    setup.phantomToTracker = text(devices, "phantomToTracker", setup.phantomToTracker);
    setup.image = text(devices, "image", setup.image);
    setup.rightImage = text(devices, "rightImage", setup.rightImage);
    devices_->prepare(setup);
  }
  // It belongs to the samples as well, whatever is connected.
  devices_->setLatency(number(devices, "latencySec", devices_->setup().latencySec));
  if (const json exported = entry(documents, "export"); exported.is_object())
  {
    const std::vector<double> numbers = numbersOf(exported.value("markerToCamera", json()));
    if (numbers.size() == 16)
    {
      exportedFolder_ = text(exported, "folder", {});
      exported_.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(numbers.data());
    }
  }
  storedLandmarks_ = entry(documents, "landmarks");
  storedStep_ = stepOf(text(entry(documents, "wizard"), "step", {}).toStdString());
  restoreFiles(documents);
  if (capture_->storedSampleCount() > 0 || entry(documents, "stylus").is_object() || entry(documents, "calibration").is_object() ||
    entry(documents, "phantom").is_object())
  {
    setSessionUsed();
  }
  emit ballChanged();
  emit sessionOpened();
  emit happened(tr("session %1").arg(capture_->folder()));
  emit stateChanged();
}

/// Results by the readers of their files, so that a damaged one is refused like any other.
void HandEyeWorkbench::restoreFiles(const std::map<std::string, json>& documents)
{
  const json camera = entry(documents, "camera");
  if (camera.is_object())
  {
    beside(WizardStep::Camera,
      [this, path = documentPath(QStringLiteral("camera")), origin = text(camera, "origin", tr("the session"))]
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
  if (const json stylus = entry(documents, "stylus"); stylus.is_object())
  {
    beside(WizardStep::Stylus,
      [this, stylus, path = std::filesystem::path(documentPath(QStringLiteral("stylus")).toStdString())]
      {
        const Stylus restored{ readStylusTip(path), readStylusTipCovariance(path), number(stylus, "rmsMm", 0),
          text(stylus, "message", {}), stylus, readStylusTipFrame(path) };
        tell([this, restored] { setStylus(restored, false); });
      });
  }
  if (entry(documents, "calibration").is_object() && QDir(capture_->folder() + QStringLiteral("/samples")).isEmpty())
  {
    loadCalibration(documentPath(QStringLiteral("calibration")));
  }
  const json model = entry(documents, "model");
  if (model.is_object())
  {
    loadModel(text(model, "file", {}));
  }
  if (entry(documents, "phantom").is_object())
  {
    loadRegistration(documentPath(QStringLiteral("phantom")), model.is_object() ? text(model, "registeredFile", {}) : QString());
  }
}

}  // namespace handeye
