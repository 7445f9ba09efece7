// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "RigidTransform.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

namespace handeye::test
{

/// How far apart two rigid transforms are, rotation and translation each on its own.
inline double rotationErrorRad(const Eigen::Isometry3d& actual, const Eigen::Isometry3d& expected)
{
  return rotationAngle(actual.linear() * expected.linear().transpose());
}

inline double translationErrorMm(const Eigen::Isometry3d& actual, const Eigen::Isometry3d& expected)
{
  return (actual.translation() - expected.translation()).norm();
}

/// EXPECT_TRUE(rigid3dNear(actual, expected, 1e-9, 1e-9)): a failure says by how much each part is off.
inline testing::AssertionResult rigid3dNear(
  const Eigen::Isometry3d& actual, const Eigen::Isometry3d& expected, double rotationRad, double translationMm)
{
  const double turned = rotationErrorRad(actual, expected), moved = translationErrorMm(actual, expected);
  if (turned <= rotationRad && moved <= translationMm)
  {
    return testing::AssertionSuccess();
  }
  return testing::AssertionFailure() << "the rotation is off by " << turned << " rad (" << rotationRad
                                     << " allowed), the translation by " << moved << " mm (" << translationMm << " allowed)";
}

/// EXPECT_TRUE(pointNear(actual, expected, 1e-9)) for vectors of any length.
template<typename A, typename B>
testing::AssertionResult pointNear(const Eigen::MatrixBase<A>& actual, const Eigen::MatrixBase<B>& expected, double tolerance)
{
  const double apart = (actual - expected).norm();
  if (apart <= tolerance)
  {
    return testing::AssertionSuccess();
  }
  return testing::AssertionFailure() << "(" << actual.transpose() << ") is " << apart << " from (" << expected.transpose() << "), "
                                     << tolerance << " allowed";
}

/// EXPECT_TRUE(says(message, { "parallel" })): a sentence for a person with these words in it.
inline testing::AssertionResult says(const std::string& message, const std::vector<std::string>& words)
{
  if (std::count(message.begin(), message.end(), ' ') < 2)
  {
    return testing::AssertionFailure() << "this is not a sentence: '" << message << "'";
  }
  for (const std::string& word : words)
  {
    if (message.find(word) == std::string::npos)
    {
      return testing::AssertionFailure() << "'" << word << "' is not in: " << message;
    }
  }
  return testing::AssertionSuccess();
}

/// The call throws std::invalid_argument with a sentence that has all these words in it.
template<typename Call> void expectInvalidArgument(Call call, const std::vector<std::string>& words)
{
  try
  {
    call();
    ADD_FAILURE() << "no std::invalid_argument; expected one with '" << (words.empty() ? "" : words[0]) << "'";
  }
  catch (const std::invalid_argument& error)
  {
    EXPECT_TRUE(says(error.what(), words));
  }
}

}  // namespace handeye::test
