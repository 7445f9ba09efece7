// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <string>

namespace handeye::io
{

/// What a recording says about one transform in one frame: p_To = transform * p_From for the name "<From>To<To>", mm.
struct TransformSample
{
  enum class Status
  {
    Ok,
    Missing,  ///< the frame does not have this transform
    Invalid   ///< the tracker reported it as not valid, or its matrix is not a rigid motion
  };

  Status status = Status::Missing;
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();  ///< not meaningful unless status is Ok
  std::string reason;                                           ///< a sentence; empty if status is Ok

  bool isUsable() const { return status == Status::Ok; }
};

}  // namespace handeye::io
