// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BallDetection.h"

#include "BallCandidates.h"
#include "HoughBall.h"
#include "OutlineEdges.h"
#include "SphereCone.h"

#include <Eigen/Dense>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace handeye
{

namespace
{

using Status = BallDetection::Status;

constexpr double Pi = double(EIGEN_PI);

/// How far from the expected outline (px) edges are looked for, one pass after the other.
constexpr double ReachPx[] = { 6, 3.5, 2.5, 2.5 };
constexpr std::size_t FewestEdges = 12;
/// An edge point further than this many sigmas, but at least this many px, from the outline is not the ball's.
constexpr double SupportSigmas = 4;
constexpr double SupportPx = 0.75;
/// A scatter (px) of the edge points above this is not the outline of a ball: balls have 0.1 to 0.2 px, other things 0.3 and more.
/// On the way to the final outline more is allowed.
constexpr double LargestSigmaPx = 0.4;
constexpr double LargestSigmaOnTheWayPx = 2.5;
/// A scatter of this much halves the trust in an outline.
constexpr double HalfTrustSigmaPx = 0.4;
constexpr double HoughSigmaPx = 2;
constexpr int OutlineCorners = 90;
/// A candidate this close to a ball that was found, as a share of its size, is that ball.
constexpr double AlreadyKnown = 0.1;
/// Largest share of the outline, of what is seen of it, across which the ball's colour goes on without an edge: a piece of
/// something longer is not a ball.
constexpr double LargestContinuedShare = 0.35;
/// The colour is looked at this far inside and outside of the outline: a share of the radius, within limits in px.
constexpr double AcrossShare = 0.25;
constexpr double NearestAcrossPx = 2;
constexpr double FurthestAcrossPx = 4;
/// Edge points this close to each other share what shading and reflections do to them (rad along the outline): they do not average
/// out.
constexpr double CorrelationAngle = double(EIGEN_PI);
/// Least share of the outline's inside that has the colour itself, highlights not counted.
constexpr double LeastColor = 0.4;

/// A fitted outline and what speaks for it.
struct Fitted
{
  SphereConeFit fit;
  std::vector<Eigen::Vector2d> support_Image;
  double visibleShare = 0;
  double fill = 0;
  double radiusPx = 0;
  double continuedShare = 0;  ///< of the outline: the colour goes on across it
  bool isBall = false;        ///< passes every test
  bool isPartOfBall = false;  ///< passes all but the visible share

  /// 0 to 1
  double score() const
  {
    const double scatter = fit.sigmaPx / HalfTrustSigmaPx;
    return visibleShare * fill / (1 + scatter * scatter);
  }
};

/// Edges and cone in turn, from coarse to fine.
bool refine(const LinearLightImage& light, const CameraModel& camera, const SphereCone& candidate, Fitted& fitted)
{
  fitted.fit.cone = candidate;
  double blurPx = 0;
  for (double reachPx : ReachPx)
  {
    const OutlineEdges found = findOutlineEdges(light, camera, fitted.fit.cone, reachPx, blurPx);
    if (found.edges.size() < FewestEdges)
    {
      return false;
    }
    blurPx = found.blurPx;
    std::vector<Eigen::Vector3d> rays;
    for (const OutlineEdges::Edge& edge : found.edges)
    {
      rays.push_back(edge.ray_Camera);
    }
    const SphereConeFit fit = fitSphereCone(rays, camera, fitted.fit.cone, reachPx);
    if (!fit.isUsable || fit.sigmaPx > LargestSigmaOnTheWayPx || fit.cone.axis_Camera.z() <= 0)
    {
      return false;
    }
    fitted.fit = fit;
    fitted.support_Image.clear();
    const double limit = std::max(SupportPx, SupportSigmas * fit.sigmaPx);
    for (std::size_t i = 0; i < found.edges.size(); ++i)
    {
      if (std::abs(fit.residualsPx[i]) <= limit)
      {
        fitted.support_Image.push_back(found.edges[i].point_Image);
      }
    }
    fitted.visibleShare = double(fitted.support_Image.size()) / found.searched;
  }
  return true;
}

/// What the outline's inside looks like.
struct Inside
{
  double colored = 0;           ///< share with the ball's colour
  double highlights = 0;        ///< share of pale, bright pixels
  double medianSaturation = 0;  ///< of the coloured ones, 0 to 1
};

Inside lookInside(const cv::Mat& hsv, const cv::Mat& colorMask, const std::vector<cv::Point>& polygon)
{
  const cv::Rect area = cv::boundingRect(polygon) & cv::Rect({ 0, 0 }, hsv.size());
  Inside inside;
  if (area.empty())
  {
    return inside;
  }
  cv::Mat disc = cv::Mat::zeros(area.size(), CV_8U);
  cv::fillPoly(disc, std::vector<std::vector<cv::Point>>{ polygon }, 255, cv::LINE_8, 0, -area.tl());
  const double total = cv::countNonZero(disc);
  const cv::Mat colored = disc & colorMask(area);
  const double coloredCount = cv::countNonZero(colored);
  if (!(total > 0) || !(coloredCount > 0))
  {
    return inside;
  }
  inside.colored = coloredCount / total;
  inside.highlights = cv::countNonZero(disc & highlightMask(hsv(area)) & ~colored) / total;
  cv::Mat saturation, histogram;
  cv::extractChannel(hsv(area), saturation, 1);
  const int channel = 0, bins = 256;
  const float range[] = { 0, 256 };
  const float* ranges = range;
  cv::calcHist(&saturation, 1, &channel, colored, histogram, 1, &bins, &ranges);
  double below = 0;
  for (int bin = 0; bin < bins && below < coloredCount / 2; ++bin)
  {
    below += histogram.at<float>(bin);
    inside.medianSaturation = bin / 255.0;
  }
  return inside;
}

bool isColored(const cv::Mat& colorMask, const Eigen::Vector2d& point)
{
  const cv::Point pixel(int(std::lround(point.x())), int(std::lround(point.y())));
  return cv::Rect({ 0, 0 }, colorMask.size()).contains(pixel) && colorMask.at<uchar>(pixel) != 0;
}

/// The share of the outline across which the colour goes on and no edge was found.
double continuedShare(const cv::Mat& colorMask, const SphereCone::Outline& outline, const Fitted& fitted)
{
  const double across = std::clamp(AcrossShare * fitted.radiusPx, NearestAcrossPx, FurthestAcrossPx);
  const double near = 2 * Pi * fitted.radiusPx / double(outline.points_Image.size()) + 1;
  int continued = 0;
  for (std::size_t i = 0; i < outline.points_Image.size(); ++i)
  {
    const Eigen::Vector2d& point = outline.points_Image[i];
    const Eigen::Vector2d step = across * outline.normals_Image[i];
    if (isColored(colorMask, point - step) && isColored(colorMask, point + step))
    {
      const auto isHere = [&](const Eigen::Vector2d& edge) { return (edge - point).norm() < near; };
      continued += std::none_of(fitted.support_Image.begin(), fitted.support_Image.end(), isHere) ? 1 : 0;
    }
  }
  return double(continued) / double(outline.points_Image.size());
}

void judge(
  const cv::Mat& hsv, const cv::Mat& colorMask, const CameraModel& camera, const BallDetectionOptions& options, Fitted& fitted)
{
  std::vector<cv::Point2f> polygon;
  std::vector<cv::Point> rounded;
  const SphereCone::Outline outline = fitted.fit.cone.outline(camera, OutlineCorners);
  for (const Eigen::Vector2d& point : outline.points_Image)
  {
    polygon.emplace_back(float(point.x()), float(point.y()));
    rounded.emplace_back(int(std::lround(point.x())), int(std::lround(point.y())));
  }
  if (polygon.size() < OutlineCorners / 2)
  {
    return;
  }
  fitted.radiusPx = std::sqrt(cv::contourArea(polygon) / Pi);
  const Inside inside = lookInside(hsv, colorMask, rounded);
  fitted.fill = std::min(1.0, inside.colored + inside.highlights);
  fitted.continuedShare = continuedShare(colorMask, outline, fitted);
  const bool isWhole = fitted.continuedShare <= LargestContinuedShare * (fitted.visibleShare + fitted.continuedShare);
  fitted.isPartOfBall = isWhole && fitted.fit.sigmaPx <= LargestSigmaPx && fitted.radiusPx >= options.minimumRadiusPx &&
    fitted.fill >= options.minimumFill && inside.colored >= LeastColor &&
    inside.medianSaturation >= options.color.minimumMedianSaturation;
  fitted.isBall = fitted.isPartOfBall && fitted.visibleShare >= options.minimumVisibleShare;
}

/// Two outlines of the same thing: their centres are closer than the larger radius.
bool isSameBall(const Fitted& a, const Fitted& b)
{
  const double apart = a.fit.cone.axis_Camera.cross(b.fit.cone.axis_Camera).norm();
  return apart < std::sin(std::max(a.fit.cone.halfAngle, b.fit.cone.halfAngle));
}

/// Fills in all that follows from the ray to the ball's centre.
void describe(const Eigen::Vector3d& ray, const Eigen::Matrix3d& rayCovariance, const CameraModel& camera, BallDetection& result)
{
  Eigen::Matrix<double, 2, 3> jacobian;
  result.ray_Camera = ray;
  result.ball_Image = camera.project(ray, &jacobian).point_Image;
  result.covariance_Image = jacobian * rayCovariance * jacobian.transpose();
}

/// All that is found in one image, each ball once.
struct Findings
{
  std::vector<Fitted> balls;
  double partlySeen = 0;  ///< visible share of something that is a ball but for that

  bool has(const SphereCone& candidate) const
  {
    return std::any_of(balls.begin(), balls.end(),
      [&](const Fitted& ball)
      {
        const SphereCone& known = ball.fit.cone;
        const double apart = known.axis_Camera.cross(candidate.axis_Camera).norm();
        return apart + std::abs(known.halfAngle - candidate.halfAngle) < AlreadyKnown * known.halfAngle;
      });
  }

  void add(const Fitted& fitted)
  {
    if (!fitted.isBall)
    {
      partlySeen = fitted.isPartOfBall ? std::max(partlySeen, fitted.visibleShare) : partlySeen;
      return;
    }
    const auto same = std::find_if(balls.begin(), balls.end(), [&](const Fitted& other) { return isSameBall(fitted, other); });
    if (same == balls.end())
    {
      balls.push_back(fitted);
    }
    else if (fitted.score() > same->score())
    {
      *same = fitted;
    }
  }
};

/// Looks at every level of the colour: the ball may be one with what is around it at one level, and alone at another.
Findings findBalls(const cv::Mat& image, const CameraModel& camera, const BallDetectionOptions& options)
{
  Findings findings;
  const cv::Mat hsv = toHsv(image);
  const LinearLightImage light(image);
  for (const BallColor& level : colorLevels(options.color))
  {
    const cv::Mat colorMask = ballColorMask(hsv, level);
    for (const SphereCone& candidate : findBallCandidates(colorMask, camera, options.minimumRadiusPx))
    {
      Fitted fitted;
      if (!findings.has(candidate) && refine(light, camera, candidate, fitted))
      {
        judge(hsv, colorMask, camera, options, fitted);
        findings.add(fitted);
      }
    }
  }
  std::sort(findings.balls.begin(), findings.balls.end(), [](const Fitted& a, const Fitted& b) { return a.score() > b.score(); });
  return findings;
}

BallDetection detectExact(const cv::Mat& image, const CameraModel& camera, double ballRadiusMm, const BallDetectionOptions& options)
{
  BallDetection result;
  const auto [balls, partlySeen] = findBalls(image, camera, options);
  if (balls.empty())
  {
    result.status = partlySeen > 0 ? Status::TooLittleVisible : Status::NotFound;
    result.visibleShare = partlySeen;
    result.message = partlySeen > 0 ? "too little of the ball's outline is visible" : "no ball is seen";
    return result;
  }
  const Fitted& best = balls.front();
  if (balls.size() > 1 && best.score() < options.distinctionFactor * balls[1].score())
  {
    result.status = Status::SeveralBalls;
    result.message = std::to_string(balls.size()) + " things look like the ball: take the others out of the view";
    return result;
  }
  // The scatter alone would say that n edge points average as n independent ones do.
  const double independent = std::max(1.0, best.visibleShare * 2 * Pi / CorrelationAngle);
  const double sharing = std::max(1.0, double(best.support_Image.size()) / independent);
  describe(best.fit.cone.axis_Camera, sharing * best.fit.axisCovariance, camera, result);
  result.status = Status::Found;
  result.message = "ball found";
  result.radiusPx = best.radiusPx;
  result.distanceMm = best.fit.cone.distance(ballRadiusMm);
  result.visibleShare = best.visibleShare;
  result.confidence = best.score();
  result.outline_Image = best.support_Image;
  return result;
}

BallDetection detectHough(const cv::Mat& image, const CameraModel& camera, double ballRadiusMm)
{
  BallDetection result;
  result.message = "no circle is seen";
  const std::optional<HoughCircle> circle = findHoughCircle(image);
  if (!circle)
  {
    return result;
  }
  const CameraModel::Unprojection ray = camera.unproject({ circle->center_Image.x, circle->center_Image.y });
  if (!ray.isUsable())
  {
    result.message = "the circle lies outside of what the lens model covers";
    return result;
  }
  // The transform gives no measure of its error; the centres of right circles were 2 px off in our renderings.
  describe(ray.ray_Camera, Eigen::Matrix3d::Zero(), camera, result);
  result.covariance_Image = HoughSigmaPx * HoughSigmaPx * Eigen::Matrix2d::Identity();
  result.status = Status::Found;
  result.message = "circle found";
  result.radiusPx = circle->radiusPx;
  result.distanceMm = ballRadiusMm / std::sin(std::atan(circle->radiusPx / ((camera.fx() + camera.fy()) / 2)));
  result.visibleShare = 1;
  result.confidence = 1;
  return result;
}

}  // namespace

void BallDetectionOptions::check() const
{
  color.check();
  const auto isShare = [](double value) { return value >= 0 && value <= 1; };
  if (!(minimumRadiusPx >= 3) || !isShare(minimumVisibleShare) || !isShare(minimumFill) || !(distinctionFactor >= 1))
  {
    throw std::invalid_argument("ball detection options: a radius of at least 3 px and shares between 0 and 1 are expected");
  }
}

BallDetection detectBall(const cv::Mat& image, const CameraModel& camera, double ballRadiusMm, const BallDetectionOptions& options)
{
  options.check();
  if (!(ballRadiusMm > 0) || !std::isfinite(ballRadiusMm))
  {
    throw std::invalid_argument("the ball's radius must be a positive number of mm");
  }
  if (camera.hasImageSize() && (image.cols != camera.width() || image.rows != camera.height()))
  {
    throw std::invalid_argument("the image is " + std::to_string(image.cols) + " x " + std::to_string(image.rows) +
      " px, the camera was calibrated for " + std::to_string(camera.width()) + " x " + std::to_string(camera.height()) + " px");
  }
  return options.method == BallDetectionOptions::Method::Exact ? detectExact(image, camera, ballRadiusMm, options)
                                                               : detectHough(image, camera, ballRadiusMm);
}

std::string toString(Status status)
{
  switch (status)
  {
    case Status::Found:
      return "ok";
    case Status::NotFound:
      return "not_found";
    case Status::SeveralBalls:
      return "several_balls";
    case Status::TooLittleVisible:
      return "too_little_visible";
  }
  return "unknown";
}

}  // namespace handeye
