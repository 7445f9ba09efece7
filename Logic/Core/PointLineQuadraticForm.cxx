// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PointLineQuadraticForm.h"

#include "RigidTransform.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace handeye
{

namespace
{

using Vector9 = PointLineQuadraticForm::Vector9;
using Matrix39 = Eigen::Matrix<double, 3, 9>;
/// A symmetric 3x3 matrix as (xx, xy, xz, yy, yz, zz).
using Packed = Eigen::Matrix<double, 6, 1>;

Vector9 vec(const Eigen::Matrix3d& matrix)
{
  return Eigen::Map<const Vector9>(matrix.data());
}

Eigen::Matrix3d unpack(const Packed& packed)
{
  Eigen::Matrix3d matrix;
  matrix << packed(0), packed(1), packed(2), packed(1), packed(3), packed(4), packed(2), packed(4), packed(5);
  return matrix;
}

/// w (I - d d^T), packed.
Packed weightedProjector(const PointLinePair& pair)
{
  const Eigen::Vector3d& d = pair.direction_Lines;
  const double scale = pair.weight / d.squaredNorm();
  Packed packed;
  packed << scale * (d.y() * d.y() + d.z() * d.z()), -scale * d.x() * d.y(), -scale * d.x() * d.z(),
    scale * (d.x() * d.x() + d.z() * d.z()), -scale * d.y() * d.z(), scale * (d.x() * d.x() + d.y() * d.y());
  return packed;
}

/// Where the products of two coordinates stand among 1, x, y, z, xx, xy, xz, yy, yz, zz, the first one not greater.
int monomialOf(int a, int b)
{
  return a == 0 ? 4 + b : a == 1 ? 6 + b : 9;
}

Eigen::Vector3d apply(const Packed& packed, const Eigen::Vector3d& v)
{
  return { packed(0) * v.x() + packed(1) * v.y() + packed(2) * v.z(), packed(1) * v.x() + packed(3) * v.y() + packed(4) * v.z(),
    packed(2) * v.x() + packed(4) * v.y() + packed(5) * v.z() };
}

}  // namespace

PointLineQuadraticForm::PointLineQuadraticForm(const std::vector<PointLinePair>& pairs, const PointLineSums& sums)
  : sums_(sums)
  , linesCentre_(pairs.front().origin_Lines)
{
  if (!sums_.hasCommonOrigin)
  {
    sumOffsets(pairs);
  }
  Matrix39 moment;
  for (int a = 0; a < 3; ++a)
  {
    moment.middleCols<3>(3 * a) = unpack(sums_.products.col(1 + a));
    for (int b = a; b < 3; ++b)
    {
      quadratic_.block<3, 3>(3 * a, 3 * b) = unpack(sums_.products.col(monomialOf(a, b)));
      quadratic_.block<3, 3>(3 * b, 3 * a) = quadratic_.block<3, 3>(3 * a, 3 * b);
    }
  }
  eliminateTranslation(unpack(sums_.products.col(0)), moment);
}

void PointLineQuadraticForm::sumOffsets(const std::vector<PointLinePair>& pairs)
{
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  for (const PointLinePair& pair : pairs)
  {
    offset += apply(weightedProjector(pair), pair.origin_Lines - linesCentre_);
  }
  linesCentre_ += unpack(sums_.products.col(0)).ldlt().solve(offset);
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const PointLinePair& pair : pairs)
  {
    const Eigen::Vector3d x = pair.point_Points - sums_.centroid_Points, origin = pair.origin_Lines - linesCentre_;
    const Eigen::Vector3d off = apply(weightedProjector(pair), origin);
    moments += off * x.transpose();
    constant_ += origin.dot(off);
  }
  linear_ = -vec(moments);
}

Eigen::Matrix<double, 6, 6> PointLineQuadraticForm::centredInformation(const Eigen::Matrix3d& rotation) const
{
  // -skew(R x) = -sum_a x_a skew(R e_a), so that the sums of x_a V and x_a x_b V are all that is needed.
  Eigen::Matrix<double, 6, 6> information;
  Eigen::Matrix3d turns = Eigen::Matrix3d::Zero(), mixed = Eigen::Matrix3d::Zero();
  for (int a = 0; a < 3; ++a)
  {
    const Eigen::Matrix3d left = skew(rotation.col(a));
    mixed += left * unpack(sums_.products.col(1 + a));
    for (int b = 0; b < 3; ++b)
    {
      const Eigen::Matrix3d half = left * unpack(sums_.products.col(monomialOf(std::min(a, b), std::max(a, b))));
      turns -= half * skew(rotation.col(b));
    }
  }
  information << turns, mixed, mixed.transpose(), unpack(sums_.products.col(0));
  return information;
}

double PointLineQuadraticForm::spread() const
{
  // The trace of V is 2.
  double sum = 0;
  for (int a = 0; a < 3; ++a)
  {
    sum += unpack(sums_.products.col(monomialOf(a, a))).trace();
  }
  return std::sqrt(std::max(0.0, sum / (2 * sums_.totalWeight)));
}

void PointLineQuadraticForm::eliminateTranslation(const Eigen::Matrix3d& sum, const Matrix39& moment)
{
  // Parallel lines leave the lowest of the three eigenvalues at zero; their sum is twice the total weight.
  const double scale = sum.trace();
  determinesTranslation_ = sum.determinant() > 1e-12 * scale * scale * scale / 16;
  if (!determinesTranslation_)
  {
    return;
  }
  rotationToTranslation_.noalias() = -sum.inverse() * moment;
  quadratic_.noalias() += moment.transpose() * rotationToTranslation_;
  quadratic_ = (0.5 * (quadratic_ + quadratic_.transpose())).eval();
}

double PointLineQuadraticForm::cost(const Eigen::Matrix3d& rotation) const
{
  const Vector9 r = vec(rotation);
  return r.dot(quadratic_ * r) + 2 * linear_.dot(r) + constant_;
}

Eigen::Vector3d PointLineQuadraticForm::translation(const Eigen::Matrix3d& rotation) const
{
  return rotationToTranslation_ * vec(rotation) + linesCentre_ - rotation * sums_.centroid_Points;
}

Eigen::Isometry3d PointLineQuadraticForm::pointsToLines(const Eigen::Matrix3d& rotation) const
{
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.linear() = rotation;
  transform.translation() = translation(rotation);
  return transform;
}

}  // namespace handeye
