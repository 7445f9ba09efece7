// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "WizardPage.h"

#include <memory>

namespace Ui
{
class ValidationPage;
}

namespace handeye
{

/// Fresh placements of the ball, on which the calibration is tested: errors over distance, their table, the verdict.
class ValidationPage : public WizardPage
{
  Q_OBJECT

public:
  explicit ValidationPage(HandEyeWorkbench& workbench, QWidget* parent = nullptr);
  ~ValidationPage() override;

  void enter() override;
  void refresh() override;
  bool keyInVideo(int key) override;

private:
  void showValidation();

  std::unique_ptr<Ui::ValidationPage> ui_;
};

}  // namespace handeye
