// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "TouchTask.h"

#include <QCoreApplication>

namespace handeye
{

void TouchTask::reset(
  const std::optional<Eigen::Vector3d>& tip_Stylus, const std::string& stylusToTracker, const std::string& phantomToTracker)
{
  if (tip_Stylus == tip_Stylus_ && stylusToTracker == stylusToTracker_ && phantomToTracker == phantomToTracker_)
  {
    return;
  }
  stylusToTracker_ = stylusToTracker;
  phantomToTracker_ = phantomToTracker;
  tip_Stylus_ = tip_Stylus;
  tip_Phantom_.reset();
  stillness_.reset();
  newestSec_ = -1;
}

void TouchTask::add(const devices::PairedFrame& frame)
{
  tip_Phantom_.reset();
  problem_.clear();
  if (!tip_Stylus_)
  {
    problem_ = QCoreApplication::translate("handeye::TouchTask", "The stylus is not calibrated yet.");
    return;
  }
  const double timeSec = frame.image.timeSec;
  if (!stillness_ || timeSec < newestSec_)
  {
    stillness_.emplace(*tip_Stylus_);
  }
  newestSec_ = timeSec;
  for (const std::string& name : { stylusToTracker_, phantomToTracker_ })
  {
    const auto pose = frame.poses.find(name);
    if (pose == frame.poses.end() || !pose->second.isUsable())
    {
      problem_ = QString::fromStdString(name + ": ") +
        (pose == frame.poses.end() ? QCoreApplication::translate("handeye::TouchTask", "no pose was received")
                                   : QString::fromStdString(pose->second.message));
      (void)stillness_->addInvalid(timeSec);
      return;
    }
  }
  const Eigen::Isometry3d trackerToPhantom = frame.poses.at(phantomToTracker_).transform.inverse();
  const Eigen::Isometry3d stylusToPhantom = trackerToPhantom * frame.poses.at(stylusToTracker_).transform;
  tip_Phantom_ = stylusToPhantom * *tip_Stylus_;
  (void)stillness_->add(timeSec, stylusToPhantom);
}

std::optional<Eigen::Vector3d> TouchTask::rest_Phantom() const
{
  const std::optional<Rest> rest = stillness_ && tip_Phantom_ ? stillness_->current() : std::nullopt;
  return rest ? std::optional<Eigen::Vector3d>(rest->tip_World) : std::nullopt;
}

}  // namespace handeye
