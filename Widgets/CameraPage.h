// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "WizardPage.h"

#include <memory>

namespace Ui
{
class CameraPage;
}

namespace handeye
{

/// The camera's lens: from a file of any kind, or the simulated room's own.
class CameraPage : public WizardPage
{
  Q_OBJECT

public:
  explicit CameraPage(HandEyeWorkbench& workbench, QWidget* parent = nullptr);
  ~CameraPage() override;

  void refresh() override;
  /// Where a calibration of the lens is put in; hidden while there is nothing in it.
  QWidget* lensCalibrationPlace() const;

private:
  void load();

  std::unique_ptr<Ui::CameraPage> ui_;
};

}  // namespace handeye
