// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "HandEyeWorkbench.h"
#include "OverlayPresenter.h"
#include "VideoView.h"

#include <QElapsedTimer>
#include <QObject>
#include <QTimer>

namespace handeye
{

/// Shows the live video with what belongs to the page: the ball as it was found, the ghost of the next place, the model. It decides
/// nothing; what it shows, the workbench has.
class VideoPresenter : public QObject
{
  Q_OBJECT

public:
  VideoPresenter(HandEyeWorkbench& workbench, VideoView& view, QObject* parent = nullptr);

  OverlayPresenter& overlay() { return *overlay_; }
  /// The frame that is on the screen, which is what a click means; the newest one may be later. Null without one.
  std::shared_ptr<const LiveView> onScreen() const { return onScreen_; }

private:
  void showFrame();
  void showBall(const LiveView& shown);
  void showGhost();
  void setLens();

  HandEyeWorkbench& workbench_;
  VideoView& view_;
  OverlayPresenter* overlay_;
  std::shared_ptr<const LiveView> given_, onScreen_;  ///< to be drawn, and drawn
  QElapsedTimer sinceShown_;
  qint64 costMs_ = 0;  ///< of the last frame, drawing included
  QTimer catchUp_;     ///< runs while a frame was left out that may be the last
  QTimer silence_;     ///< ends when no frame has come for a while
  bool hasLens_ = false;
};

}  // namespace handeye
