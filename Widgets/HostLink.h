// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "HandEyeSceneProps.h"
#include "NavigationHost.h"
#include "StreamList.h"

#include <QObject>
#include <QVector>

class QWidget;

namespace handeye
{

class HandEyeWorkbench;

/// What a navigation desktop is given of the workbench: the lights of the streams, the log, the scene.
class HostLink : public QObject
{
  Q_OBJECT

public:
  HostLink(HandEyeWorkbench& workbench, NavigationHost& host);
  ~HostLink() override;

  /// Takes the desktop's views; files that are dropped go to `receiver`.
  void enter(QWidget* video, QObject* receiver);
  void exit();

  bool isDemonstration() const { return host_.isDemonstration(); }

private:
  void showStreams();
  void showPoses();
  void showResults();

  HandEyeWorkbench& workbench_;
  NavigationHost& host_;
  HandEyeSceneProps scene_;
  bool isEntered_ = false;
};

}  // namespace handeye
