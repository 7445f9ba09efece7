// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "HandEyeWorkbench.h"
#include "VideoView.h"

#include <QElapsedTimer>
#include <QObject>

namespace handeye
{

/// Shows the live video with what belongs to the page: the ball as it was found, the ghost of the next place, the model. It decides
/// nothing; what it shows, the workbench has.
class VideoPresenter : public QObject
{
  Q_OBJECT

public:
  VideoPresenter(HandEyeWorkbench& workbench, VideoView& view, QObject* parent = nullptr);

  void setOpacity(double opacity);

signals:
  /// Why the model is not drawn, a sentence; empty if it is.
  void overlayProblemChanged(const QString& problem);

private:
  void showFrame();
  void showBall(const LiveView& shown);
  void showGhost();
  void showModel(const LiveView& shown);
  void setLens();

  HandEyeWorkbench& workbench_;
  VideoView& view_;
  double opacity_ = 0.65;
  QElapsedTimer sinceShown_;
  qint64 costMs_ = 0;  ///< of the last frame, drawing included
  bool hasLens_ = false;
};

}  // namespace handeye
