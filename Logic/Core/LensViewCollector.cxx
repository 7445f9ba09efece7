// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LensViewCollector.h"

#include "BoardPose.h"
#include "Statistics.h"

#include <array>
#include <map>

namespace handeye
{

namespace
{

using Status = LensViewVerdict::Status;

constexpr double TiltedSine = 0.17;  ///< of 10 degrees
constexpr int WantedPerTilt = 2;

/// How far (px, median) points that two views share are apart; nothing where they share hardly any.
std::optional<double> medianMove(const LensView& a, const LensView& b)
{
  std::map<int, Eigen::Vector2d> places;
  for (std::size_t i = 0; i < a.ids.size(); ++i)
  {
    places[a.ids[i]] = a.points_Image[i];
  }
  std::vector<double> moves;
  for (std::size_t i = 0; i < b.ids.size(); ++i)
  {
    const auto place = places.find(b.ids[i]);
    if (place != places.end())
    {
      moves.push_back((place->second - b.points_Image[i]).norm());
    }
  }
  return moves.size() < 4 ? std::nullopt : std::optional(median(moves));
}

/// "upper left", "middle", ...: one of nine parts of the image.
std::string partName(int part)
{
  static const std::array<const char*, 9> names = { "the upper left corner", "the upper edge", "the upper right corner",
    "the left edge", "the middle", "the right edge", "the lower left corner", "the lower edge", "the lower right corner" };
  return names[std::size_t(part)];
}

/// The ninth of the image in which the largest share of cells is empty; nothing where all have points.
std::optional<int> emptiestPart(const Eigen::MatrixXi& coverage)
{
  std::array<int, 9> cells{}, empty{};
  for (int row = 0; row < coverage.rows(); ++row)
  {
    for (int column = 0; column < coverage.cols(); ++column)
    {
      const std::size_t part = std::size_t(3 * (3 * row / int(coverage.rows())) + 3 * column / int(coverage.cols()));
      ++cells[part];
      empty[part] += coverage(row, column) == 0 ? 1 : 0;
    }
  }
  std::optional<int> best;
  double most = 0;
  for (std::size_t part = 0; part < cells.size(); ++part)
  {
    const double share = cells[part] > 0 ? double(empty[part]) / cells[part] : 0;
    if (share > most)
    {
      most = share;
      best = int(part);
    }
  }
  return best;
}

}  // namespace

void LensViewCollectorOptions::check() const
{
  const auto require = [](bool isGood, const char* what)
  {
    if (!isGood)
    {
      throw std::invalid_argument(std::string("LensViewCollectorOptions: ") + what);
    }
  };
  require(stillnessPx > 0 && stillFrames >= 1, "stillnessPx is positive and stillFrames at least 1");
  require(maximumEdgeWidthPx > 0, "maximumEdgeWidthPx is positive");
  require(newPlaceShare > 0 && newTiltRad > 0, "newPlaceShare and newTiltRad are positive");
  require(coverageColumns >= 3 && coverageRows >= 3, "the coverage map has at least 3 x 3 cells");
  require(wantedViews >= 3 && maximumViews >= wantedViews, "wantedViews is at least 3 and maximumViews at least wantedViews");
  require(wantedCoverage > 0 && wantedCoverage <= 1, "wantedCoverage is between 0 and 1");
}

LensViewCollector::LensViewCollector(int width, int height, const LensViewCollectorOptions& options)
  : width_(width)
  , height_(height)
  , options_(options)
  , coverage_(Eigen::MatrixXi::Zero(std::max(1, options.coverageRows), std::max(1, options.coverageColumns)))
{
  options.check();
  if (width <= 0 || height <= 0)
  {
    throw std::invalid_argument("LensViewCollector: the pictures' width and height are expected to be positive");
  }
}

LensViewVerdict LensViewCollector::add(int frame, const BoardDetection& detection)
{
  if (!detection.isUsable())
  {
    last_ = {};
    stillCount_ = 0;
    return { Status::NoBoard, detection.message };
  }
  const LensView view = toLensView(frame, detection);
  const std::optional<double> move = medianMove(last_, view);
  stillCount_ = move && *move <= options_.stillnessPx ? stillCount_ + 1 : 1;
  last_ = view;
  if (stillCount_ < options_.stillFrames)
  {
    return { Status::Moving, "hold the board still" };
  }
  if (detection.edgeWidthPx > options_.maximumEdgeWidthPx)
  {
    return { Status::Blurred, "the picture is blurred: more light, or hold it still and in focus" };
  }
  const std::optional<Attitude> found = this->attitudeOf(view);
  const Attitude attitude = found.value_or(Attitude());
  if (!this->isNew(view, attitude))
  {
    return { Status::NotNew, this->hint() };
  }
  if (int(views_.size()) >= options_.maximumViews)
  {
    return { Status::Full, "there are as many views as are of use" };
  }
  views_.push_back(view);
  attitudes_.push_back(attitude);
  this->count(view, 1);
  return { Status::Taken, "taken: " + std::to_string(views_.size()) + " of " + std::to_string(options_.wantedViews) };
}

void LensViewCollector::remove(int index)
{
  if (index < 0 || index >= int(views_.size()))
  {
    throw std::out_of_range("LensViewCollector: there is no view " + std::to_string(index));
  }
  this->count(views_[std::size_t(index)], -1);
  views_.erase(views_.begin() + index);
  attitudes_.erase(attitudes_.begin() + index);
}

void LensViewCollector::clear()
{
  views_.clear();
  attitudes_.clear();
  coverage_.setZero();
  last_ = {};
  stillCount_ = 0;
}

void LensViewCollector::count(const LensView& view, int sign)
{
  for (const Eigen::Vector2d& point : view.points_Image)
  {
    const int column = int((point.x() + 0.5) / width_ * options_.coverageColumns);
    const int row = int((point.y() + 0.5) / height_ * options_.coverageRows);
    coverage_(std::clamp(row, 0, options_.coverageRows - 1), std::clamp(column, 0, options_.coverageColumns - 1)) += sign;
  }
}

bool LensViewCollector::isNew(const LensView& view, const Attitude& attitude) const
{
  const double farPx = options_.newPlaceShare * std::hypot(width_, height_);
  for (std::size_t i = 0; i < views_.size(); ++i)
  {
    const std::optional<double> move = medianMove(views_[i], view);
    const Eigen::Vector3d &a = attitudes_[i].normal_Camera, &b = attitude.normal_Camera;
    if (move && *move < farPx && std::atan2(a.cross(b).norm(), a.dot(b)) < options_.newTiltRad)
    {
      return false;
    }
  }
  return true;
}

std::optional<LensViewCollector::Attitude> LensViewCollector::attitudeOf(const LensView& view) const
{
  Eigen::Matrix3d cameraMatrix;
  cameraMatrix << width_, 0, (width_ - 1) / 2.0, 0, width_, (height_ - 1) / 2.0, 0, 0, 1;
  BoardPoseOptions options;
  options.maximumRelativeRms = 0.1;  // the lens is only a guess
  const BoardPose pose =
    estimateBoardPose(view.points_Board, view.points_Image, CameraModel(width_, height_, cameraMatrix, {}), options);
  const bool isThere = pose.isUsable() || pose.status == BoardPose::Status::Ambiguous;
  return isThere ? std::optional(Attitude{ pose.boardToCamera.linear().col(2) }) : std::nullopt;
}

double LensViewCollector::coverageShare() const
{
  return double((coverage_.array() > 0).count()) / double(coverage_.size());
}

LensViewCollector::Tilts LensViewCollector::tilts() const
{
  Tilts tilts;
  for (const Attitude& attitude : attitudes_)
  {
    // The normal points away from the camera: to the right where the board's right side is the nearer one.
    const Eigen::Vector3d& normal = attitude.normal_Camera;
    tilts.right += normal.x() > TiltedSine ? 1 : 0;
    tilts.left += normal.x() < -TiltedSine ? 1 : 0;
    tilts.bottom += normal.y() > TiltedSine ? 1 : 0;
    tilts.top += normal.y() < -TiltedSine ? 1 : 0;
    tilts.square += normal.head<2>().cwiseAbs().maxCoeff() <= TiltedSine ? 1 : 0;
  }
  return tilts;
}

double LensViewCollector::completeness() const
{
  const Tilts counted = this->tilts();
  double tilted = 0;
  for (const int count : { counted.left, counted.right, counted.top, counted.bottom })
  {
    tilted += std::min(count, WantedPerTilt) / (4.0 * WantedPerTilt);
  }
  return std::min({ 1.0, double(views_.size()) / options_.wantedViews, this->coverageShare() / options_.wantedCoverage, tilted });
}

std::string LensViewCollector::hint() const
{
  const Tilts counted = this->tilts();
  if (views_.empty())
  {
    return "Show the board to the camera.";
  }
  const std::pair<int, const char*> sides[] = { { counted.left, "left" }, { counted.right, "right" }, { counted.top, "upper" },
    { counted.bottom, "lower" } };
  const auto least =
    std::min_element(std::begin(sides), std::end(sides), [](const auto& a, const auto& b) { return a.first < b.first; });
  const std::optional<int> part = emptiestPart(coverage_);
  const bool isCovered = this->coverageShare() >= options_.wantedCoverage;
  // Tilts and places by turns, so that neither waits for the other.
  if (least->first < WantedPerTilt && (isCovered || views_.size() % 2 == 1 || !part))
  {
    return "Tilt the board so that its " + std::string(least->second) + " side is nearer to the camera.";
  }
  if (!isCovered && part)
  {
    return "Hold the board into " + partName(*part) + " of the picture.";
  }
  return int(views_.size()) < options_.wantedViews ? "Hold the board in another way or at another distance."
                                                   : "That is enough for a calibration.";
}

std::string toString(LensViewVerdict::Status status)
{
  switch (status)
  {
    case Status::Taken:
      return "taken";
    case Status::NoBoard:
      return "no_board";
    case Status::Moving:
      return "moving";
    case Status::Blurred:
      return "blurred";
    case Status::NotNew:
      return "not_new";
    case Status::Full:
      return "full";
  }
  return "unknown";
}

}  // namespace handeye
