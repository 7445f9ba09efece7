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
  /// All placements are set aside; bringBack(): those that were come back.
  void startOver();
  void bringBack();
  QVector<int> setAside() const;
  void showStartOver();

  std::unique_ptr<Ui::ValidationPage> ui_;
  QVector<int> setAside_;  ///< ids of the last start over; empty: none in this sitting
};

}  // namespace handeye
