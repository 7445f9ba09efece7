// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CalibratedEye.h"
#include "CalibrationStep.h"
#include "CameraFile.h"
#include "CaptureTask.h"
#include "ComparisonTask.h"
#include "DeviceHub.h"
#include "LandmarkRegistration.h"
#include "LatencyTask.h"
#include "LensTask.h"
#include "LivePipeline.h"
#include "Look.h"
#include "OverlayMesh.h"
#include "OverlayPose.h"
#include "PivotTask.h"
#include "SessionDocuments.h"
#include "SpinTask.h"
#include "TouchTask.h"
#include "ValidationStep.h"

#include <nlohmann/json.hpp>

#include <Eigen/Core>
#include <QImage>
#include <QObject>
#include <QString>
#include <QTimer>
#include <vtkPolyData.h>

#include <memory>
#include <optional>

namespace handeye
{

class WorkThread;

/// The steps of the wizard, in its order.
enum class WizardStep
{
  Devices,
  Camera,
  Stylus,
  Ball,
  Capture,
  Validation,
  Comparison,
  Overlay,
  Finish
};
constexpr int WizardStepCount = 9;

/// The wizard without its windows: devices, tasks and results of one session. Every result is stored with the session as soon as it
/// is there, and comes back when the session is opened again.
///
/// Frames and units are those of the layers below (mm, px): p_Camera = markerToCamera * p_Marker.
///
/// Belongs to the thread of the user interface and never makes it wait; the work is done in a thread beside it.
class HandEyeWorkbench : public QObject
{
  Q_OBJECT

public:
  struct Camera
  {
    io::CameraFile file;
    QString origin;  ///< the file's name, or where else it is from
  };
  struct Stylus
  {
    Eigen::Vector3d tip_Stylus = Eigen::Vector3d::Zero();
    Eigen::Matrix3d tipCovariance = Eigen::Matrix3d::Zero();
    double rmsMm = 0;
    QString message;
    nlohmann::json document;
    /// With the direction of the shaft, where it was spun. p_Stylus = stylusTipToStylus * p_StylusTip
    std::optional<Eigen::Isometry3d> stylusTipToStylus = std::nullopt;
  };
  struct FormerColor
  {
    BallColor color;
    bool isLearnt = false;
  };
  struct Ball
  {
    double radiusMm = 15;
    BallColor color;
    bool isColorLearnt = false;
    bool wasSeen = false;               ///< found at least once with this colour and radius
    QString message;                    ///< of the last click
    std::optional<FormerColor> former;  ///< what a click has replaced
  };

  explicit HandEyeWorkbench(QObject* parent = nullptr);
  ~HandEyeWorkbench() override;

  DeviceHub& devices() { return *devices_; }
  LivePipeline& live() { return *live_; }
  PivotTask& pivot() { return *pivot_; }
  SpinTask& spin() { return *spin_; }
  LensTask& lens() { return *lens_; }
  LatencyTask& latency() { return *latency_; }
  TouchTask& touch() { return *touch_; }
  CaptureTask& capture() { return *capture_; }
  CaptureTask& validationCapture() { return *validationCapture_; }
  ComparisonTask& comparison() { return *comparison_; }

  // Session
  /// A folder that there is not yet, for a new session.
  static QString newSessionFolder();
  void openSession(const QString& folder);
  QString sessionFolder() const { return capture_->folder(); }
  /// What was odd about it: sentences.
  QStringList sessionProblems() const { return sessionProblems_; }
  /// Of the session's document of this name; empty while no session is open.
  QString documentPath(const QString& name) const;
  /// Called in this thread once everything that was to be stored by now is on the disk.
  void afterStoring(std::function<void()> then);

  /// Whether there is anything in it that a person would miss.
  bool isSessionUsed() const { return isSessionUsed_; }
  /// Where a person was in the session that was opened, to go on there; nothing for a new one.
  std::optional<WizardStep> storedStep() const { return storedStep_; }

  // Devices
  bool connectDevices(const DeviceSetup& setup);
  void setStreamNames(const DeviceSetup& setup);
  /// The page that a person is on: the simulated room follows it, and the ball is looked for where it is needed.
  void enterStep(WizardStep step);
  WizardStep step() const { return step_; }

  // Camera, stylus, ball
  void loadCamera(const QString& path);
  void setCamera(const io::CameraFile& file, const QString& origin);
  /// The simulated room knows the lens of its camera; without a room that is connected nothing happens.
  void takeRoomCamera();
  /// The lens that was calibrated last becomes the camera, also as camera.yml (OpenCV) in the session's folder.
  void useCalibratedLens();
  const std::optional<Camera>& camera() const { return camera_; }
  void loadStylus(const QString& path);
  /// A tip whose exactness is not known. @param origin where it is from, for a person
  void takeStylusTip(const Eigen::Vector3d& tip_Stylus, const QString& origin);
  const std::optional<Stylus>& stylus() const { return stylus_; }
  /// Begins to look for the direction of the stylus' shaft, which is optional; refused in words without a tip.
  void spinStylus();
  /// How the shaft of the stylus was found, a sentence; empty while its direction is not known.
  QString shaftWords() const;
  void setBallRadius(double radiusMm);
  /// From a click on the ball. Where no ball is found there with the colour of the click, that is refused in words, and the colour
  /// stays what it was. @param shown the frame that was clicked on; null: there was none. @param point_Image px
  void learnBallColor(const std::shared_ptr<const LiveView>& shown, const QPointF& point_Image);
  /// Back to what the last click has replaced.
  void takeFormerBallColor();
  void forgetBallColor();
  const Ball& ball() const { return ball_; }
  /// "any saturated red", "learnt: hue 120°"
  static QString nameOf(const BallColor& color, bool isLearnt);
  void measureLatency();

  // Calibration and validation
  /// The last attempt, usable or not; nothing before the first sample.
  const std::optional<CalibrationStepResult>& calibration() const { return calibration_; }
  const std::optional<ValidationStepResult>& validation() const { return validation_; }
  /// A calibration.json of another time, with its lens, tip and ball, to be validated or drawn with; samples make a new one.
  void loadCalibration(const QString& path);
  void setWorkingDepths(double nearestMm, double furthestMm);
  double nearestMm() const { return nearestMm_; }
  double furthestMm() const { return furthestMm_; }
  /// Below this largest predicted error the samples are enough, px.
  void setEnoughPx(double px);
  double enoughPx() const { return enoughPx_; }
  bool isEnough() const;
  void writeReport(const QString& folder);
  /// The report of the validation as it is now; empty if there is none.
  QString reportFile() const;
  /// The calibration with stylus and registration, as they are now, was exported to a folder.
  void setExported(const QString& folder);
  /// Where all of it, as it is now, was exported to; empty: it was not.
  QString exportedFolder() const;

  // Comparison
  /// What a person adds to the session's own samples.
  struct ComparisonExtras
  {
    QString boardRecording;
    std::optional<BoardDescription> board;
    QStringList otherCaptures;  ///< of the ball, independent of the session's
    double branchAndBoundSec = 30;
  };
  /// All methods on the samples that take part now; refused in words where something is missing.
  void compare(const ComparisonExtras& extras);
  /// The samples, the lens or the stylus are others than those that were compared.
  bool isComparisonStale() const;
  /// The verdict of a comparison that this session had when it was opened; its table and plots are made anew.
  const QString& storedComparison() const { return storedComparison_; }
  /// The session's folder for the comparison's report.
  QString comparisonFolder() const;

  // Overlay
  void loadModel(const QString& path);
  vtkPolyData* model() const { return model_.mesh; }
  /// The same, ready to be drawn.
  const OverlayMesh& overlayMesh() const { return model_; }
  QString modelPath() const { return modelPath_; }
  /// Of the mesh that was asked for last, loaded or not; empty: none was.
  QString wantedModelPath() const { return wantedModelPath_; }
  /// The model that comes with the program, and its landmarks; empty if it was not found.
  static QString ownModel();
  static QString ownLandmarks();
  /// Whether landmarks can be those of the mesh that is loaded: they lie on its surface. What does not is refused in words.
  /// @param isRegistered the registration was made with them, before there was a mesh: it goes, too
  void checkLandmarks(const std::vector<Eigen::Vector3d>& points_Model, bool isRegistered);
  /// Refused where checkLandmarks() would; the registration of before stays then.
  /// @param touchedModel the mesh whose landmarks they are; empty: the one that is loaded
  void registerLandmarks(const std::vector<Eigen::Vector3d>& points_Model, const std::vector<Eigen::Vector3d>& points_Phantom,
    const QString& touchedModel = {});
  /// The landmarks with what was touched, as they come back with the session.
  void storeLandmarks(const nlohmann::json& landmarks);
  const nlohmann::json& storedLandmarks() const { return storedLandmarks_; }
  void recallRegistration(const std::vector<Eigen::Vector3d>& points_Model, const std::vector<Eigen::Vector3d>& points_Phantom);
  /// @param madeForModel the mesh that it belongs to; empty: the one that is loaded
  void loadRegistration(const QString& path, const QString& madeForModel = {});
  void saveRegistration(const QString& path);
  /// Too few landmarks are touched for a registration: what is said of the last attempt is over, and the registration of before, if
  /// there is one, stays in use until there is another.
  void setTouchingAnew(bool isAnew);
  const std::optional<Eigen::Isometry3d>& modelToPhantom() const { return modelToPhantom_; }
  /// Another mesh was loaded after the phantom was registered: nothing is drawn with it until the person says that it lies in the
  /// same coordinates (keepRegistration()), or registers anew.
  bool isRegisteredForAnotherModel() const;
  /// The registration, if it is that of the mesh that is loaded.
  std::optional<Eigen::Isometry3d> registrationOfModel() const
  {
    return isRegisteredForAnotherModel() ? std::nullopt : modelToPhantom_;
  }
  void keepRegistration();
  const std::optional<LandmarkRegistrationResult>& registration() const { return registration_; }
  /// What places the model, or the reason why there is nothing yet.
  std::optional<OverlayTransforms> overlayTransforms(QString& reason) const;
  /// Where the stylus is in a frame; nothing if that is not known. p_Camera = stylusTipToCamera * p_StylusTip
  std::optional<Eigen::Isometry3d> stylusTipToCamera(const devices::PairedFrame& frame) const;
  /// The same for the right eye.
  std::optional<Eigen::Isometry3d> stylusTipToRightCamera(const devices::PairedFrame& frame) const;
  /// Of the calibration (rotation vector rad, translation mm; `Camera` frame); nothing if it is not known.
  std::optional<Eigen::Matrix<double, 6, 6>> calibrationCovariance() const;
  /// The right eye of a stereo rig, where a calibration with one was loaded.
  std::optional<CalibratedEye> rightEye() const { return isCalibrationLoaded_ && calibration_ ? rightEye_ : std::nullopt; }
  /// Into the session's folder, as PNG; an empty picture is refused.
  void saveSnapshot(const QImage& picture);

  // What a page may go on with
  /// Why a step's result is not usable, a sentence; empty if it is.
  QString problemOf(WizardStep step) const;
  /// What a step needs of earlier ones and does not have: a sentence with where to get it; empty if it can be worked on.
  QString missingFor(WizardStep step) const;
  /// The verdict of a step in plain words; empty while there is none.
  QString verdictOf(WizardStep step) const;
  /// Whether there is a usable result; of a step that can be left out, whether there is one at all.
  bool isDone(WizardStep step) const;
  /// How good that is: `fair` is a warning, `poor` an error.
  Level levelOf(WizardStep step) const;

  void cancelWork();
  /// Says on a step's page, and in the log, why something is not done.
  void refuse(WizardStep step, const QString& message);

signals:
  /// Something about a step's inputs or result is different.
  void stateChanged();
  void stepEntered();
  /// Another session is being opened: nothing of the one before counts any more.
  void resultsForgotten();
  void sessionOpened();
  /// There is something in the session now that a person would miss, or was when it was opened.
  void sessionUsed();
  void cameraChanged();
  void stylusChanged();
  void ballChanged();
  void latencyChanged(const QString& message);
  void calibrationChanged();
  void validationChanged();
  void modelChanged();
  void registrationChanged();
  void reportWritten(const QString& path);
  void snapshotSaved(const QString& path);
  /// Something asked for was refused, in words; of which step.
  void refused(handeye::WizardStep step, const QString& message);
  /// For the log: what happened.
  void happened(const QString& message);

private:
  void connectTasks();
  QString missingForComparison() const;
  void takeDocuments(const std::map<std::string, nlohmann::json>& documents, const QStringList& problems);
  void restoreFiles(const std::map<std::string, nlohmann::json>& documents);
  std::vector<double> exportedNumbers() const;
  BallDocument ballDocument() const;
  void storeBall();
  void setBallColor(const BallColor& color, bool isLearnt, const QString& message);
  void storeDevices();
  void storeStep();
  void openAnother(const QString& problem);
  void setSessionUsed();
  void store(const std::string& name, const nlohmann::json& document);
  void setStylus(const Stylus& stylus, bool isNew);
  /// stylus.json of a tip of which nothing else is known.
  static nlohmann::json tipDocument(const Eigen::Vector3d& tip_Stylus, const QString& message);
  void takeSpin(const SpinStepResult& result);
  void playRoom();
  void storeModel();
  static QString problemOfLandmarks(vtkPolyData* mesh, const QString& meshPath, const std::vector<Eigen::Vector3d>& points_Model);
  vtkSmartPointer<vtkPolyData> meshBeside() const;
  void setModelToPhantom(const std::optional<Eigen::Isometry3d>& modelToPhantom, const QString& madeForModel);
  void updateInputs();
  void updateLive();
  void recalibrate();
  void calibrateNow();
  void takeCalibration(const CalibrationStepResult& result);
  void revalidate();
  /// Work beside the window; what it throws is a refusal of the step.
  void beside(WizardStep step, std::function<void()> work);
  std::optional<Eigen::Isometry3d> stylusTipTo(const Eigen::Isometry3d& markerToCamera, const devices::PairedFrame& frame) const;
  /// Work for the thread beside the window, for the session that is open now.
  void post(std::function<void()> work);
  /// News from that thread; those of a session that is not the open one any more are dropped.
  void tell(std::function<void()> news);
  void onSample(const devices::DeviceSample& sample);
  void onFrame(const devices::PairedFrame& frame);

  std::unique_ptr<WorkThread> work_;
  DeviceHub* devices_;
  LivePipeline* live_;
  LensTask* lens_;
  PivotTask* pivot_;
  SpinTask* spin_;
  LatencyTask* latency_;
  std::unique_ptr<TouchTask> touch_;
  CaptureTask* capture_;
  CaptureTask* validationCapture_;
  ComparisonTask* comparison_;
  int session_ = 0;      ///< counts the sessions that were opened
  int workSession_ = 0;  ///< of the work under way; belongs to the work's thread
  WizardStep step_ = WizardStep::Devices;
  QStringList sessionProblems_;
  QString openProblem_;  ///< why the session that was wanted is not open; empty once it was said
  bool isSessionUsed_ = false;
  nlohmann::json report_;  ///< where the last one is, and of which errors (px) it is
  std::optional<ExportDocument> exported_;
  std::optional<WizardStep> storedStep_;
  QString storedComparison_;
  std::optional<Camera> camera_;
  std::optional<Stylus> stylus_;
  Ball ball_;
  std::optional<CalibrationStepResult> calibration_;
  bool isCalibrationLoaded_ = false;       ///< from a file: there are no samples of it
  std::optional<CalibratedEye> rightEye_;  ///< that came with the file
  std::optional<ValidationStepResult> validation_;
  static constexpr double DefaultNearestMm = 160, DefaultFurthestMm = 420, DefaultEnoughPx = 1.5;
  double nearestMm_ = DefaultNearestMm, furthestMm_ = DefaultFurthestMm, enoughPx_ = DefaultEnoughPx;
  bool isCalibrationAsked_ = false, isCalibrating_ = false, isCalibrationStale_ = false;
  OverlayMesh model_;
  QString modelPath_, wantedModelPath_, registeredModelPath_;
  std::optional<Eigen::Isometry3d> modelToPhantom_;
  std::optional<LandmarkRegistrationResult> registration_;
  nlohmann::json storedLandmarks_;
  bool isTouchingAnew_ = false;
};

}  // namespace handeye
