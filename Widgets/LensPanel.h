// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoardDescription.h"
#include "HandEyeWorkbench.h"

#include <QGroupBox>

#include <memory>
#include <optional>

namespace Ui
{
class LensPanel;
}

namespace handeye
{

/// Calibration of the lens on the page Camera: board, views as they are taken, result in words.
class LensPanel : public QGroupBox
{
  Q_OBJECT

public:
  explicit LensPanel(HandEyeWorkbench& workbench, QWidget* parent = nullptr);
  ~LensPanel() override;

  void refresh();

private:
  std::optional<BoardDescription> board() const;
  void toggle();
  void printBoard();
  void openRecording();
  void showProgress();
  void showResult();

  HandEyeWorkbench& workbench_;
  std::unique_ptr<Ui::LensPanel> ui_;
  QString refusal_;
};

}  // namespace handeye
