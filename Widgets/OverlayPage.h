// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

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

  /// 0 to 1.
  double opacity() const;
  /// Why the model is not drawn, a sentence; empty if it is.
  void setOverlayProblem(const QString& problem);

signals:
  void opacityChanged();

private:
  void playRoom();
  void followTip();
  void takeTip();
  void showRegistration();

  std::unique_ptr<Ui::OverlayPage> ui_;
  TouchTask touch_;
};

}  // namespace handeye
