// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BallDetector.h"

#include "BallCandidates.h"
#include "BallColorLevels.h"
#include "BallEvidence.h"
#include "BallFindings.h"
#include "HoughBall.h"
#include "LinearLightImage.h"
#include "NumberWords.h"
#include "OutlineFit.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace handeye
{

namespace
{

using Status = BallDetection::Status;

constexpr double HoughSigmaPx = 2;
/// A prediction is believed to this many standard deviations.
constexpr double GateSigmas = 4;
/// The distance by the apparent size is good to this share: a ball that darkens towards its limb looks smaller than it is.
constexpr double DistanceTolerance = 0.15;

/// A scatter (px) of the edge points above this is not the outline of a ball: balls have 0.1 to 0.2 px, other things 0.3 and more. A
/// rough fit scatters more.
constexpr double LargestSigmaPx = 0.4;
constexpr double LargestRoughSigmaPx = 1.0;

/// An outline whose edges are so much wider (px) on two opposite sides moved while the picture was taken, by 10 px or more. Shading and
/// reflections alone make up to 2.
constexpr double LargestTwoSidedWidthPx = 2.2;
/// The edge points of something smeared scatter up to so much (px), and all around.
constexpr double LargestSmearedSigmaPx = 0.6;
constexpr double VisibleOfSmeared = 0.8;
/// A candidate this close to one that was tried, as a share of its size, leads to the same outline.
constexpr double AlreadyTried = 0.03;
/// From this on half of it is added to the standard deviation.
constexpr double NoticeableTwoSidedWidthPx = 1;

/// One image being searched.
class Search
{
public:
  Search(const cv::Mat& image, const cv::Rect& window, const CameraModel& camera, const RayGrid& grid,
    const BallDetectionOptions& options)
    : image_(image)
    , camera_(camera)
    , grid_(grid)
    , options_(options)
    , levels_(image, adaptToLight(options.color, image), window)
    , light_(image)
  {
  }

  /// Looks at every level of the colour: the ball may be one with what is around it at one level, and alone at another.
  BallFindings run()
  {
    const auto isKnown = [&](const cv::Rect& region) { return findings_.hasAround(region); };
    const double focalPx = (camera_.fx() + camera_.fy()) / 2;
    cv::Rect part = levels_.window();
    for (int level = 0; level < BallColorLevels::Count && !part.empty(); ++level)
    {
      const BallCandidates candidates =
        findBallCandidates(levels_.mask(level, part), part.tl(), grid_, focalPx, options_.minimumRadiusPx, isKnown);
      // All levels lie within the first.
      part = level == 0 ? candidates.around : part;
      for (const SphereCone& candidate : candidates.cones)
      {
        follow(candidate, level);
      }
    }
    findings_.sort();
    return std::move(findings_);
  }

private:
  void follow(const SphereCone& candidate, int level)
  {
    if (findings_.has(candidate))
    {
      return;
    }
    Attempt& attempt = attemptAt(candidate);
    if (!attempt.rough ||
      !judgeOutline(*attempt.rough, image_, levels_, level, camera_, options_, LargestRoughSigmaPx).isPartOfBall)
    {
      return;
    }
    if (!attempt.isFollowed)
    {
      attempt.fine = fitOutlineFinely(light_, camera_, *attempt.rough);
      attempt.isFollowed = true;
    }
    if (const std::optional<OutlineFit>& fit = attempt.fine)
    {
      const auto judge = [&](double largestSigmaPx)
      { return judgeOutline(*fit, image_, levels_, level, camera_, options_, largestSigmaPx); };
      const FoundBall found{ *fit, judge(LargestSigmaPx) };
      const bool isSmeared = !found.evidence.isBall && fit->twoSidedWidthPx > LargestTwoSidedWidthPx &&
        fit->visibleShare >= VisibleOfSmeared && judge(LargestSmearedSigmaPx).isBall;
      isSmeared ? findings_.smeared.push_back(found) : findings_.add(found);
    }
  }

  /// What became of a candidate: the same at every level.
  struct Attempt
  {
    SphereCone candidate;
    std::optional<OutlineFit> rough;
    bool isFollowed = false;
    std::optional<OutlineFit> fine;
  };

  Attempt& attemptAt(const SphereCone& candidate)
  {
    const auto same = std::find_if(attempts_.begin(), attempts_.end(),
      [&](const Attempt& attempt) { return attempt.candidate.isCloseTo(candidate, AlreadyTried); });
    if (same != attempts_.end())
    {
      return *same;
    }
    attempts_.push_back({ candidate, fitOutlineRoughly(light_, camera_, candidate), false, {} });
    return attempts_.back();
  }

  const cv::Mat& image_;
  const CameraModel& camera_;
  const RayGrid& grid_;
  const BallDetectionOptions& options_;
  BallColorLevels levels_;
  LinearLightImage light_;
  BallFindings findings_;
  std::vector<Attempt> attempts_;
};

/// Fills in all that follows from the ray to the ball's centre.
void describe(const Eigen::Vector3d& ray, const Eigen::Matrix3d& rayCovariance, const CameraModel& camera, BallDetection& result)
{
  Eigen::Matrix<double, 2, 3> jacobian;
  result.ray_Camera = ray;
  result.ball_Image = camera.project(ray, &jacobian).point_Image;
  result.covariance_Image = jacobian * rayCovariance * jacobian.transpose();
}

BallDetection describe(const FoundBall& found, const CameraModel& camera, double ballRadiusMm)
{
  BallDetection result;
  describe(found.fit.cone.axis_Camera, found.fit.axisCovariance, camera, result);
  const double motionPx = found.fit.twoSidedWidthPx > NoticeableTwoSidedWidthPx ? found.fit.twoSidedWidthPx / 2 : 0;
  result.covariance_Image += motionPx * motionPx * Eigen::Matrix2d::Identity();
  result.status = Status::Found;
  result.message = "ball found";
  result.radiusPx = found.evidence.radiusPx;
  result.distanceMm = found.fit.cone.distance(ballRadiusMm);
  result.visibleShare = found.fit.visibleShare;
  result.confidence = found.score();
  result.outline_Image = found.fit.support_Image;
  return result;
}

BallDetection refuse(Status status, const std::string& message)
{
  BallDetection result;
  result.status = status;
  result.message = message;
  return result;
}

bool isInRange(const FoundBall& found, double ballRadiusMm, const BallDetectionOptions& options)
{
  const double distanceMm = found.fit.cone.distance(ballRadiusMm);
  return distanceMm >= (1 - DistanceTolerance) * options.nearestMm && distanceMm <= (1 + DistanceTolerance) * options.furthestMm;
}

/// What a prediction says of the balls that were found.
class Gate
{
public:
  Gate(const BallPrediction& prediction, const CameraModel& camera)
    : predicted_(camera.project(prediction.ball_Camera))
    , distanceMm_(prediction.ball_Camera.norm())
    , reachPx_(GateSigmas * prediction.sigmaPx)
  {
  }

  /// Where the ball cannot be seen nothing can be said.
  bool isUsable() const { return predicted_.isUsable(); }

  double apartPx(const FoundBall& found, const CameraModel& camera) const
  {
    return (camera.project(found.fit.cone.axis_Camera).point_Image - predicted_.point_Image).norm();
  }

  bool admits(const FoundBall& found, const CameraModel& camera, double ballRadiusMm) const
  {
    const double ratio = found.fit.cone.distance(ballRadiusMm) / distanceMm_;
    return apartPx(found, camera) <= reachPx_ && std::abs(std::log(ratio)) <= std::log(1 + DistanceTolerance);
  }

private:
  CameraModel::Projection predicted_;
  double distanceMm_;
  double reachPx_;
};

}  // namespace

void BallPrediction::check() const
{
  if (!ball_Camera.allFinite() || !(sigmaPx > 0) || !std::isfinite(sigmaPx))
  {
    throw std::invalid_argument("a prediction of the ball needs a finite place (mm) and a positive standard deviation (px)");
  }
}

BallDetector::BallDetector(const CameraModel& camera, double ballRadiusMm, const BallDetectionOptions& options)
  : camera_(camera)
  , ballRadiusMm_(ballRadiusMm)
  , options_(options)
{
  options.check();
  if (!(ballRadiusMm > 0) || !std::isfinite(ballRadiusMm))
  {
    throw std::invalid_argument("the ball's radius must be a positive number of mm");
  }
  if (camera.hasImageSize())
  {
    grid_ = std::make_shared<RayGrid>(camera, cv::Size(camera.width(), camera.height()));
  }
}

BallDetection BallDetector::detect(const cv::Mat& image, const std::optional<BallPrediction>& prediction) const
{
  return detectIn(image, { 0, 0, image.cols, image.rows }, prediction);
}

BallDetection BallDetector::detectIn(
  const cv::Mat& image, const cv::Rect& window, const std::optional<BallPrediction>& prediction) const
{
  if (camera_.hasImageSize() && (image.cols != camera_.width() || image.rows != camera_.height()))
  {
    throw std::invalid_argument("the image is " + std::to_string(image.cols) + " x " + std::to_string(image.rows) +
      " px, the camera was calibrated for " + std::to_string(camera_.width()) + " x " + std::to_string(camera_.height()) + " px");
  }
  requireColorImage(image);
  if (prediction)
  {
    prediction->check();
  }
  return options_.method == BallDetectionOptions::Method::Exact ? detectExact(image, window, prediction) : detectHough(image);
}

BallDetection BallDetector::detectExact(
  const cv::Mat& image, const cv::Rect& window, const std::optional<BallPrediction>& prediction) const
{
  const cv::Rect searched = window & cv::Rect({ 0, 0 }, image.size());
  const std::shared_ptr<const RayGrid> grid = grid_ ? grid_ : std::make_shared<RayGrid>(camera_, image.size());
  auto [balls, smeared, partlySeen] = searched.empty() ? BallFindings() : Search(image, searched, camera_, *grid, options_).run();
  const char* const moved = "the ball is seen, but its outline is smeared: hold the ball and the camera still";
  if (balls.empty() && !smeared.empty())
  {
    return refuse(Status::Blurred, moved);
  }
  if (balls.empty())
  {
    BallDetection none = partlySeen > 0 ? refuse(Status::TooLittleVisible, "too little of the ball's outline is visible")
                                        : refuse(Status::NotFound, "no ball is seen");
    none.visibleShare = partlySeen;
    return none;
  }
  const FoundBall best = balls.front();
  const auto outOfRange = [&](const FoundBall& found) { return !isInRange(found, ballRadiusMm_, options_); };
  balls.erase(std::remove_if(balls.begin(), balls.end(), outOfRange), balls.end());
  if (balls.empty())
  {
    return refuse(Status::OutOfRange,
      "something like the ball is seen at " + fixedDigits(best.fit.cone.distance(ballRadiusMm_), 0) +
        " mm, outside of the working range of " + fixedDigits(options_.nearestMm, 0) + " to " +
        fixedDigits(options_.furthestMm, 0) + " mm");
  }
  if (prediction)
  {
    const Gate gate(*prediction, camera_);
    const double apartPx = gate.isUsable() ? gate.apartPx(balls.front(), camera_) : 0;
    const auto elsewhere = [&](const FoundBall& found) { return !gate.isUsable() || !gate.admits(found, camera_, ballRadiusMm_); };
    balls.erase(std::remove_if(balls.begin(), balls.end(), elsewhere), balls.end());
    if (balls.empty())
    {
      return refuse(Status::Elsewhere,
        "something like the ball is seen, but " +
          (apartPx > 0 ? fixedDigits(apartPx, 0) + " px from where the tracker puts the ball, or at another distance"
                       : std::string("by the tracker the ball is out of view")));
    }
  }
  if (balls.size() > 1 && balls[0].score() < options_.distinctionFactor * balls[1].score())
  {
    return refuse(
      Status::SeveralBalls, std::to_string(balls.size()) + " things look like the ball: take the others out of the view");
  }
  if (balls.front().fit.twoSidedWidthPx > LargestTwoSidedWidthPx)
  {
    return refuse(Status::Blurred, moved);
  }
  return describe(balls.front(), camera_, ballRadiusMm_);
}

BallDetection BallDetector::detectHough(const cv::Mat& image) const
{
  HoughBallOptions hough;
  hough.channelOrder = options_.color.channelOrder;
  const std::optional<HoughCircle> circle = findHoughCircle(image, hough);
  if (!circle)
  {
    return refuse(Status::NotFound, "no circle is seen");
  }
  const CameraModel::Unprojection ray = camera_.unproject({ circle->center_Image.x, circle->center_Image.y });
  if (!ray.isUsable())
  {
    return refuse(Status::NotFound, "the circle lies outside of what the lens model covers");
  }
  BallDetection result;
  // The transform gives no measure of its error; the centres of right circles were 2 px off in our renderings.
  describe(ray.ray_Camera, Eigen::Matrix3d::Zero(), camera_, result);
  result.covariance_Image = HoughSigmaPx * HoughSigmaPx * Eigen::Matrix2d::Identity();
  result.status = Status::Found;
  result.message = "circle found";
  result.radiusPx = circle->radiusPx;
  result.distanceMm = ballRadiusMm_ / std::sin(std::atan(circle->radiusPx / ((camera_.fx() + camera_.fy()) / 2)));
  result.visibleShare = 1;
  result.confidence = 1;
  return result;
}

}  // namespace handeye
