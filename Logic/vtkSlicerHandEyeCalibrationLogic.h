// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkSlicerHandEyeCalibrationModuleLogicExport.h"
#include "vtkSlicerModuleLogic.h"

#include <vtkCommand.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

class vtkMatrix4x4;
class vtkPoints;
class vtkTable;

namespace handeye
{
struct CalibrationStepResult;
struct LandmarkRegistrationResult;
struct PivotStepResult;
struct StoredCalibration;
struct ValidationStepResult;
}  // namespace handeye

/// The way from recordings to an overlay, as the module's panel walks it: stylus, camera, validation, phantom.
///
/// The logic holds the inputs, runs the steps and keeps their results. A result changes through a step only, and only for a usable
/// one:
/// a step that fails or is cancelled leaves the result before it as it is, returns false, says why in GetLastMessage() and fires
/// StepFailedEvent. Every step, loading and saving included, fires one event when it ends: the one named with it, or
/// StepFailedEvent; a successful saving fires none. No step throws. There is no result before there is one: matrices and structures
/// are
/// null then, numbers NaN; never the identity and never zero.
///
/// Frames are those of the recordings and files (mm; see CameraModel for `Camera`):
///
///     p_Camera = markerToCamera * p_Marker         p_Phantom = modelToPhantom * p_Model
///
/// A new calibration takes the validation of the one before away.
///
/// Calls belong to one thread at a time, events come in the thread of the call; RequestCancel() may be called from any thread. An
/// observer of ProgressEvent may let the user interface work: a step asked for meanwhile fails, saying that another one is running.
class VTK_SLICER_HANDEYECALIBRATION_MODULE_LOGIC_EXPORT vtkSlicerHandEyeCalibrationLogic : public vtkSlicerModuleLogic
{
public:
  static vtkSlicerHandEyeCalibrationLogic* New();
  vtkTypeMacro(vtkSlicerHandEyeCalibrationLogic, vtkSlicerModuleLogic)
  void PrintSelf(std::ostream& os, vtkIndent indent) override;

  enum Events
  {
    StylusCalibratedEvent = vtkCommand::UserEvent + 1,  ///< there is a new stylus tip
    CameraCalibratedEvent,                              ///< there is a new markerToCamera
    ValidatedEvent,
    PhantomRegisteredEvent,  ///< there is a new modelToPhantom
    StepFailedEvent,         ///< GetLastMessage() says why
    ProgressEvent,           ///< between frames; its call data is a double, 0 to 1
    ResultsForgottenEvent    ///< some results, or all, are not there any more
  };

  // Inputs
  // -----------------------------------------------------------------------------------------------------------------------------

  /// The lens: a file of any kind that io::readCameraFile() knows.
  vtkSetMacro(CameraFile, std::string);
  vtkGetMacro(CameraFile, std::string);

  /// Radius of the stylus' ball, mm; 0, which is no radius, until set.
  vtkSetMacro(BallRadiusMm, double);
  vtkGetMacro(BallRadiusMm, double);

  /// How CalibrateCamera() finds the ball: see BallDetectionOptions. Validate() always takes the exact one.
  enum SegmentationMethods
  {
    ExactSegmentation,
    HoughSegmentation
  };
  vtkSetEnumMacro(SegmentationMethod, SegmentationMethods);
  vtkGetEnumMacro(SegmentationMethod, SegmentationMethods);

  /// How points and rays are registered: to the global minimum and on to the most likely solution, or by the paper's iteration; see
  /// PointLineOptions.
  enum SolverMethods
  {
    GlobalSolver,
    ProcrustesSolver
  };
  vtkSetEnumMacro(SolverMethod, SolverMethods);
  vtkGetEnumMacro(SolverMethod, SolverMethods);

  /// The names under which recordings hold the poses of the stylus and of the camera's marker.
  vtkSetMacro(StylusTransform, std::string);
  vtkGetMacro(StylusTransform, std::string);
  vtkSetMacro(MarkerTransform, std::string);
  vtkGetMacro(MarkerTransform, std::string);

  /// A tip that is known already (mm, Stylus), instead of CalibrateStylus(); fires StylusCalibratedEvent if it is another one.
  /// @throws std::invalid_argument for numbers that are not finite
  void SetStylusTip(double x, double y, double z);

  // Steps: true if the result is usable
  // --------------------------------------------------------------------------------------------------

  /// The tip from a recording of the stylus turning about it. Fires StylusCalibratedEvent.
  bool CalibrateStylus(const std::string& recording);

  /// markerToCamera from a capture of the ball: finds the ball in every frame, then as Recalibrate(). A capture that was evaluated
  /// becomes the one of GetSampleTable(), also where it gave no usable result. Fires CameraCalibratedEvent.
  bool CalibrateCamera(const std::string& recording);

  /// Leaves a sample of the evaluated capture out, or brings it back, for the next Recalibrate().
  /// @return false if the capture has no such sample
  bool SetSampleExcluded(int frame, bool excluded);
  bool GetSampleExcluded(int frame);

  /// Calibrates from the evaluated capture without the excluded samples, with the solver as set now; the ball is not looked for
  /// again.
  /// Fires CameraCalibratedEvent.
  bool Recalibrate();

  /// Compares the calibration with a capture that was not fitted; the tip and the ball are the calibration's. Fires ValidatedEvent.
  bool Validate(const std::string& recording);

  /// modelToPhantom from landmarks on the model and the same ones as touched, in the same order, mm. Fires PhantomRegisteredEvent.
  bool RegisterPhantom(vtkPoints* points_Model, vtkPoints* points_Phantom);

  /// What the steps or the command line wrote, with the event of the step. LoadCalibration() takes over the names of the
  /// transforms.
  bool LoadStylus(const std::string& file);
  bool LoadCalibration(const std::string& file);
  bool LoadPhantomRegistration(const std::string& file);

  bool SaveStylus(const std::string& file);
  bool SaveCalibration(const std::string& file);
  bool SaveValidation(const std::string& file);
  bool SavePhantomRegistration(const std::string& file);
  /// The page of writeValidationReport(), with the pictures of the recording that was validated on.
  bool SaveValidationReport(const std::string& folder);

  /// There is no result any more, and no evaluated capture: a new session begins. Fires ResultsForgottenEvent. While a step is running,
  /// which may let the user interface work, this and the next two wait until it has ended.
  void ForgetResults();
  /// The calibration, with its validation and capture, was withdrawn; so was the registration. Fire ResultsForgottenEvent where there was one.
  void ForgetCalibration();
  void ForgetPhantomRegistration();

  /// Stops the running step after the frame it is at; it then fails. No effect while no step is running.
  void RequestCancel();

  /// What the last step has to say, verdict first: its result, or why there is none.
  const std::string& GetLastMessage() const;
  /// What was odd about the files that it read: sentences for the user.
  const std::vector<std::string>& GetLastWarnings() const;

  // Results
  // ------------------------------------------------------------------------------------------------------------------------------

  /// Whether the stylus' tip comes with the file or step that says how exact it is; not one that was set.
  bool HasStylusDocument();

  /// mm. @return false, and `tip_Stylus` as it was, while there is none
  bool GetStylusTip(double tip_Stylus[3]);
  double GetStylusRmsMm();
  /// The direction of the stylus' shaft from its tip (unit, Stylus), where it was spun. @return false, and `shaft_Stylus` as it was,
  /// while it is not known
  bool GetStylusShaft(double shaft_Stylus[3]);

  /// Null until there is one; a new object for each new result.
  vtkMatrix4x4* GetMarkerToCamera();
  vtkMatrix4x4* GetModelToPhantom();

  /// The projection error that the calibration's covariance predicts over its working volume.
  double GetPredictedMeanPx();
  double GetPredictedMaximumPx();
  /// Of the samples that were fitted: not a validation.
  double GetReprojectionRmsPx();

  /// The projection error of Validate().
  double GetValidationMeanPx();
  double GetValidationStandardDeviationPx();
  double GetValidationMinimumPx();
  double GetValidationMaximumPx();
  double GetValidationRmsPx();
  /// How many frames these are of; 0 while there is none.
  int GetValidationCount();

  double GetPhantomRmsMm();

  /// One row for each frame of the evaluated capture: `frame`, `status`, `used`, `excluded`, `residualPx`, `residualMm`,
  /// `distanceMm`,
  /// `ballXPx`, `ballYPx`, `message`. `excluded` is what Recalibrate() will do, the others are what was done. Numbers that a
  /// frame does not have are NaN. No rows after LoadCalibration().
  vtkTable* GetSampleTable();

  /// One row for each frame of the validation: `frame`, `status`, `errorPx`, `distanceMm`, `ballXPx`, `ballYPx`, `projectedXPx`,
  /// `projectedYPx`, `message`. No rows while there is no validation.
  vtkTable* GetValidationTable();

  /// The recording that a result rests on; empty while there is no result or if it is from a file.
  std::string GetStylusRecording();
  std::string GetCalibrationRecording();
  std::string GetValidationRecording();

  /// All that is known of a usable result of a step; null while there is none or if it is from a file.
  const handeye::PivotStepResult* GetStylusResult();
  const handeye::CalibrationStepResult* GetCalibrationResult();
  const handeye::ValidationStepResult* GetValidationResult();
  const handeye::LandmarkRegistrationResult* GetPhantomResult();

  /// The evaluated capture with what the last calibration made of it, usable or not; null while there is none.
  const handeye::CalibrationStepResult* GetLastCalibrationAttempt();

  /// What an overlay needs of the calibration, lens included; from a step or a file. Null while there is none.
  const handeye::StoredCalibration* GetCalibration();

  /// For the overlay: modelToCamera = markerToCamera * inverse(markerToTracker) * phantomToTracker * modelToPhantom, mm.
  ///
  /// @param modelToCamera receives the transform; left as it is where there is none
  /// @param reason receives, if given, a sentence that says why there is none
  /// @return false without a calibration or a registration, and for a matrix that is null or not rigid. No event, no change of
  /// state.
  bool ComputeModelToCamera(
    vtkMatrix4x4* markerToTracker, vtkMatrix4x4* phantomToTracker, vtkMatrix4x4* modelToCamera, std::string* reason = nullptr);

protected:
  vtkSlicerHandEyeCalibrationLogic();
  ~vtkSlicerHandEyeCalibrationLogic() override;

  void SetMRMLSceneInternal(vtkMRMLScene* newScene) override;
  void RegisterNodes() override;
  void UpdateFromMRMLScene() override;
  void OnMRMLSceneNodeAdded(vtkMRMLNode* node) override;
  void OnMRMLSceneNodeRemoved(vtkMRMLNode* node) override;

private:
  vtkSlicerHandEyeCalibrationLogic(const vtkSlicerHandEyeCalibrationLogic&) = delete;
  void operator=(const vtkSlicerHandEyeCalibrationLogic&) = delete;

  struct StepEnd;

  bool RunStep(unsigned long event, const std::function<StepEnd()>& step);
  void Forget(const std::function<bool()>& forget);
  bool ReportProgress(int done, int total);

  std::string CameraFile;
  double BallRadiusMm = 0;
  SegmentationMethods SegmentationMethod = ExactSegmentation;
  SolverMethods SolverMethod = GlobalSolver;
  std::string StylusTransform;
  std::string MarkerTransform;

  class Internals;
  std::unique_ptr<Internals> Internal;
};
