// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CoveragePicture.h"

#include "AtomicFile.h"
#include "FileError.h"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <cmath>

namespace handeye
{

namespace
{

constexpr double PictureWidth = 960;
constexpr double ResidualFactor = 50;
constexpr int FooterHeight = 64;

const cv::Scalar Ink(60, 60, 60), Point(150, 90, 30), Outlier(40, 40, 210), White(255, 255, 255);

/// White for none, then greener up to 40 points and more.
cv::Scalar cellColor(int points)
{
  const double share = std::min(1.0, points / 40.0);
  return points == 0 ? White : cv::Scalar(215 - 120 * share, 240 - 40 * share, 205 - 125 * share);
}

void drawCells(cv::Mat& picture, const Eigen::MatrixXi& coverage, int height)
{
  for (int row = 0; row < coverage.rows(); ++row)
  {
    for (int column = 0; column < coverage.cols(); ++column)
    {
      const int left = int(picture.cols * column / coverage.cols()), right = int(picture.cols * (column + 1) / coverage.cols());
      const int top = int(height * row / coverage.rows()), bottom = int(height * (row + 1) / coverage.rows());
      const cv::Rect cell({ left, top }, cv::Point(right, bottom));
      cv::rectangle(picture, cell, cellColor(coverage(row, column)), cv::FILLED);
      cv::rectangle(picture, cell, cv::Scalar(225, 225, 225));
      cv::putText(picture, std::to_string(coverage(row, column)), { left + 5, top + 16 }, cv::FONT_HERSHEY_SIMPLEX, 0.4,
        cv::Scalar(150, 150, 150), 1, cv::LINE_AA);
    }
  }
}

void drawPoints(cv::Mat& picture, const LensCalibrationResult& result, const std::vector<LensView>& views, double scale)
{
  for (std::size_t i = 0; i < views.size(); ++i)
  {
    const bool isOutlier = i < result.views.size() && !result.views[i].used;
    const bool hasResiduals = i < result.views.size() && result.views[i].residuals_Image.size() == views[i].ids.size();
    for (std::size_t k = 0; k < views[i].ids.size(); ++k)
    {
      const Eigen::Vector2d place = scale * (views[i].points_Image[k] + Eigen::Vector2d::Constant(0.5));
      const cv::Point2d from(place.x(), place.y());
      cv::circle(picture, from, 2, isOutlier ? Outlier : Point, cv::FILLED, cv::LINE_AA);
      if (hasResiduals)
      {
        const Eigen::Vector2d end = place - scale * ResidualFactor * result.views[i].residuals_Image[k];
        cv::line(picture, from, cv::Point2d(end.x(), end.y()), Point, 1, cv::LINE_AA);
      }
    }
  }
}

}  // namespace

cv::Mat drawCoverage(const LensViewCollector& collector, const LensCalibrationResult& result, const std::vector<LensView>& views,
  int width, int height)
{
  const double scale = PictureWidth / width;
  const int imageHeight = int(std::lround(scale * height));
  cv::Mat picture(imageHeight + FooterHeight, int(PictureWidth), CV_8UC3, White);
  drawCells(picture, collector.coverage(), imageHeight);
  drawPoints(picture, result, views, scale);
  cv::line(picture, { 0, imageHeight }, { picture.cols, imageHeight }, Ink);
  const LensViewCollector::Tilts tilts = collector.tilts();
  char text[2][200];
  std::snprintf(text[0], sizeof(text[0]),
    "%zu views, %.0f %% of the image covered; nearer side: left %d, right %d, top %d, bottom %d; square %d", views.size(),
    100 * collector.coverageShare(), tilts.left, tilts.right, tilts.top, tilts.bottom, tilts.square);
  std::snprintf(text[1], sizeof(text[1]), "%.3f px RMS over %d views; lines: residuals x %.0f; red: left out", result.rmsPx,
    result.usedCount, ResidualFactor);
  for (int i = 0; i < 2; ++i)
  {
    cv::putText(picture, text[i], { 10, imageHeight + 25 + 25 * i }, cv::FONT_HERSHEY_SIMPLEX, 0.5, Ink, 1, cv::LINE_AA);
  }
  return picture;
}

void writeCoveragePicture(const std::filesystem::path& path, const LensViewCollector& collector,
  const LensCalibrationResult& result, const std::vector<LensView>& views, int width, int height)
{
  std::vector<uchar> png;
  cv::imencode(".png", drawCoverage(collector, result, views, width, height), png);
  io::writeFileAtomically(path, std::string_view(reinterpret_cast<const char*>(png.data()), png.size()));
}

}  // namespace handeye
