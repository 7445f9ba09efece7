// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ValidationReport.h"

#include "AtomicFile.h"
#include "FileError.h"
#include "ImageFile.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace handeye
{

namespace
{

const cv::Scalar SegmentedColor(80, 220, 80);
const cv::Scalar ProjectedColor(0, 220, 255);
constexpr int SubPixelBits = 4;

std::string format(const char* pattern, double value)
{
  char text[64];
  std::snprintf(text, sizeof(text), pattern, value);
  return text;
}

std::string frameName(int frame)
{
  char text[32];
  std::snprintf(text, sizeof(text), "%04d.png", frame);
  return text;
}

cv::Point toFixedPoint(const Eigen::Vector2d& point)
{
  return { int(std::lround(point.x() * (1 << SubPixelBits))), int(std::lround(point.y() * (1 << SubPixelBits))) };
}

void drawCross(cv::Mat& picture, const Eigen::Vector2d& at, const cv::Scalar& color)
{
  constexpr double arm = 9;
  for (const Eigen::Vector2d& direction : { Eigen::Vector2d(arm, 0), Eigen::Vector2d(0, arm) })
  {
    cv::line(picture, toFixedPoint(at - direction), toFixedPoint(at + direction), color, 1, cv::LINE_AA, SubPixelBits);
  }
}

cv::Mat drawFrame(const cv::Mat& image, const ValidatedFrame& frame)
{
  cv::Mat picture;
  image.convertTo(picture, CV_8U, image.depth() == CV_16U ? 1.0 / 257 : 1.0);
  if (picture.channels() == 1)
  {
    cv::cvtColor(picture, picture, cv::COLOR_GRAY2BGR);
  }
  if (frame.captured.ball.isFound())
  {
    for (const Eigen::Vector2d& edge : frame.captured.ball.outline_Image)
    {
      cv::circle(picture, toFixedPoint(edge), 1 << (SubPixelBits - 1), SegmentedColor, cv::FILLED, cv::LINE_AA, SubPixelBits);
    }
    drawCross(picture, frame.captured.ball.ball_Image, SegmentedColor);
  }
  if (frame.validated && frame.validated->status == CameraModel::Status::Ok)
  {
    drawCross(picture, frame.validated->projected_Image, ProjectedColor);
  }
  return picture;
}

/// Error against distance as a small vector drawing.
std::string plot(const ValidationStepResult& result)
{
  constexpr double width = 640, height = 300, margin = 50;
  double nearest = 1e9, furthest = 0;
  for (const ValidatedFrame& frame : result.frames)
  {
    if (frame.status == "ok")
    {
      nearest = std::min(nearest, frame.validated->distanceMm);
      furthest = std::max(furthest, frame.validated->distanceMm);
    }
  }
  const double highest = std::max(0.5, result.projectionErrorPx.maximum * 1.1);
  furthest = std::max(furthest, nearest + 1);
  const auto x = [&](double mm) { return format("%.1f", margin + (width - 2 * margin) * (mm - nearest) / (furthest - nearest)); };
  const auto y = [&](double px) { return format("%.1f", height - margin - (height - 2 * margin) * px / highest); };
  const auto text = [](const std::string& at, const std::string& words) { return "<text " + at + ">" + words + "</text>\n"; };
  std::string svg = "<svg viewBox='0 0 640 300' width='640' height='300' font-family='sans-serif' font-size='12'>\n";
  svg += "<path d='M50 50V250H590' fill='none' stroke='#555'/>\n";
  for (int tick = 0; tick <= 4; ++tick)
  {
    const double px = highest * tick / 4, mm = nearest + (furthest - nearest) * tick / 4;
    svg += text("x='44' y='" + y(px) + "' text-anchor='end'", format("%.2f", px));
    svg += text("x='" + x(mm) + "' y='266' text-anchor='middle'", format("%.0f", mm));
  }
  svg += text("x='50' y='36'", "projection error (px)");
  svg += text("x='320' y='288' text-anchor='middle'", "distance of the ball from the camera (mm)");
  for (const ValidatedFrame& frame : result.frames)
  {
    if (frame.status == "ok")
    {
      svg += "<circle cx='" + x(frame.validated->distanceMm) + "' cy='" + y(frame.validated->errorPx) +
        "' r='4' fill='#1769aa'><title>frame " + std::to_string(frame.captured.frame) + "</title></circle>\n";
    }
  }
  return svg + "</svg>\n";
}

std::string page(const ValidationStepResult& result)
{
  std::string html =
    "<!DOCTYPE html>\n<html lang='en'><head><meta charset='utf-8'><title>Validation of a hand-eye calibration</title>\n"
    "<style>body{font-family:sans-serif;max-width:60em;margin:2em auto}td,th{padding:.2em .8em;text-align:right}"
    "img{width:100%}figure{margin:1em 0}</style></head><body>\n<h1>Validation of a hand-eye calibration</h1>\n<p><b>" +
    result.message + "</b></p>\n";
  html += result.isUsable() ? plot(result) : std::string();
  html += "<table><tr><th>frame</th><th>status</th><th>error (px)</th><th>distance (mm)</th></tr>\n";
  for (const ValidatedFrame& frame : result.frames)
  {
    const bool ok = frame.status == "ok";
    html += "<tr><td>" + std::to_string(frame.captured.frame) + "</td><td>" + frame.status + "</td><td>" +
      (ok ? format("%.2f", frame.validated->errorPx) : "") + "</td><td>" + (ok ? format("%.0f", frame.validated->distanceMm) : "") +
      "</td></tr>\n";
  }
  html += "</table>\n<p>Green: the segmented ball, its edge points and its centre. Yellow: where the calibration puts the tracked "
          "ball.</p>\n";
  for (const ValidatedFrame& frame : result.frames)
  {
    if (frame.status != "image_missing")
    {
      const std::string name = frameName(frame.captured.frame);
      const std::string caption = "frame " + std::to_string(frame.captured.frame) + ": " +
        (frame.status == "ok" ? format("%.2f px", frame.validated->errorPx) : frame.status);
      html += "<figure><img src='" + name + "' alt='" + caption + "'><figcaption>" + caption + "</figcaption></figure>\n";
    }
  }
  return html + "</body></html>\n";
}

}  // namespace

void writeValidationReport(const std::filesystem::path& folder, const ValidationStepResult& result, const io::Recording& recording)
{
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
  {
    throw io::FileError(folder, "the folder cannot be made: " + error.message());
  }
  for (const ValidatedFrame& frame : result.frames)
  {
    if (recording.hasImage(frame.captured.frame))
    {
      io::writePng(folder / frameName(frame.captured.frame), drawFrame(recording.image(frame.captured.frame), frame));
    }
  }
  io::writeFileAtomically(folder / "report.html", page(result));
}

}  // namespace handeye
