// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "WizardPage.h"

#include <memory>

namespace Ui
{
class CapturePage;
}

namespace handeye
{

/// Placements of the ball, hands-free, by key or from a recording; the calibration and its predicted error after each.
class CapturePage : public WizardPage
{
  Q_OBJECT

public:
  explicit CapturePage(HandEyeWorkbench& workbench, QWidget* parent = nullptr);
  ~CapturePage() override;

  void enter() override;
  void refresh() override;
  bool keyInVideo(int key) override;

private:
  void showSamples();
  void showCalibration();

  std::unique_ptr<Ui::CapturePage> ui_;
  bool isEnoughSaid_ = false;
};

}  // namespace handeye
