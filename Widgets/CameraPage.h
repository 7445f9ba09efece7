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

class LensPanel;

/// The camera's lens: from a file of any kind, the simulated room's own, or calibrated with a board.
class CameraPage : public WizardPage
{
  Q_OBJECT

public:
  explicit CameraPage(HandEyeWorkbench& workbench, QWidget* parent = nullptr);
  ~CameraPage() override;

  void refresh() override;
  void leave() override;

private:
  void load();

  std::unique_ptr<Ui::CameraPage> ui_;
  LensPanel* lensPanel_;
};

}  // namespace handeye
