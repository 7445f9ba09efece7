// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LandmarkFit.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace handeye
{

namespace
{

/// The second largest extent of a point set must be this share of the largest for the points not to be on a line.
constexpr double CollinearRatio = 0.02;
/// Assignments that are looked at before the search for an order is given up: landmarks that are all alike have none anyway.
constexpr int SearchLimit = 200000;
/// Distances of two landmarks may differ by this multiple of the root mean square residual that is allowed.
constexpr double DistanceFactor = 2.5;

/// Depth-first assignment of touched points to landmarks.
class OrderSearch
{
public:
  OrderSearch(const Eigen::Matrix3Xd& model, const Eigen::Matrix3Xd& phantom, double largestRmsMm)
    : model_(model)
    , phantom_(phantom)
    , largestRmsMm_(largestRmsMm)
    , isTaken_(std::size_t(model.cols()), false)
  {
  }

  std::vector<LandmarkOrder> run()
  {
    this->extend();
    return std::move(best_);
  }

private:
  bool fitsDistances(int touched) const
  {
    const auto landmark = Eigen::Index(order_.size());
    for (Eigen::Index other = 0; other < landmark; ++other)
    {
      const double ofModel = (model_.col(landmark) - model_.col(other)).norm();
      const double ofPhantom = (phantom_.col(touched) - phantom_.col(order_[std::size_t(other)])).norm();
      if (std::abs(ofModel - ofPhantom) > DistanceFactor * largestRmsMm_)
      {
        return false;
      }
    }
    return true;
  }

  void extend()
  {
    if (Eigen::Index(order_.size()) == model_.cols())
    {
      this->keep();
      return;
    }
    for (int touched = 0; touched < int(model_.cols()) && looked_ < SearchLimit; ++touched)
    {
      if (isTaken_[std::size_t(touched)])
      {
        continue;
      }
      ++looked_;
      if (this->fitsDistances(touched))
      {
        isTaken_[std::size_t(touched)] = true;
        order_.push_back(touched);
        this->extend();
        order_.pop_back();
        isTaken_[std::size_t(touched)] = false;
      }
    }
  }

  void keep()
  {
    if (std::is_sorted(order_.begin(), order_.end()))
    {
      return;
    }
    Eigen::Matrix3Xd phantom(3, phantom_.cols());
    for (Eigen::Index i = 0; i < phantom_.cols(); ++i)
    {
      phantom.col(i) = phantom_.col(order_[std::size_t(i)]);
    }
    const double rmsMm = fitLandmarks(model_, phantom, Eigen::VectorXd::Ones(model_.cols())).rmsMm;
    if (!(rmsMm <= largestRmsMm_))
    {
      return;
    }
    best_.push_back({ order_, rmsMm });
    std::stable_sort(best_.begin(), best_.end(), [](const LandmarkOrder& a, const LandmarkOrder& b) { return a.rmsMm < b.rmsMm; });
    best_.resize(std::min(best_.size(), std::size_t(2)));
  }

  const Eigen::Matrix3Xd& model_;
  const Eigen::Matrix3Xd& phantom_;
  double largestRmsMm_;
  std::vector<bool> isTaken_;
  std::vector<int> order_;
  std::vector<LandmarkOrder> best_;
  int looked_ = 0;
};

}  // namespace

LandmarkFit fitLandmarks(const Eigen::Matrix3Xd& model, const Eigen::Matrix3Xd& phantom, const Eigen::VectorXd& weights)
{
  const Eigen::VectorXd shares = weights / weights.sum();
  const Eigen::Vector3d center_Model = model * shares, center_Phantom = phantom * shares;
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  for (Eigen::Index i = 0; i < model.cols(); ++i)
  {
    products += shares(i) * (phantom.col(i) - center_Phantom) * (model.col(i) - center_Model).transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(products, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double handedness = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1.0 : 1.0;
  const Eigen::Matrix3d turned = svd.matrixU() * Eigen::Vector3d(1, 1, handedness).asDiagonal();
  LandmarkFit fit;
  fit.modelToPhantom.linear() = turned * svd.matrixV().transpose();
  fit.modelToPhantom.translation() = center_Phantom - fit.modelToPhantom.linear() * center_Model;
  const Eigen::Matrix3Xd placed = (fit.modelToPhantom.linear() * model).colwise() + fit.modelToPhantom.translation();
  fit.rmsMm = std::sqrt((placed - phantom).colwise().squaredNorm().mean());
  return fit;
}

bool areCollinear(const Eigen::Matrix3Xd& points)
{
  const Eigen::Matrix3Xd centred = points.colwise() - points.rowwise().mean();
  const Eigen::Vector3d extents = Eigen::JacobiSVD<Eigen::Matrix3Xd>(centred).singularValues();
  return !(extents(1) > CollinearRatio * extents(0)) || !(extents(0) > 1e-6);
}

std::vector<LandmarkOrder> findOrders(const Eigen::Matrix3Xd& model, const Eigen::Matrix3Xd& phantom, double largestRmsMm)
{
  return OrderSearch(model, phantom, largestRmsMm).run();
}

}  // namespace handeye
