// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OutlineEdges.h"

#include "Statistics.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace handeye
{

namespace
{

constexpr double StepPx = 0.25;
constexpr double MinimumContrast = 0.08;
/// How much the light varies: by noise (of full light), and along its own colour by shading (of itself).
constexpr float LightNoise = 0.02F;
constexpr float ShadingInside = 0.1F;
constexpr float ShadingOutside = 0.1F;
constexpr int FewestNormals = 48;
constexpr int MostNormals = 240;
/// Width of the stretch inside and outside over which the light on either side is averaged.
constexpr double ReferencePx = 1.5;
/// The references start this many blurs from the edge, but not closer than NearestReferencePx.
constexpr double BlursToReference = 1.25;
constexpr double NearestReferencePx = 1.5;
constexpr double FurthestReferencePx = 5;
constexpr double UnknownBlurPx = 1.0;

float sRgbToLinear(double value)
{
  return float(value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4));
}

/// The light along one normal, from -reach to reach px.
struct Profile
{
  std::vector<float> level;  ///< 1 inside, 0 outside
  double contrast = 0;
};

class ProfileReader
{
public:
  /// @param anchored the expected outline is good to a pixel: the light is compared on either side of it. Otherwise on either side
  ///        of the
  ///        steepest fall, which a shadow on the ball may draw inwards.
  ProfileReader(const LinearLightImage& image, double reachPx, double referencePx, bool anchored)
    : image_(image)
    , anchored_(anchored)
    , reach_(reachPx)
    , reference_(referencePx)
    , half_(int(std::ceil((reachPx + referencePx + ReferencePx) / StepPx)))
    , light_(std::size_t(2 * half_ + 1))
  {
  }

  /// The place of the edge (px along the normal) nearest to the expected one; false if there is none.
  bool findEdge(const Eigen::Vector2d& point, const Eigen::Vector2d& normal, double& place, double& contrast, double& blur)
  {
    if (!image_.inside(point + half_ * StepPx * normal) || !image_.inside(point - half_ * StepPx * normal))
    {
      return false;
    }
    for (int i = -half_; i <= half_; ++i)
    {
      const Eigen::Vector2d at = point + i * StepPx * normal;
      light_[std::size_t(i + half_)] = image_.at(at.x(), at.y());
    }
    double centre = anchored_ ? 0 : steepest();
    for (int round = 0; round < (anchored_ ? 1 : 3); ++round)
    {
      if (std::abs(centre) > reach_ || !locate(centre, contrast, blur))
      {
        return false;
      }
    }
    place = centre;
    return std::abs(place) <= reach_;
  }

private:
  Eigen::Vector3f mean(double from, double to) const
  {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    const int first = int(std::lround(from / StepPx)) + half_, last = int(std::lround(to / StepPx)) + half_;
    for (int i = first; i <= last; ++i)
    {
      sum += light_[std::size_t(std::clamp(i, 0, 2 * half_))];
    }
    return sum / float(last - first + 1);
  }

  double steepest() const
  {
    const int gap = std::max(1, int(1.0 / StepPx));
    const int limit = int(reach_ / StepPx);
    float most = 0;
    int where = 0;
    for (int i = -limit; i <= limit; ++i)
    {
      const float change = (light_[std::size_t(i + half_ + gap)] - light_[std::size_t(i + half_ - gap)]).norm();
      if (change > most)
      {
        most = change;
        where = i;
      }
    }
    return where * StepPx;
  }

  /// The direction of colour along which inside and outside are told apart, scaled so that they are 1 apart: Fisher's discriminant
  /// for light that varies by noise and, on either side, along its own colour by shading. A ball that darkens towards its limb
  /// keeps its colour; so where the background differs in colour its brightness hardly counts, and where it does not, brightness is
  /// what there is.
  static Eigen::Vector3f discriminant(const Eigen::Vector3f& inside, const Eigen::Vector3f& outside)
  {
    const Eigen::Matrix3f variation = LightNoise * LightNoise * Eigen::Matrix3f::Identity() +
      ShadingInside * ShadingInside * inside * inside.transpose() + ShadingOutside * ShadingOutside * outside * outside.transpose();
    const Eigen::Vector3f across = inside - outside;
    const Eigen::Vector3f direction = variation.inverse() * across;
    return direction / direction.dot(across);
  }

  /// One refinement of the edge's place from the light on either side of it.
  bool locate(double& centre, double& contrast, double& blur) const
  {
    const Eigen::Vector3f inside = mean(centre - reference_ - ReferencePx, centre - reference_);
    const Eigen::Vector3f outside = mean(centre + reference_, centre + reference_ + ReferencePx);
    const Eigen::Vector3f across = inside - outside;
    contrast = across.norm();
    if (contrast < MinimumContrast)
    {
      return false;
    }
    const Eigen::Vector3f direction = discriminant(inside, outside);
    const int first = int(std::lround((centre - reference_) / StepPx)), last = int(std::lround((centre + reference_) / StepPx));
    double area = 0, spread = 0;
    int crossings = 0;
    float before = 0;
    for (int i = first; i <= last; ++i)
    {
      const float level = (light_[std::size_t(std::clamp(i + half_, 0, 2 * half_))] - outside).dot(direction);
      const double share = i == first || i == last ? 0.5 : 1;
      area += share * StepPx * double(level);
      spread += share * StepPx * std::max(0.0, double(level) * (1 - double(level)));
      crossings += i > first && ((before >= 0.5F) != (level >= 0.5F)) ? 1 : 0;
      before = level;
    }
    if (crossings != 1)
    {
      return false;
    }
    centre = first * StepPx + area;
    blur = spread * std::sqrt(EIGEN_PI);
    return true;
  }

  const LinearLightImage& image_;
  bool anchored_;
  double reach_;
  double reference_;
  int half_;
  std::vector<Eigen::Vector3f> light_;
};

}  // namespace

LinearLightImage::LinearLightImage(const cv::Mat& image)
  : image_(image)
{
  const int count = image.depth() == CV_16U ? 65536 : 256;
  table_.resize(std::size_t(count));
  for (int value = 0; value < count; ++value)
  {
    table_[std::size_t(value)] = sRgbToLinear(double(value) / (count - 1));
  }
}

bool LinearLightImage::inside(const Eigen::Vector2d& point_Image) const
{
  return point_Image.x() >= 0 && point_Image.y() >= 0 && point_Image.x() < image_.cols - 1 && point_Image.y() < image_.rows - 1;
}

template<typename Pixel> Eigen::Vector3f LinearLightImage::interpolate(double x, double y) const
{
  const int column = int(x), row = int(y), channels = image_.channels();
  const float fx = float(x - column), fy = float(y - row);
  const Pixel* upper = image_.ptr<Pixel>(row) + column * channels;
  const Pixel* lower = image_.ptr<Pixel>(row + 1) + column * channels;
  Eigen::Vector3f light;
  for (int c = 0; c < 3; ++c)
  {
    const float top = table_[upper[c]] * (1 - fx) + table_[upper[c + channels]] * fx;
    const float bottom = table_[lower[c]] * (1 - fx) + table_[lower[c + channels]] * fx;
    light[c] = top * (1 - fy) + bottom * fy;
  }
  return light;
}

Eigen::Vector3f LinearLightImage::at(double x, double y) const
{
  return image_.depth() == CV_16U ? interpolate<ushort>(x, y) : interpolate<uchar>(x, y);
}

OutlineEdges findOutlineEdges(
  const LinearLightImage& image, const CameraModel& camera, const SphereCone& expected, double reachPx, double blurPx)
{
  const double radiusPx = std::tan(expected.halfAngle) * (camera.fx() + camera.fy()) / 2;
  const int count = std::clamp(int(2 * EIGEN_PI * radiusPx / 1.5), FewestNormals, MostNormals);
  const double blur = blurPx > 0 ? blurPx : UnknownBlurPx;
  const double reference = std::min(std::clamp(BlursToReference * blur, NearestReferencePx, FurthestReferencePx), 0.4 * radiusPx);
  const SphereCone::Outline outline = expected.outline(camera, count);

  OutlineEdges result;
  result.searched = count;
  ProfileReader reader(image, std::min(reachPx, 0.6 * radiusPx), reference, blurPx > 0);
  std::vector<double> blurs;
  for (std::size_t i = 0; i < outline.points_Image.size(); ++i)
  {
    double place = 0, contrast = 0, edgeBlur = 0;
    if (!reader.findEdge(outline.points_Image[i], outline.normals_Image[i], place, contrast, edgeBlur))
    {
      continue;
    }
    const Eigen::Vector2d edge_Image = outline.points_Image[i] + place * outline.normals_Image[i];
    const CameraModel::Unprojection ray = camera.unproject(edge_Image);
    if (ray.isUsable())
    {
      result.edges.push_back({ edge_Image, ray.ray_Camera, contrast });
      blurs.push_back(edgeBlur);
    }
  }
  result.blurPx = blurs.empty() ? 0 : median(blurs);
  return result;
}

}  // namespace handeye
