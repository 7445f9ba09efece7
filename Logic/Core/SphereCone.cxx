// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SphereCone.h"

#include "Statistics.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace handeye
{

namespace
{

using Rays = std::vector<Eigen::Vector3d>;

constexpr std::size_t MinimumRays = 6;
constexpr int LinearRounds = 8;
constexpr int PolishRounds = 10;
constexpr double TukeyConstant = 4.685;
/// Edge points are never better than this (px): below it the weights would chase rounding.
constexpr double SmallestSigmaPx = 0.03;

SphereCone coneOf(const Eigen::Vector3d& n)
{
  const double length = n.norm();
  return { n / length, length > 1 ? std::acos(1 / length) : 0 };
}

Eigen::Vector3d normalOf(const SphereCone& cone)
{
  return cone.axis_Camera / std::cos(cone.halfAngle);
}

double angleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b)
{
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Pixels per radian at a ray, for a motion away from the axis.
double pixelsPerRadian(const CameraModel& camera, const Eigen::Vector3d& ray, const Eigen::Vector3d& axis)
{
  Eigen::Matrix<double, 2, 3> jacobian;
  if (!camera.project(ray, &jacobian).isUsable())
  {
    return 0;
  }
  const Eigen::Vector3d away = (ray * ray.dot(axis) - axis).normalized();
  return (jacobian * away).norm();
}

double tukey(double residual, double sigma)
{
  const double x = residual / (TukeyConstant * sigma);
  return std::abs(x) < 1 ? (1 - x * x) * (1 - x * x) : 0;
}

/// One weighted linear fit of u . n = 1; weights are of the squared residual in px.
bool solveLinear(const Rays& rays, const std::vector<double>& weights, Eigen::Vector3d& n)
{
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < rays.size(); ++i)
  {
    matrix += weights[i] * rays[i] * rays[i].transpose();
    right += weights[i] * rays[i];
  }
  const Eigen::LDLT<Eigen::Matrix3d> decomposition(matrix);
  if (decomposition.info() != Eigen::Success || !(decomposition.vectorD().minCoeff() > 0))
  {
    return false;
  }
  n = decomposition.solve(right);
  return n.allFinite() && n.norm() > 1;
}

/// The derivative of (angle to the axis - half angle) by n.
Eigen::RowVector3d angleGradient(const Eigen::Vector3d& ray, const Eigen::Vector3d& n)
{
  const double length = n.norm();
  const Eigen::Vector3d axis = n / length;
  const double sine = std::max(ray.cross(axis).norm(), 1e-12);
  const double coneSine = std::sqrt(std::max(1 - 1 / (length * length), 1e-24));
  const Eigen::Vector3d byAngle = -(ray - axis * axis.dot(ray)) / (sine * length);
  const Eigen::Vector3d byHalfAngle = axis / (length * length * coneSine);
  return (byAngle - byHalfAngle).transpose();
}

class Fitter
{
public:
  Fitter(const Rays& rays, const CameraModel& camera)
    : rays_(rays)
    , camera_(camera)
    , scale_(rays.size())
  {
    fit_.residualsPx.resize(rays.size());
    fit_.weights.resize(rays.size());
  }

  SphereConeFit run(const SphereCone& start, double startTolerancePx)
  {
    fit_.cone = start;
    measure();
    for (std::size_t i = 0; i < rays_.size(); ++i)
    {
      fit_.weights[i] = scale_[i] > 0 && std::abs(fit_.residualsPx[i]) <= startTolerancePx ? 1 : 0;
    }
    if (!linearRounds() || !polish())
    {
      return fit_;
    }
    fit_.isUsable = true;
    return fit_;
  }

private:
  void measure()
  {
    for (std::size_t i = 0; i < rays_.size(); ++i)
    {
      scale_[i] = pixelsPerRadian(camera_, rays_[i], fit_.cone.axis_Camera);
      fit_.residualsPx[i] = scale_[i] * (angleBetween(rays_[i], fit_.cone.axis_Camera) - fit_.cone.halfAngle);
    }
  }

  /// The spread of the points that have a say, and new weights from it; false if too few of them are left.
  bool reweight()
  {
    std::vector<double> sizes;
    for (std::size_t i = 0; i < rays_.size(); ++i)
    {
      if (fit_.weights[i] > 0)
      {
        sizes.push_back(std::abs(fit_.residualsPx[i]));
      }
    }
    if (sizes.size() < MinimumRays)
    {
      return false;
    }
    fit_.sigmaPx = std::max(median(sizes) / MedianOfChi1, SmallestSigmaPx);
    for (std::size_t i = 0; i < rays_.size(); ++i)
    {
      fit_.weights[i] = scale_[i] > 0 ? tukey(fit_.residualsPx[i], fit_.sigmaPx) : 0;
    }
    return std::count_if(fit_.weights.begin(), fit_.weights.end(), [](double w) { return w > 0; }) >= long(MinimumRays);
  }

  bool linearRounds()
  {
    for (int round = 0; round < LinearRounds; ++round)
    {
      std::vector<double> weights(rays_.size());
      for (std::size_t i = 0; i < rays_.size(); ++i)
      {
        weights[i] = fit_.weights[i] * scale_[i] * scale_[i];
      }
      Eigen::Vector3d n;
      if (!solveLinear(rays_, weights, n))
      {
        return false;
      }
      fit_.cone = coneOf(n);
      measure();
      if (!reweight())
      {
        return false;
      }
    }
    return true;
  }

  bool polish()
  {
    Eigen::Vector3d n = normalOf(fit_.cone);
    Eigen::Matrix3d information;
    for (int round = 0; round < PolishRounds; ++round)
    {
      information.setZero();
      Eigen::Vector3d right = Eigen::Vector3d::Zero();
      for (std::size_t i = 0; i < rays_.size(); ++i)
      {
        const Eigen::RowVector3d gradient = scale_[i] * angleGradient(rays_[i], n);
        information += fit_.weights[i] * gradient.transpose() * gradient;
        right -= fit_.weights[i] * fit_.residualsPx[i] * gradient.transpose();
      }
      const Eigen::Vector3d step = information.ldlt().solve(right);
      if (!step.allFinite() || !((n + step).norm() > 1))
      {
        return false;
      }
      n += step;
      fit_.cone = coneOf(n);
      measure();
      if (!reweight())
      {
        return false;
      }
      if (step.norm() < 1e-12 * n.norm())
      {
        break;
      }
    }
    const Eigen::Matrix3d toAxis =
      (Eigen::Matrix3d::Identity() - fit_.cone.axis_Camera * fit_.cone.axis_Camera.transpose()) / n.norm();
    fit_.axisCovariance = fit_.sigmaPx * fit_.sigmaPx * toAxis * information.inverse() * toAxis.transpose();
    return fit_.axisCovariance.allFinite();
  }

  const Rays& rays_;
  const CameraModel& camera_;
  std::vector<double> scale_;  ///< px per rad at each ray
  SphereConeFit fit_;
};

}  // namespace

double SphereCone::distance(double radiusMm) const
{
  return radiusMm / std::sin(halfAngle);
}

Eigen::Matrix<double, 3, 2> SphereCone::across() const
{
  Eigen::Matrix<double, 3, 2> directions;
  directions.col(0) = axis_Camera.unitOrthogonal();
  directions.col(1) = axis_Camera.cross(directions.col(0));
  return directions;
}

SphereCone SphereCone::moved(const Eigen::Vector3d& step) const
{
  return { (axis_Camera + across() * step.head<2>()).normalized(), halfAngle + step.z() };
}

bool SphereCone::isCloseTo(const SphereCone& other, double share) const
{
  const double apart = axis_Camera.cross(other.axis_Camera).norm();
  return apart + std::abs(halfAngle - other.halfAngle) < share * halfAngle;
}

SphereCone::Outline SphereCone::outline(const CameraModel& camera, int count) const
{
  const Eigen::Matrix<double, 3, 2> directions = across();
  const double cosine = std::cos(halfAngle), sine = std::sin(halfAngle);
  Outline result;
  for (int i = 0; i < count; ++i)
  {
    const double turn = 2 * EIGEN_PI * i / count;
    const Eigen::Vector2d turned(std::cos(turn), std::sin(turn));
    const Eigen::Vector3d side = directions * turned;
    const Eigen::Vector3d ray = cosine * axis_Camera + sine * side;
    const Eigen::Vector3d along = directions * Eigen::Vector2d(-turned.y(), turned.x());
    const Eigen::Vector3d away = cosine * side - sine * axis_Camera;
    Eigen::Matrix<double, 2, 3> jacobian;
    const CameraModel::Projection pixel = camera.project(ray, &jacobian);
    if (!pixel.isUsable())
    {
      continue;
    }
    const Eigen::Vector2d tangent = jacobian * along, outwards = jacobian * away;
    Eigen::Vector2d normal = Eigen::Vector2d(tangent.y(), -tangent.x()).normalized();
    if (normal.dot(outwards) < 0)
    {
      normal = -normal;
    }
    result.points_Image.push_back(pixel.point_Image);
    result.normals_Image.push_back(normal);
    result.turns.push_back(turn);
    result.rates.emplace_back(Eigen::Vector3d(turned.x(), turned.y(), 1) * normal.dot(outwards));
  }
  return result;
}

SphereCone coneThrough(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c)
{
  // The normal of the plane through the three tips, scaled so that a . n = 1.
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const double height = normal.dot(a);
  if (std::abs(height) < 1e-15)
  {
    return {};
  }
  const Eigen::Vector3d n = normal / height;
  return n.allFinite() && n.norm() > 1 ? coneOf(n) : SphereCone{};
}

SphereConeFit fitSphereCone(const Rays& rays, const CameraModel& camera, const SphereCone& start, double startTolerancePx)
{
  if (rays.size() < MinimumRays)
  {
    throw std::invalid_argument("the outline of a ball needs at least " + std::to_string(MinimumRays) + " edge points");
  }
  return Fitter(rays, camera).run(start, startTolerancePx);
}

}  // namespace handeye
