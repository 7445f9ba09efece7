// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "WizardPage.h"

#include <memory>

namespace Ui
{
class BallPage;
}

namespace handeye
{

/// The ball: its radius, its colour from one click, the four pictures of its detection; and the latency of the video.
class BallPage : public WizardPage
{
  Q_OBJECT

public:
  explicit BallPage(HandEyeWorkbench& workbench, QWidget* parent = nullptr);
  ~BallPage() override;

  void refresh() override;
  void leave() override;
  void clickInVideo(const std::shared_ptr<const LiveView>& shown, const QPointF& point_Image) override;

private:
  void connectLatency();
  void showFrame();
  void showLatency();
  void showLatencyProgress(double share);

  std::unique_ptr<Ui::BallPage> ui_;
  std::shared_ptr<const LiveView> inStages_;  ///< the frame whose pictures are shown
  QString measured_;                          ///< what was said of the last measurement...
  double measuredSec_ = 0;                    ///< ...and the latency that it was of
};

}  // namespace handeye
