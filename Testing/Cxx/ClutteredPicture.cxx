// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ClutteredPicture.h"

#include "CameraFile.h"
#include "CaptureTruth.h"
#include "SphereCone.h"

#include <opencv2/imgcodecs.hpp>

#include <cmath>
#include <filesystem>
#include <random>
#include <stdexcept>
#include <string>

namespace handeye::test
{

namespace
{

const cv::Size PartSize(320, 240);
/// The rendered frames have no ball within this many times the apparent radius of the true centre.
constexpr double FarAway = 1.25;

struct RenderedFrame
{
  cv::Mat image;
  std::optional<handeye::testing::CaptureTruth::Ball> ball;
};

std::filesystem::path folderOf(const std::string& capture)
{
  return std::filesystem::path(HANDEYE_TEST_DATA_DIR) / "rendered" / capture;
}

std::vector<RenderedFrame> renderedFrames(const std::string& capture)
{
  const std::filesystem::path folder = folderOf(capture);
  const handeye::testing::CaptureTruth truth = handeye::testing::readTruth(folder);
  std::vector<RenderedFrame> frames;
  for (const char* part : { "calibration", "validation" })
  {
    const auto& balls = part[0] == 'c' ? truth.calibration : truth.validation;
    for (std::size_t i = 0; i < balls.size(); ++i)
    {
      const std::string number = std::to_string(i);
      const std::filesystem::path file = folder / part / "frames" / (std::string(4 - number.size(), '0') + number + ".jpg");
      frames.push_back({ cv::imread(file.string()), balls[i] });
      if (frames.back().image.empty())
      {
        throw std::runtime_error("the rendered frame " + file.string() + " cannot be read");
      }
    }
  }
  return frames;
}

/// The quarters of the webcams' frames that the ball is not in. Both lenses have a focal length below 620 px, and balls of at most
/// 30 mm: their apparent radius is less than this.
std::vector<cv::Mat> partsWithoutBall()
{
  constexpr double LargestFocalPx = 620, LargestBallMm = 30;
  std::vector<cv::Mat> parts;
  for (const char* capture : { "dev_webcam", "table_webcam" })
  {
    for (const RenderedFrame& frame : renderedFrames(capture))
    {
      for (const cv::Point& corner : { cv::Point(0, 0), cv::Point(320, 0), cv::Point(0, 240), cv::Point(320, 240) })
      {
        const cv::Rect part(corner, PartSize);
        if (frame.ball)
        {
          const Eigen::Vector2d& center = frame.ball->ball_Image;
          const double x = std::clamp(center.x(), double(part.x), double(part.br().x));
          const double y = std::clamp(center.y(), double(part.y), double(part.br().y));
          const double reach = FarAway * LargestFocalPx * LargestBallMm / frame.ball->ball_Camera.z();
          if (std::hypot(x - center.x(), y - center.y()) < reach)
          {
            continue;
          }
        }
        parts.push_back(frame.image(part));
      }
    }
  }
  return parts;
}

}  // namespace

std::vector<PictureWithoutBall> picturesWithoutBall()
{
  std::vector<PictureWithoutBall> pictures;
  for (const char* capture : { "table_webcam", "tissue_laparoscope" })
  {
    const CameraModel camera = io::readCameraFile(folderOf(capture) / "camera.yml").camera;
    for (const RenderedFrame& frame : renderedFrames(capture))
    {
      if (!frame.ball)
      {
        pictures.push_back({ frame.image, camera });
      }
    }
  }
  return pictures;
}

cv::Mat clutter(const cv::Size& size, unsigned seed)
{
  static const std::vector<cv::Mat> parts = partsWithoutBall();
  std::mt19937 random(seed);
  cv::Mat picture(size, CV_8UC3);
  for (int y = 0; y < size.height; y += PartSize.height)
  {
    for (int x = 0; x < size.width; x += PartSize.width)
    {
      const cv::Rect place = cv::Rect({ x, y }, PartSize) & cv::Rect({ 0, 0 }, size);
      const cv::Mat& part = parts[random() % parts.size()];
      part(cv::Rect({ 0, 0 }, place.size())).copyTo(picture(place));
    }
  }
  return picture;
}

cv::Mat toLight(const cv::Mat& encoded)
{
  cv::Mat table(1, 256, CV_32F), light;
  for (int value = 0; value < 256; ++value)
  {
    const double share = value / 255.0;
    table.at<float>(value) = float(share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4));
  }
  cv::LUT(encoded, table, light);
  return light;
}

cv::Rect areaOfBall(const CameraModel& camera, const RenderedBall& ball, double blurPx, const Eigen::Vector2d& motionPx)
{
  const double distance = ball.center_Camera.norm();
  const SphereCone cone{ ball.center_Camera / distance, std::asin(ball.radiusMm / distance) };
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& point : cone.outline(camera, 90).points_Image)
  {
    box.extend(point);
  }
  const int margin = int(std::ceil(4 * blurPx + motionPx.norm() / 2)) + 5;
  const cv::Point first(int(std::floor(box.min().x())), int(std::floor(box.min().y())));
  const cv::Point last(int(std::ceil(box.max().x())), int(std::ceil(box.max().y())));
  const cv::Rect area(first - cv::Point(margin, margin), last + cv::Point(margin + 1, margin + 1));
  return area & cv::Rect(0, 0, camera.width(), camera.height());
}

void drawBall(cv::Mat& light, const cv::Rect& area, const CameraModel& camera, const RenderedBall& ball, double blurPx,
  const Eigen::Vector2d& motionPx)
{
  Eigen::Matrix3d cameraMatrix = camera.cameraMatrix();
  cameraMatrix(0, 2) -= area.x;
  cameraMatrix(1, 2) -= area.y;
  const CameraModel part(area.width, area.height, cameraMatrix, camera.distortionCoefficients());
  // The ball before black is its own light; before white, what shines through along its outline as well.
  cv::Mat own = smear(SphereScene(part, Light(0, 0, 0)).add(ball).light(), motionPx);
  cv::Mat both = smear(SphereScene(part, Light(1, 1, 1)).add(ball).light(), motionPx);
  if (blurPx > 0)
  {
    cv::GaussianBlur(own, own, {}, blurPx, blurPx, cv::BORDER_REPLICATE);
    cv::GaussianBlur(both, both, {}, blurPx, blurPx, cv::BORDER_REPLICATE);
  }
  light = own + light.mul(both - own);
}

void paint(cv::Mat& light, const cv::Mat& mask, const Light& color, double blurPx)
{
  cv::Mat cover, covers;
  mask.convertTo(cover, CV_32F, 1.0 / 255);
  if (blurPx > 0)
  {
    cv::GaussianBlur(cover, cover, {}, blurPx, blurPx, cv::BORDER_REPLICATE);
  }
  cv::cvtColor(cover, covers, cv::COLOR_GRAY2BGR);
  const cv::Mat paper(light.size(), CV_32FC3, cv::Scalar(color[0], color[1], color[2]));
  light = light + covers.mul(paper - light);
}

cv::Mat smear(const cv::Mat& light, const Eigen::Vector2d& motionPx)
{
  const double length = motionPx.norm();
  if (!(length > 0))
  {
    return light.clone();
  }
  // Many places along the way, each shared among the four pixels around it.
  const int half = int(std::ceil(length / 2)) + 1, count = 8 * int(std::ceil(length)) + 1;
  cv::Mat1d kernel = cv::Mat1d::zeros(2 * half + 1, 2 * half + 1);
  for (int i = 0; i < count; ++i)
  {
    const Eigen::Vector2d at = ((i + 0.5) / count - 0.5) * motionPx + Eigen::Vector2d(half, half);
    const int column = int(at.x()), row = int(at.y());
    const double right = at.x() - column, below = at.y() - row;
    kernel(row, column) += (1 - right) * (1 - below) / count;
    kernel(row, column + 1) += right * (1 - below) / count;
    kernel(row + 1, column) += (1 - right) * below / count;
    kernel(row + 1, column + 1) += right * below / count;
  }
  cv::Mat smeared;
  cv::filter2D(light, smeared, -1, kernel, { -1, -1 }, 0, cv::BORDER_REPLICATE);
  return smeared;
}

cv::Mat throughJpeg(const cv::Mat& image, int quality)
{
  std::vector<uchar> bytes;
  cv::imencode(".jpg", image, bytes, { cv::IMWRITE_JPEG_QUALITY, quality });
  return cv::imdecode(bytes, cv::IMREAD_COLOR);
}

}  // namespace handeye::test
