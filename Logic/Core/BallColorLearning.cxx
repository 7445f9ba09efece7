// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BallColorLearning.h"

#include "NumberWords.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace handeye
{

namespace
{

/// The hue is looked for this far around the click (px).
constexpr int AroundPx = 12;
/// A colour is one when pixels have this chroma and saturation (0 to 1).
constexpr double LeastChroma = 0.12;
constexpr double LeastSaturation = 0.3;
/// Least share of what lies around the click that must have the hue.
constexpr double LeastShare = 0.1;
/// What is connected may differ from the hue by so much (deg).
constexpr double ConnectedHueDeg = 22;
/// Largest share of the image that a ball can cover.
constexpr double LargestShare = 0.6;
/// A click so far beside the outline (radii, px) is still one on the ball.
constexpr double BesideShare = 1.15, BesidePx = 2;
constexpr double SharpestHueDeg = 9;
constexpr double WidestHueDeg = 24;

double chromaOf(const cv::Vec3b& hsv)
{
  return hsv[1] / 255.0 * hsv[2] / 255.0;
}

/// The most frequent hue (deg) around a place, weighted by chroma; negative where there is no colour.
double mainHue(const cv::Mat& hsv, const cv::Point& pixel)
{
  const cv::Rect around =
    cv::Rect(pixel - cv::Point(AroundPx, AroundPx), cv::Size(2 * AroundPx + 1, 2 * AroundPx + 1)) & cv::Rect({ 0, 0 }, hsv.size());
  std::array<double, 256> histogram{};
  int colored = 0;
  for (int row = around.y; row < around.br().y; ++row)
  {
    for (int column = around.x; column < around.br().x; ++column)
    {
      const cv::Vec3b& value = hsv.at<cv::Vec3b>(row, column);
      // Near the click counts more: beside a small ball there is something else.
      const double apart = std::hypot(column - pixel.x, row - pixel.y) / AroundPx;
      if (chromaOf(value) >= LeastChroma && value[1] >= 255 * LeastSaturation)
      {
        histogram[value[0]] += chromaOf(value) * std::exp(-2 * apart * apart);
        ++colored;
      }
    }
  }
  if (colored < LeastShare * around.area())
  {
    return -1;
  }
  double best = 0, bestHue = -1;
  for (int hue = 0; hue < 256; ++hue)
  {
    double sum = 0;
    for (int near = -5; near <= 5; ++near)
    {
      sum += histogram[std::size_t((hue + near + 256) % 256)];
    }
    if (sum > best)
    {
      best = sum;
      bestHue = hue * 360.0 / 256;
    }
  }
  return bestHue;
}

/// Where the hue is connected to what lies around the place.
cv::Mat connected(const cv::Mat& hsv, const cv::Point& pixel, double hueDeg)
{
  BallColor wide;
  wide.hueDeg = hueDeg;
  wide.hueToleranceDeg = ConnectedHueDeg;
  wide.minimumSaturation = LeastSaturation;
  wide.minimumValue = LeastChroma;
  const cv::Mat mask = ballColorMask(hsv, wide);
  cv::Mat labels;
  const int count = cv::connectedComponents(mask, labels, 8, CV_32S);
  std::vector<int> votes(std::size_t(count), 0);
  const cv::Rect around =
    cv::Rect(pixel - cv::Point(AroundPx, AroundPx), cv::Size(2 * AroundPx + 1, 2 * AroundPx + 1)) & cv::Rect({ 0, 0 }, hsv.size());
  for (int row = around.y; row < around.br().y; ++row)
  {
    for (int column = around.x; column < around.br().x; ++column)
    {
      ++votes[std::size_t(labels.at<int>(row, column))];
    }
  }
  votes[0] = 0;  // the background
  return labels == int(std::max_element(votes.begin(), votes.end()) - votes.begin());
}

double quantile(std::vector<double>& values, double share)
{
  const auto place = values.begin() + std::ptrdiff_t(share * double(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

}  // namespace

BallColorLearningResult learnBallColor(const cv::Mat& image, const cv::Point& pixel, BallColor::ChannelOrder order)
{
  const cv::Mat hsv = toHsv(image, order);
  if (!cv::Rect({ 0, 0 }, image.size()).contains(pixel))
  {
    throw std::invalid_argument("the place (" + std::to_string(pixel.x) + ", " + std::to_string(pixel.y) +
      ") lies outside of the image of " + std::to_string(image.cols) + " x " + std::to_string(image.rows) + " px");
  }
  BallColorLearningResult result;
  const double hueDeg = mainHue(hsv, pixel);
  if (hueDeg < 0)
  {
    result.message = "what lies around (" + std::to_string(pixel.x) + ", " + std::to_string(pixel.y) +
      ") has no colour to speak of: click on the coloured ball";
    return result;
  }
  const cv::Mat region = connected(hsv, pixel, hueDeg);
  std::vector<double> hues, deviations, saturations, values;
  for (int row = 0; row < hsv.rows; ++row)
  {
    for (int column = 0; column < hsv.cols; ++column)
    {
      if (region.at<uchar>(row, column) != 0)
      {
        const cv::Vec3b& value = hsv.at<cv::Vec3b>(row, column);
        hues.push_back(std::remainder(value[0] * 360.0 / 256 - hueDeg, 360.0));
        saturations.push_back(value[1] / 255.0);
        values.push_back(value[2] / 255.0);
      }
    }
  }
  if (double(hues.size()) > LargestShare * double(hsv.total()))
  {
    result.status = BallColorLearningResult::Status::NoBall;
    result.message = "what has the colour of (" + std::to_string(pixel.x) + ", " + std::to_string(pixel.y) + ") covers " +
      fixedDigits(100 * double(hues.size()) / double(hsv.total()), 0) + " % of the image: click on the ball";
    return result;
  }
  const double middle = quantile(hues, 0.5);
  for (const double hue : hues)
  {
    deviations.push_back(std::abs(hue - middle));
  }
  result.color.channelOrder = order;
  result.color.hueDeg = std::fmod(hueDeg + middle + 360, 360.0);
  result.color.hueToleranceDeg = std::clamp(1.5 * quantile(deviations, 0.9) + 4, SharpestHueDeg, WidestHueDeg);
  result.color.minimumSaturation = std::clamp(0.8 * quantile(saturations, 0.05), 0.2, 0.5);
  result.color.minimumValue = std::clamp(0.7 * quantile(values, 0.05), 0.06, 0.3);
  result.color.minimumMedianSaturation = std::clamp(0.75 * quantile(saturations, 0.5), 0.3, 0.53);
  result.pixels = int(hues.size());
  result.status = BallColorLearningResult::Status::Ok;
  result.message = "learnt a hue of " + fixedDigits(result.color.hueDeg, 0) + " deg, give or take " +
    fixedDigits(result.color.hueToleranceDeg, 0) + " deg, from " + std::to_string(result.pixels) + " pixels";
  return result;
}

BallColorLearningResult learnBallColor(
  const cv::Mat& image, const cv::Point& pixel, const CameraModel& camera, double ballRadiusMm, const BallDetectionOptions& options)
{
  BallColorLearningResult result = learnBallColor(image, pixel, options.color.channelOrder);
  if (!result.isUsable())
  {
    return result;
  }
  BallDetectionOptions detection = options;
  detection.color = result.color;
  const BallDetection ball = detectBall(image, camera, ballRadiusMm, detection);
  const double apartPx = (ball.ball_Image - Eigen::Vector2d(pixel.x, pixel.y)).norm();
  if (!ball.isFound() || apartPx > BesideShare * ball.radiusPx + BesidePx)
  {
    result.status = BallColorLearningResult::Status::NotFoundThere;
    const std::string color = "the colour there (hue " + fixedDigits(result.color.hueDeg, 0) + " deg)";
    result.message = ball.isFound() ? "a ball with " + color + " is found elsewhere, " + fixedDigits(apartPx, 0) + " px away"
      : ball.status == BallDetection::Status::NotFound ? "nothing with " + color + " looks like a ball"
                                                       : "with " + color + " no ball is found, since " + ball.message;
  }
  return result;
}

}  // namespace handeye
