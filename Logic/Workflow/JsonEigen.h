// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

namespace handeye
{

/// A vector as a list, a matrix as a list of rows.
template<typename Derived> nlohmann::json toJson(const Eigen::MatrixBase<Derived>& matrix)
{
  nlohmann::json rows = nlohmann::json::array();
  for (Eigen::Index row = 0; row < matrix.rows(); ++row)
  {
    if (matrix.cols() == 1)
    {
      rows.push_back(matrix(row, 0));
      continue;
    }
    nlohmann::json columns = nlohmann::json::array();
    for (Eigen::Index column = 0; column < matrix.cols(); ++column)
    {
      columns.push_back(matrix(row, column));
    }
    rows.push_back(std::move(columns));
  }
  return rows;
}

inline nlohmann::json toJson(const Eigen::Isometry3d& transform)
{
  return toJson(transform.matrix());
}

}  // namespace handeye
