// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BallEvidence.h"

#include "Statistics.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

namespace handeye
{

namespace
{

constexpr double Pi = double(EIGEN_PI);

/// A scatter of this much halves the trust in an outline.
constexpr double HalfTrustSigmaPx = 0.4;
constexpr int OutlineCorners = 90;
/// Largest share of the outline, of what is seen of it, across which the ball's colour goes on without an edge: a piece of
/// something longer is not a ball.
constexpr double LargestContinuedShare = 0.3;
/// The colour is looked at this far inside and outside of the outline: a share of the radius, within limits in px.
constexpr double AcrossShare = 0.25;
constexpr double NearestAcrossPx = 2;
constexpr double FurthestAcrossPx = 4;
/// Least share of what the seen outline encloses that has the colour itself, highlights not counted.
constexpr double LeastColor = 0.35;
/// Something in front of the ball, a finger, may cover this much of what the seen outline encloses where the rim is well filled.
constexpr double LeastBehindFinger = 0.45;
constexpr double RimBesideFinger = 0.5;
constexpr double SigmaBesideFingerPx = 0.25;
constexpr double VisibleBesideFinger = 0.6;
constexpr double RadiusBesideFingerPx = 12;
/// Pixels on the edges are mixtures, and of a small ball they are many: where its outline is sharp, what it encloses is looked at without
/// them. Of outlines that scatter more something else may be the cause.
constexpr double SmallRadiusPx = 12;
constexpr double SigmaOfSmallPx = 0.15;
/// What hides a part has its edge between the ends of what is seen, or a little beyond: there are more mixtures there.
constexpr double Whole = 0.9;
constexpr int RimOfHiddenPx = 2;
constexpr int FewestPixels = 12;
/// Along a line from the centre to a seen point of the outline the colour is looked at in these places, as shares of the way.
constexpr double AlongRadius[] = { 0.5, 0.6, 0.7, 0.8, 0.9 };
/// Of larger balls not every pixel is looked at, but about this many.
constexpr double PixelsLookedAt = 3000;

cv::Point nearestPixel(const Eigen::Vector2d& point)
{
  return { int(std::lround(point.x())), int(std::lround(point.y())) };
}

/// What the seen part of the outline encloses: the whole disc, or what something in front of it has left.
struct Inside
{
  double colored = 0;           ///< share with the ball's colour
  double highlights = 0;        ///< share of pale, bright pixels
  double medianSaturation = 0;  ///< of the coloured ones, 0 to 1
};

double saturation(const cv::Mat& image, const cv::Point& pixel)
{
  const auto of = [](const auto* channels)
  {
    const auto [smallest, largest] = std::minmax({ channels[0], channels[1], channels[2] });
    return largest > 0 ? double(largest - smallest) / largest : 0;
  };
  return image.depth() == CV_16U ? of(image.ptr<ushort>(pixel.y) + pixel.x * image.channels())
                                 : of(image.ptr<uchar>(pixel.y) + pixel.x * image.channels());
}

/// Takes the outermost pixels away, again and again, as long as enough is left.
void peel(cv::Mat& disc, int times)
{
  for (int i = 0; i < times; ++i)
  {
    cv::Mat peeled;
    cv::erode(disc, peeled, {}, { -1, -1 }, 1, cv::BORDER_CONSTANT, cv::Scalar::all(0));
    if (i > 0 && cv::countNonZero(peeled) < FewestPixels)
    {
      return;
    }
    disc = peeled;
  }
}

/// @param rimPx so many pixels along the edges do not count
Inside lookInside(const cv::Mat& image, const BallColorLevels& levels, int level, const std::vector<cv::Point>& polygon, int rimPx)
{
  const cv::Rect area = cv::boundingRect(polygon) & levels.window();
  Inside inside;
  if (area.empty())
  {
    return inside;
  }
  cv::Mat disc = cv::Mat::zeros(area.size(), CV_8U);
  cv::fillPoly(disc, std::vector<std::vector<cv::Point>>{ polygon }, 255, cv::LINE_8, 0, -area.tl());
  const int step = std::max(1, int(std::sqrt(double(area.area()) / PixelsLookedAt)));
  if (step == 1)
  {
    peel(disc, rimPx);
  }
  double total = 0, highlights = 0;
  std::vector<double> saturations;
  for (int row = 0; row < area.height; row += step)
  {
    for (int column = 0; column < area.width; column += step)
    {
      const cv::Point pixel = area.tl() + cv::Point(column, row);
      if (disc.at<uchar>(row, column) == 0)
      {
        continue;
      }
      ++total;
      if (levels.meets(level, pixel))
      {
        saturations.push_back(saturation(image, pixel));
      }
      else if (levels.isHighlight(pixel))
      {
        ++highlights;
      }
    }
  }
  if (saturations.empty())
  {
    return inside;
  }
  inside.colored = double(saturations.size()) / total;
  inside.highlights = highlights / total;
  inside.medianSaturation = median(std::move(saturations));
  return inside;
}

/// The share of the seen outline behind which the ball's rim has its colour, or a highlight, half the way to the centre. What something
/// in front of the ball hides does not count.
double rimFill(const OutlineFit& fit, const BallColorLevels& levels, int level, const Eigen::Vector2d& center_Image)
{
  int filled = 0;
  for (const Eigen::Vector2d& edge : fit.support_Image)
  {
    int colored = 0;
    for (const double share : AlongRadius)
    {
      const cv::Point pixel = nearestPixel(center_Image + share * (edge - center_Image));
      colored += levels.meets(level, pixel) || levels.isHighlight(pixel) ? 1 : 0;
    }
    filled += colored + 1 >= int(std::size(AlongRadius)) ? 1 : 0;
  }
  return double(filled) / double(fit.support_Image.size());
}

/// The share of the outline across which the colour goes on and no edge was found.
double continuedShare(const BallColorLevels& levels, int level, const SphereCone::Outline& outline, const OutlineFit& fit,
  const Eigen::Vector2d& center_Image, double radiusPx)
{
  // Corners by their angle about the centre in the image.
  const auto cornerAt = [&](const Eigen::Vector2d& point)
  {
    const Eigen::Vector2d arm = point - center_Image;
    return (std::atan2(arm.y(), arm.x()) / (2 * Pi) + 0.5) * OutlineCorners;
  };
  const double across = std::clamp(AcrossShare * radiusPx, NearestAcrossPx, FurthestAcrossPx);
  std::vector<char> isSeen(OutlineCorners + 1);
  for (const Eigen::Vector2d& edge : fit.support_Image)
  {
    const double corner = std::min(cornerAt(edge), double(OutlineCorners - 1));
    isSeen[std::size_t(corner)] = 1;
    isSeen[std::size_t(corner) + 1] = 1;
  }
  isSeen[0] = isSeen[OutlineCorners] = isSeen[0] | isSeen[OutlineCorners];
  int continued = 0;
  for (std::size_t i = 0; i < outline.points_Image.size(); ++i)
  {
    const Eigen::Vector2d& point = outline.points_Image[i];
    const Eigen::Vector2d step = across * outline.normals_Image[i];
    const auto corner = std::size_t(std::lround(cornerAt(point)));
    const bool goesOn = levels.meets(level, nearestPixel(point - step)) && levels.meets(level, nearestPixel(point + step));
    continued += goesOn && !isSeen[corner] ? 1 : 0;
  }
  return double(continued) / double(outline.points_Image.size());
}

}  // namespace

BallEvidence judgeOutline(const OutlineFit& fit, const cv::Mat& image, const BallColorLevels& levels, int level,
  const CameraModel& camera, const BallDetectionOptions& options, double largestSigmaPx)
{
  BallEvidence evidence;
  const SphereCone::Outline outline = fit.cone.outline(camera, OutlineCorners);
  if (outline.points_Image.size() < OutlineCorners / 2 || fit.support_Image.size() < 3)
  {
    return evidence;
  }
  std::vector<cv::Point2f> whole;
  std::vector<cv::Point> seen;
  for (const Eigen::Vector2d& point : outline.points_Image)
  {
    whole.emplace_back(float(point.x()), float(point.y()));
  }
  for (const Eigen::Vector2d& point : fit.support_Image)
  {
    seen.push_back(nearestPixel(point));
  }
  evidence.radiusPx = std::sqrt(cv::contourArea(whole) / Pi);
  const Eigen::Vector2d center_Image = camera.project(fit.cone.axis_Camera).point_Image;
  const bool isSmallAndSharp = evidence.radiusPx < SmallRadiusPx && fit.sigmaPx <= SigmaOfSmallPx;
  const int rimPx = !isSmallAndSharp ? 0 : fit.visibleShare < Whole ? RimOfHiddenPx : 1;
  const Inside inside = lookInside(image, levels, level, seen, rimPx);
  const double filled = std::min(1.0, inside.colored + inside.highlights);
  const double rim = rimFill(fit, levels, level, center_Image);
  const bool isBesideFinger = rim >= RimBesideFinger && filled >= LeastBehindFinger && fit.sigmaPx <= SigmaBesideFingerPx &&
    fit.visibleShare >= VisibleBesideFinger && evidence.radiusPx >= RadiusBesideFingerPx;
  evidence.fill = isBesideFinger ? std::max(filled, options.minimumFill) : filled;
  evidence.continuedShare = continuedShare(levels, level, outline, fit, center_Image, evidence.radiusPx);
  const bool isWhole = evidence.continuedShare <= LargestContinuedShare * (fit.visibleShare + evidence.continuedShare);
  evidence.isPartOfBall = isWhole && fit.sigmaPx <= largestSigmaPx && evidence.radiusPx >= options.minimumRadiusPx &&
    evidence.fill >= options.minimumFill && inside.colored >= LeastColor &&
    inside.medianSaturation >= options.color.minimumMedianSaturation;
  evidence.isBall = evidence.isPartOfBall && fit.visibleShare >= options.minimumVisibleShare;
  const double scatter = fit.sigmaPx / HalfTrustSigmaPx;
  evidence.score = fit.visibleShare * evidence.fill / (1 + scatter * scatter);
  return evidence;
}

}  // namespace handeye
