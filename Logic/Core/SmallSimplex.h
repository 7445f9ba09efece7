// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace handeye
{

/// min c . x  with  A x = b, x >= 0  for few rows and some hundred columns: the revised simplex method with the inverse of the basis at
/// hand. A hundred times faster than a general solver's setting up, which is what the branch and bound would spend its time on; what
/// this does not decide is for CLP. Internal.
///
/// The objective of a feasible x bounds the dual's objective. objective() is that of the last basis whose inverse was computed anew and
/// whose x was found to be feasible, and so may be used however the minimization ends; it is infinite where there was none.
template<int Rows> class SmallSimplex
{
public:
  using Column = Eigen::Matrix<double, Rows, 1>;
  using Basis = std::array<int, std::size_t(Rows)>;

  enum class End
  {
    Optimal,
    Below,      ///< the objective fell below what was asked for
    NotDecided  ///< too many steps, or not to the accuracy that is needed
  };

  void clear() { count_ = 0; }
  /// @return the column's number
  int add(const Column& column, double cost)
  {
    if (count_ == int(costs_.size()))
    {
      costs_.conservativeResize(count_ + 256);
      columns_.conservativeResize(Eigen::NoChange, count_ + 256);
    }
    columns_.col(count_) = column;
    costs_(count_) = cost;
    return count_++;
  }
  int columnCount() const { return count_; }
  auto columns() const { return columns_.leftCols(count_); }
  auto costs() const { return costs_.head(count_); }

  /// @param basis columns that are a basis with x >= 0
  End minimize(const Column& right, const Basis& basis, double stopBelow, int mostSteps = 120)
  {
    basis_ = basis;
    objective_ = std::numeric_limits<double>::infinity();
    for (int step = 0; step < mostSteps; ++step)
    {
      if (step % RefreshEvery == 0 && !refresh(right))
      {
        return End::NotDecided;
      }
      if (basisCosts_.dot(values_) < stopBelow)
      {
        return refresh(right) && objective_ < stopBelow ? End::Below : End::NotDecided;
      }
      multipliers_ = inverse_.transpose() * basisCosts_;
      reduced_.head(count_).noalias() = costs() - columns().transpose() * multipliers_;
      Eigen::Index entering = 0;
      if (reduced_.head(count_).minCoeff(&entering) > -Accuracy)
      {
        return refresh(right) ? End::Optimal : End::NotDecided;
      }
      if (!pivot(int(entering)))
      {
        break;
      }
    }
    (void)refresh(right);
    return End::NotDecided;
  }

  double objective() const { return objective_; }
  /// The dual's solution; of the last step before the end.
  const Column& multipliers() const { return multipliers_; }

private:
  static constexpr int RefreshEvery = 24;
  static constexpr double Accuracy = 1e-10, LeastPivot = 1e-9;

  /// The basis without the rounding of the steps so far. @return whether its x is feasible; only then objective() is its own
  bool refresh(const Column& right)
  {
    reduced_.resize(costs_.size());
    Eigen::Matrix<double, Rows, Rows> matrix;
    for (int row = 0; row < Rows; ++row)
    {
      matrix.col(row) = columns_.col(basis_[std::size_t(row)]);
      basisCosts_(row) = costs_(basis_[std::size_t(row)]);
    }
    inverse_ = matrix.inverse();
    values_ = inverse_ * right;
    const bool isFeasible =
      inverse_.allFinite() && values_.minCoeff() > -Accuracy && (matrix * values_ - right).cwiseAbs().maxCoeff() < Accuracy;
    objective_ = isFeasible ? basisCosts_.dot(values_) : objective_;
    return isFeasible;
  }

  bool pivot(int entering)
  {
    const Column change = inverse_ * columns_.col(entering);
    int leaving = -1;
    double least = 0;
    for (int row = 0; row < Rows; ++row)
    {
      const double ratio = std::max(0.0, values_(row)) / change(row);
      if (change(row) > LeastPivot && (leaving < 0 || ratio < least || (ratio == least && change(row) > change(leaving))))
      {
        leaving = row;
        least = ratio;
      }
    }
    if (leaving < 0)
    {
      return false;  // no bound below: for CLP to say
    }
    const auto pivotRow = (inverse_.row(leaving) / change(leaving)).eval();
    for (int row = 0; row < Rows; ++row)
    {
      inverse_.row(row) -= change(row) * pivotRow;
    }
    inverse_.row(leaving) = pivotRow;
    values_ -= least * change;
    values_(leaving) = least;
    basis_[std::size_t(leaving)] = entering;
    basisCosts_(leaving) = costs_(entering);
    return true;
  }

  Eigen::Matrix<double, Rows, Eigen::Dynamic> columns_;
  Eigen::VectorXd costs_, reduced_;
  int count_ = 0;
  Basis basis_{};
  Eigen::Matrix<double, Rows, Rows> inverse_;
  Column values_, basisCosts_, multipliers_ = Column::Zero();
  double objective_ = std::numeric_limits<double>::infinity();
};

}  // namespace handeye
