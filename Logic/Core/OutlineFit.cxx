// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OutlineFit.h"

#include "EvenLightFit.h"
#include "OutlineEdges.h"
#include "Statistics.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace handeye
{

namespace
{

constexpr double Pi = double(EIGEN_PI);

/// One pass over the edges: how far from the expected outline they are looked for, and how densely.
struct Pass
{
  double reachPx;
  double pixelsPerNormal;
  int mostNormals;
};
constexpr Pass FirstPass = { 6, 2, 64 };
constexpr Pass SecondPass = { 3.5, 2, 96 };
constexpr Pass FinePass = { 2.5, 1, 1600 };
constexpr int FewestFinePasses = 1;
constexpr int MostFinePasses = 3;
/// The outline is where it belongs when a pass moves it by no more than this (px).
constexpr double SettledPx = 0.15;
/// Edges blurred by more than this (standard deviation, px) hide how soft they are from references that are near.
constexpr double SoftPx = 2.0;
/// From the width between a quarter and three quarters of a blurred step to its standard deviation.
constexpr double WidthToBlur = 1 / 1.349;
constexpr int FewestNormals = 48;
constexpr std::size_t FewestEdges = 12;
/// Fewer edges than this share of the normals, and it is not worth to go on.
constexpr double FewestEdgesShare = 0.15;
/// An edge point further than this many sigmas, but at least this many px, from the outline is not the ball's.
constexpr double SupportSigmas = 4;
constexpr double SupportPx = 0.75;
/// A scatter (px) of the edge points above this on the way is not the outline of a ball.
constexpr double LargestSigmaPx = 2.5;
constexpr int Rounds = 10;
/// An outline that was fitted to edges that scatter by sigma is good to so many sigmas, and not better than this (px).
constexpr double StartSigmas = 3;
constexpr double StartSigmaPx = 0.2;
constexpr double TukeyConstant = 4.685;
/// Edge points are never better than this (px): below it the weights would chase rounding.
constexpr double SmallestSigmaPx = 0.01;
/// Shading moves the edges in waves along the outline: none (the whole outline), one (all of it to one side), two, three; each
/// with this
/// share of what the light's change on either side may move a single edge by. Measured on rendered captures.
constexpr int LongestWaves = 3;
constexpr double ShadingToWave = 0.65;
/// However even the light is, the lens model and the gamma curve are not known better.
constexpr double LeastWavePx = 0.025;
/// Light whose change on either side may move more than two thirds of the edges by more than this share of their blur is not even: what
/// hides a part of a small ball is within that light.
constexpr double LargestEvenShading = 0.16;

double tukey(double residual, double sigma)
{
  const double x = residual / (TukeyConstant * sigma);
  return std::abs(x) < 1 ? (1 - x * x) * (1 - x * x) : 0;
}

/// Moves the cone so that its outline follows the edges: least squares of offset - rate . step, with Tukey's weights.
class OutlineStep
{
public:
  /// @param startSigmaPx how well the outline is known: edges far from it have no say at first; 0 where it is not
  OutlineStep(const SphereCone::Outline& outline, const std::vector<OutlineEdge>& edges, double startSigmaPx)
    : outline_(outline)
    , edges_(edges)
    , residuals_(edges.size())
    , weights_(edges.size(), 1)
  {
    for (std::size_t i = 0; i < edges.size() && startSigmaPx > 0; ++i)
    {
      weights_[i] = tukey(edges[i].offsetPx, startSigmaPx);
    }
  }

  bool solve()
  {
    for (int round = 0; round < Rounds; ++round)
    {
      const Eigen::Vector3d before = step_;
      if (!solveOnce() || !reweight())
      {
        return false;
      }
      if ((step_ - before).norm() < 1e-10)
      {
        break;
      }
    }
    return true;
  }

  const Eigen::Vector3d& step() const { return step_; }
  double sigmaPx() const { return sigmaPx_; }
  double residual(std::size_t i) const { return residuals_[i]; }

  /// Of the axis' two tilts: what the edges scatter, and what shading does to many of them together.
  Eigen::Matrix2d covariance() const
  {
    const Eigen::Matrix3d inverse = information_.inverse();
    Eigen::Matrix3d ofStep = sigmaPx_ * sigmaPx_ * inverse;
    std::vector<double> shading;
    for (const OutlineEdge& edge : edges_)
    {
      shading.push_back(edge.shadingPx * edge.shadingPx);
    }
    const double waveVariance = ShadingToWave * ShadingToWave * median(shading) + LeastWavePx * LeastWavePx;
    for (int wave = 0; wave <= LongestWaves; ++wave)
    {
      for (const double phase : { 0.0, Pi / 2 })
      {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (std::size_t i = 0; i < edges_.size(); ++i)
        {
          sum += weights_[i] * std::cos(wave * outline_.turns[edges_[i].index] - phase) * rate(i);
        }
        const Eigen::Vector3d moved = inverse * sum;
        ofStep += waveVariance * moved * moved.transpose();
      }
    }
    return ofStep.topLeftCorner<2, 2>();
  }

private:
  const Eigen::Vector3d& rate(std::size_t i) const { return outline_.rates[edges_[i].index]; }

  bool solveOnce()
  {
    information_.setZero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < edges_.size(); ++i)
    {
      information_ += weights_[i] * rate(i) * rate(i).transpose();
      right += weights_[i] * edges_[i].offsetPx * rate(i);
    }
    step_ = information_.ldlt().solve(right);
    for (std::size_t i = 0; i < edges_.size(); ++i)
    {
      residuals_[i] = edges_[i].offsetPx - rate(i).dot(step_);
    }
    return step_.allFinite();
  }

  bool reweight()
  {
    std::vector<double> sizes;
    for (std::size_t i = 0; i < edges_.size(); ++i)
    {
      if (weights_[i] > 0)
      {
        sizes.push_back(std::abs(residuals_[i]));
      }
    }
    if (sizes.size() < FewestEdges)
    {
      return false;
    }
    sigmaPx_ = std::max(median(sizes) / MedianOfChi1, SmallestSigmaPx);
    for (std::size_t i = 0; i < edges_.size(); ++i)
    {
      weights_[i] = tukey(residuals_[i], sigmaPx_);
    }
    return true;
  }

  const SphereCone::Outline& outline_;
  const std::vector<OutlineEdge>& edges_;
  std::vector<double> residuals_;
  std::vector<double> weights_;
  Eigen::Matrix3d information_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d step_ = Eigen::Vector3d::Zero();
  double sigmaPx_ = 0;
};

class Fitter
{
public:
  Fitter(const LinearLightImage& light, const CameraModel& camera, OutlineFit start)
    : light_(light)
    , camera_(camera)
    , fit_(std::move(start))
  {
  }

  std::optional<OutlineFit> fitRoughly()
  {
    const bool isGood = look(FirstPass) && fitRays() && look(SecondPass) && fitOffsets();
    return isGood ? std::optional(fit_) : std::nullopt;
  }

  std::optional<OutlineFit> fitFinely()
  {
    const EdgeWidths widths = measureWidths();
    softnessPx_ = widths.narrowPx * WidthToBlur > SoftPx ? widths.narrowPx * WidthToBlur : 0;
    for (int pass = 0; pass < FewestFinePasses || (pass < MostFinePasses && movedPx_ > SettledPx); ++pass)
    {
      if (!look(FinePass) || !fitOffsets())
      {
        return std::nullopt;
      }
    }
    refineInEvenLight();
    fit_.twoSidedWidthPx = measureWidths().twoSidedPx;
    return fit_;
  }

private:
  double radiusPx() const { return (camera_.fx() + camera_.fy()) / 2 * std::tan(fit_.cone.halfAngle); }

  /// Edges along the outline of the present cone.
  bool look(const Pass& pass)
  {
    if (!(fit_.cone.halfAngle > 0) || fit_.cone.axis_Camera.z() <= 0)
    {
      return false;
    }
    searched_ = std::clamp(int(2 * Pi * radiusPx() / pass.pixelsPerNormal), FewestNormals, pass.mostNormals);
    reachPx_ = pass.reachPx;
    outline_ = fit_.cone.outline(camera_, searched_);
    found_ =
      findOutlineEdges(light_, outline_, { pass.reachPx, radiusPx(), fit_.blurPx > 0 ? std::max(fit_.blurPx, softnessPx_) : 0 });
    fit_.blurPx = std::max(found_.blurPx, softnessPx_);
    return found_.edges.size() >= FewestEdges && double(found_.edges.size()) >= FewestEdgesShare * searched_;
  }

  EdgeWidths measureWidths() const { return measureEdgeWidths(light_, fit_.cone.outline(camera_, FewestNormals), radiusPx()); }

  /// What is known of the edge points, their scatter above all, stays as it is.
  void refineInEvenLight()
  {
    std::vector<double> shading;
    for (const OutlineEdge& edge : found_.edges)
    {
      shading.push_back(edge.shadingPx);
    }
    const auto third = shading.begin() + std::ptrdiff_t(shading.size() / 3);
    std::nth_element(shading.begin(), third, shading.end());
    if (softnessPx_ > 0 || *third > LargestEvenShading * fit_.blurPx)
    {
      return;
    }
    const std::optional<EvenLightResult> result =
      fitInEvenLight(light_, outline_, { step_, supportIndices_, radiusPx(), fit_.blurPx });
    if (result)
    {
      fit_.cone = lookedAround_.moved(result->step);
      fit_.visibleShare = std::max(fit_.visibleShare, result->visibleShare);
    }
  }

  bool fitRays()
  {
    std::vector<Eigen::Vector3d> rays;
    for (const OutlineEdge& edge : found_.edges)
    {
      const CameraModel::Unprojection ray =
        camera_.unproject(outline_.points_Image[edge.index] + edge.offsetPx * outline_.normals_Image[edge.index]);
      if (ray.isUsable())
      {
        rays.push_back(ray.ray_Camera);
      }
    }
    if (rays.size() < FewestEdges)
    {
      return false;
    }
    const SphereConeFit fit = fitSphereCone(rays, camera_, fit_.cone, reachPx_);
    fit_.cone = fit.cone;
    return fit.isUsable && fit.sigmaPx <= LargestSigmaPx;
  }

  bool fitOffsets()
  {
    OutlineStep step(outline_, found_.edges, fit_.sigmaPx > 0 ? std::max(StartSigmas * fit_.sigmaPx, StartSigmaPx) : 0);
    if (!step.solve() || step.sigmaPx() > LargestSigmaPx)
    {
      return false;
    }
    fit_.sigmaPx = step.sigmaPx();
    const Eigen::Matrix<double, 3, 2> across = fit_.cone.across();
    fit_.axisCovariance = across * step.covariance() * across.transpose();
    movedPx_ = 0;
    for (const Eigen::Vector3d& rate : outline_.rates)
    {
      movedPx_ = std::max(movedPx_, std::abs(rate.dot(step.step())));
    }
    lookedAround_ = fit_.cone;
    step_ = step.step();
    fit_.cone = lookedAround_.moved(step_);
    fit_.support_Image.clear();
    supportIndices_.clear();
    const double limit = std::max(SupportPx, SupportSigmas * fit_.sigmaPx);
    for (std::size_t i = 0; i < found_.edges.size(); ++i)
    {
      if (std::abs(step.residual(i)) <= limit)
      {
        const OutlineEdge& edge = found_.edges[i];
        fit_.support_Image.push_back(outline_.points_Image[edge.index] + edge.offsetPx * outline_.normals_Image[edge.index]);
        supportIndices_.push_back(edge.index);
      }
    }
    fit_.visibleShare = double(fit_.support_Image.size()) / searched_;
    return fit_.axisCovariance.allFinite();
  }

  const LinearLightImage& light_;
  const CameraModel& camera_;
  OutlineFit fit_;
  std::vector<std::size_t> supportIndices_;
  SphereCone lookedAround_;
  SphereCone::Outline outline_;                     ///< of that
  Eigen::Vector3d step_ = Eigen::Vector3d::Zero();  ///< from that to the fit
  OutlineEdges found_;
  int searched_ = 0;
  double reachPx_ = 0;
  double movedPx_ = 0;
  double softnessPx_ = 0;
};

}  // namespace

std::optional<OutlineFit> fitOutlineRoughly(const LinearLightImage& light, const CameraModel& camera, const SphereCone& candidate)
{
  OutlineFit start;
  start.cone = candidate;
  return Fitter(light, camera, start).fitRoughly();
}

std::optional<OutlineFit> fitOutlineFinely(const LinearLightImage& light, const CameraModel& camera, const OutlineFit& rough)
{
  return Fitter(light, camera, rough).fitFinely();
}

}  // namespace handeye
