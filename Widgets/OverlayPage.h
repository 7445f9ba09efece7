// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "OverlayPresenter.h"
#include "TouchTask.h"
#include "WizardPage.h"

#include <memory>

namespace Ui
{
class OverlayPage;
}

namespace handeye
{

/// The model on the live video: which, how opaque, and the phantom's registration by touched landmarks.
class OverlayPage : public WizardPage
{
  Q_OBJECT

public:
  explicit OverlayPage(HandEyeWorkbench& workbench, QWidget* parent = nullptr);
  ~OverlayPage() override;

  void enter() override;
  void refresh() override;

  /// What the controls show, after a key changed it. @param opacity 0 to 1
  void setLook(const OverlayLook& look, double opacity);
  void setStereo(const OverlayStereo& stereo);
  void setState(const OverlayState& state);
  void setRecording(const OverlayRecordingState& state);

signals:
  void opacityChanged(double opacity);
  void lookChanged(const handeye::OverlayLook& look);
  void smoothingChanged(bool smooth);
  void snapshotWanted();
  void stereoChanged(const handeye::OverlayStereo& stereo);
  /// @param ending of the file: ".mp4"
  void recordingWanted(const QString& ending);
  void recordingUnwanted();

private:
  void playRoom();
  void followTip();
  void takeTip();
  void forgetTouched();
  void recallLandmarks();
  void checkLandmarks();
  void takeModel();
  void offerOwnLandmarks();
  void showRegistration();
  void connectLook();
  void connectEyesAndVideo();
  void showLook();

  std::unique_ptr<Ui::OverlayPage> ui_;
  TouchTask::Touch touch_;
  bool areLandmarksOfAnotherTime_ = false;  ///< while they are forgotten or come back: nothing is stored or calculated
  QString touchedModel_;                    ///< the mesh that the landmarks belong to
  QTimer tipTimer_;
  OverlayLook look_;
  bool isRecording_ = false;
  bool isLookChosen_ = false;  ///< opened or closed by the person
};

}  // namespace handeye
