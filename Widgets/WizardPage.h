// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "HandEyeWorkbench.h"

#include <QWidget>

namespace handeye
{

/// One page of the wizard. It shows what the workbench has and asks it for more; whether a page's result is usable, and why not,
/// says the workbench (HandEyeWorkbench::problemOf()).
class WizardPage : public QWidget
{
  Q_OBJECT

public:
  WizardPage(HandEyeWorkbench& workbench, WizardStep step, QWidget* parent = nullptr)
    : QWidget(parent)
    , workbench_(workbench)
    , step_(step)
  {
  }

  WizardStep step() const { return step_; }

  /// The page is shown from now on, or no longer.
  virtual void enter() {}
  virtual void leave() {}
  /// Something of the workbench is different.
  virtual void refresh() {}
  /// A key pressed in the video. @return whether it meant something here
  virtual bool keyInVideo(int /*key*/) { return false; }
  /// A click in the video. @param shown the frame that a person saw there then, @param point_Image px of it
  virtual void clickInVideo(const std::shared_ptr<const LiveView>& /*shown*/, const QPointF& /*point_Image*/) {}

protected:
  HandEyeWorkbench& workbench_;

private:
  WizardStep step_;
};

}  // namespace handeye
