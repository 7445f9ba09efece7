// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "MarkedPicture.h"

#include "EightBitImage.h"
#include "NumberWords.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

namespace handeye::report
{

namespace
{

const cv::Scalar SegmentedColor(80, 220, 80);
const cv::Scalar ProjectedColor(0, 220, 255);
constexpr int SubPixelBits = 4;
constexpr int PanelPx = 480;  ///< height of the picture, and side of the enlargement

cv::Point toFixedPoint(const Eigen::Vector2d& point)
{
  return { int(std::lround(point.x() * (1 << SubPixelBits))), int(std::lround(point.y() * (1 << SubPixelBits))) };
}

void drawCross(cv::Mat& picture, const Eigen::Vector2d& at, double arm, const cv::Scalar& color, int thickness = 1)
{
  for (const Eigen::Vector2d& direction : { Eigen::Vector2d(arm, 0), Eigen::Vector2d(0, arm) })
  {
    cv::line(picture, toFixedPoint(at - direction), toFixedPoint(at + direction), color, thickness, cv::LINE_AA, SubPixelBits);
  }
}

cv::Mat toBgr8(const cv::Mat& image)
{
  const cv::Mat eight = toEightBit(image);
  cv::Mat picture;
  if (eight.channels() == 3)
  {
    return eight.clone();  // to be drawn into
  }
  cv::cvtColor(eight, picture, eight.channels() == 1 ? cv::COLOR_GRAY2BGR : cv::COLOR_BGRA2BGR);
  return picture;
}

void drawOutline(cv::Mat& picture, const BallDetection& ball, double scale, double radiusPx)
{
  for (const Eigen::Vector2d& edge : ball.outline_Image)
  {
    // Pixel centres are whole numbers: scaling keeps the picture's corner (-0.5) where it is.
    const Eigen::Vector2d place = scale * (edge + Eigen::Vector2d(0.5, 0.5)) - Eigen::Vector2d(0.5, 0.5);
    cv::circle(
      picture, toFixedPoint(place), int(radiusPx * (1 << SubPixelBits)), SegmentedColor, cv::FILLED, cv::LINE_AA, SubPixelBits);
  }
}

/// Half the side (px of the image) of what is enlarged: the predictions that are not far out fit in.
double halfSide(const Eigen::Vector2d& center, const std::vector<PredictedCenter>& predicted)
{
  std::vector<double> distances;
  for (const PredictedCenter& one : predicted)
  {
    distances.push_back((one.place_Image - center).norm());
  }
  std::sort(distances.begin(), distances.end());
  double reach = 0;
  for (const double distance : distances)
  {
    reach = distance < std::max(12.0, 4 * reach) && distance < 60 ? distance : reach;
  }
  if (reach == 0 && !distances.empty())
  {
    reach = std::min(distances.front(), 60.0);
  }
  return std::max(3.0, 1.35 * reach);
}

/// The surroundings of a place, enlarged; knows where its pixels are.
class Enlargement
{
public:
  Enlargement(const cv::Mat& picture, const Eigen::Vector2d& center, double half)
    : center_(center)
    , scale_(PanelPx / (2 * half))
  {
    // p_Panel = scale (p_Image - center) + middle; beyond the image it is black.
    const double middle = (PanelPx - 1) / 2.0;
    const cv::Matx23d imageToPanel(scale_, 0, middle - scale_ * center.x(), 0, scale_, middle - scale_ * center.y());
    cv::warpAffine(picture, panel_, imageToPanel, cv::Size(PanelPx, PanelPx), cv::INTER_NEAREST);
  }
  Eigen::Vector2d toPanel(const Eigen::Vector2d& place_Image) const
  {
    return scale_ * (place_Image - center_) + Eigen::Vector2d::Constant((PanelPx - 1) / 2.0);
  }
  void draw(const PredictedCenter& predicted)
  {
    const cv::Scalar color(predicted.color[2], predicted.color[1], predicted.color[0]);
    const Eigen::Vector2d from = toPanel(center_), to = toPanel(predicted.place_Image), way = to - from;
    const double room = PanelPx / 2.0 - 6, reach = way.cwiseAbs().maxCoeff();
    const Eigen::Vector2d end = reach > room ? Eigen::Vector2d(from + way * (room / reach)) : to;
    const double length = (end - from).norm();
    cv::arrowedLine(panel_, cv::Point(int(std::lround(from.x())), int(std::lround(from.y()))),
      cv::Point(int(std::lround(end.x())), int(std::lround(end.y()))), color, 2, cv::LINE_AA, 0,
      length > 1 ? std::min(0.4, 12 / length) : 0);
    if (reach <= room)
    {
      drawCross(panel_, to, 9, color, 2);
    }
  }
  /// The segmented centre, and how long a pixel is.
  cv::Mat finish(bool hasCenter)
  {
    if (hasCenter)
    {
      drawCross(panel_, toPanel(center_), 16, SegmentedColor, 2);
    }
    const double lengthPx = scale_ > 30 ? 1 : scale_ > 6 ? 5 : 10;
    const int end = PanelPx - 15, start = end - int(std::lround(lengthPx * scale_));
    cv::line(panel_, { start, PanelPx - 15 }, { end, PanelPx - 15 }, cv::Scalar(0, 0, 0), 6, cv::LINE_AA);
    cv::line(panel_, { start, PanelPx - 15 }, { end, PanelPx - 15 }, cv::Scalar(255, 255, 255), 3, cv::LINE_AA);
    write(fixedDigits(lengthPx, 0) + " px", { start, PanelPx - 28 }, { 0, 0, 0 });
    return panel_;
  }
  /// On a light ground, so that dark colours can be read on dark pictures.
  void write(const std::string& text, const cv::Point& at, const cv::Scalar& color)
  {
    int below = 0;
    const cv::Size size = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, 0.55, 1, &below);
    cv::rectangle(
      panel_, { at.x - 3, at.y - size.height - 3 }, { at.x + size.width + 3, at.y + below }, { 245, 245, 245 }, cv::FILLED);
    cv::putText(panel_, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.55, color, 1, cv::LINE_AA);
  }

private:
  Eigen::Vector2d center_;
  double scale_ = 1;
  cv::Mat panel_;
};

}  // namespace

cv::Mat drawFrame(const cv::Mat& image, const BallDetection& ball, const Eigen::Vector2d* predicted)
{
  cv::Mat picture = toBgr8(image);
  if (ball.isFound())
  {
    drawOutline(picture, ball, 1, 0.5);
    drawCross(picture, ball.ball_Image, 9, SegmentedColor);
  }
  if (predicted != nullptr)
  {
    drawCross(picture, *predicted, 9, ProjectedColor);
  }
  return picture;
}

cv::Mat drawMarkedPicture(const cv::Mat& image, const BallDetection& ball, const std::vector<PredictedCenter>& predicted)
{
  const cv::Mat picture = toBgr8(image);
  const double scale = double(PanelPx) / picture.rows;
  cv::Mat whole;
  cv::resize(
    picture, whole, cv::Size(int(std::lround(scale * picture.cols)), PanelPx), 0, 0, scale < 1 ? cv::INTER_AREA : cv::INTER_LINEAR);
  const bool hasCenter = ball.isFound();
  if (!hasCenter && predicted.empty())
  {
    return whole;
  }
  const Eigen::Vector2d center = hasCenter ? ball.ball_Image : predicted.front().place_Image;
  const double half = halfSide(center, predicted);
  if (hasCenter)
  {
    drawOutline(whole, ball, scale, 1);
  }
  // The framed part is the enlarged one.
  const auto toWhole = [&](double x, double y)
  { return cv::Point(int(std::lround(scale * (x + 0.5) - 0.5)), int(std::lround(scale * (y + 0.5) - 0.5))); };
  const double shown = std::max(half, 8 / scale);
  cv::rectangle(whole, toWhole(center.x() - shown, center.y() - shown), toWhole(center.x() + shown, center.y() + shown),
    cv::Scalar(255, 255, 255), 1, cv::LINE_AA);
  Enlargement enlargement(picture, center, half);
  int line = 20;
  for (const PredictedCenter& one : predicted)
  {
    enlargement.draw(one);
    if (!one.label.empty())
    {
      enlargement.write(one.label, { 8, line }, cv::Scalar(one.color[2], one.color[1], one.color[0]));
      line += 22;
    }
  }
  cv::Mat both;
  cv::hconcat(
    std::vector<cv::Mat>{ whole, cv::Mat(PanelPx, 6, CV_8UC3, cv::Scalar(255, 255, 255)), enlargement.finish(hasCenter) }, both);
  return both;
}

}  // namespace handeye::report
