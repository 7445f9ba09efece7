// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QString>
#include <QWidget>

#include <memory>

class NavigationHost;
class vtkSlicerHandEyeCalibrationLogic;

namespace handeye
{
class HandEyeWorkbench;
class VideoView;
class WizardPage;
enum class WizardStep;
}  // namespace handeye

/// The module's panel: a wizard from devices to the calibration's export, each page also usable on its own. It fits into a dock of
/// 420 logical px.
///
/// In a navigation desktop the live video, the scene, the lights of the streams and the log are the desktop's; without one (in 3D
/// Slicer, in a window of a test) the panel shows its own video.
class HandEyeCalibrationPanel : public QWidget
{
  Q_OBJECT

public:
  /// @param logic has the same results as the wizard, see LogicLink; may be null. @param host the desktop; may be null. Both outlive the panel.
  HandEyeCalibrationPanel(vtkSlicerHandEyeCalibrationLogic* logic, NavigationHost* host, QWidget* parent = nullptr);
  ~HandEyeCalibrationPanel() override;

  handeye::HandEyeWorkbench& workbench();
  handeye::VideoView& videoView();

  handeye::WizardStep currentStep() const;
  handeye::WizardPage* page(handeye::WizardStep step) const;

  /// A file or folder that a person dropped or chose: a session, a recording, a mesh, a camera file, a result of `handeye` (stylus,
  /// calibration, phantom). What goes with one page opens that page.
  /// @return whether it could be made something of; what is wrong with it is shown on the page
  Q_INVOKABLE bool openFile(const QString& path);

  /// The pages scroll within the panel: whoever holds it need not scroll it, too, for a text that takes more lines.
  bool hasHeightForWidth() const override { return false; }

public slots:
  void goTo(handeye::WizardStep step);
  void goNext();
  void goBack();

  /// The module is shown, or no longer: the views of the desktop are taken and given back. Showing the panel enters the module,
  /// too.
  void enterModule();
  void exitModule();

protected:
  void changeEvent(QEvent* event) override;
  void showEvent(QShowEvent* event) override;

private:
  void openRecording(const QString& path);
  void openResult(const QString& path);
  class Private;
  std::unique_ptr<Private> d;
};
