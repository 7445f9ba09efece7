// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "RoomMesh.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace handeye::simulation
{

namespace
{

constexpr int Grid = 2;  ///< samples along a pixel's side

struct Vertex
{
  bool isSeen = false;
  Eigen::Vector2d at;  ///< px of the image
  double inverseDepth = 0, brightness = 0;
};

/// Samples of a part of the image.
struct Samples
{
  explicit Samples(const cv::Rect& part)
    : area(part)
    , inverseDepth(cv::Mat1f::zeros(Grid * part.height, Grid * part.width))
    , light(Grid * part.height, Grid * part.width)
  {
  }

  /// A place in the image in the samples' own coordinates: whole numbers are samples.
  Eigen::Vector2d own(const Eigen::Vector2d& at) const
  {
    return { Grid * (at.x() - area.x + 0.5) - 0.5, Grid * (at.y() - area.y + 0.5) - 0.5 };
  }

  /// Brings them into the picture; what no sample of the mesh covers stays what it was.
  void averageInto(cv::Mat& picture) const
  {
    for (int row = 0; row < area.height; ++row)
    {
      for (int column = 0; column < area.width; ++column)
      {
        Light sum(0, 0, 0);
        int covered = 0;
        for (int i = 0; i < Grid * Grid; ++i)
        {
          const int y = Grid * row + i / Grid, x = Grid * column + i % Grid;
          if (inverseDepth(y, x) > 0)
          {
            sum += light(y, x);
            ++covered;
          }
        }
        Light& pixel = picture.at<Light>(area.y + row, area.x + column);
        pixel = covered > 0 ? (sum + float(Grid * Grid - covered) * pixel) / float(Grid * Grid) : pixel;
      }
    }
  }

  cv::Rect area;
  cv::Mat1f inverseDepth;  ///< 1/mm; 0 where there is nothing
  cv::Mat_<Light> light;
};

std::vector<Vertex> project(const CameraModel& camera, const RoomMesh& mesh, const Eigen::Isometry3d& modelToCamera)
{
  const Eigen::Vector3d lamp = Eigen::Vector3d(-0.3, -0.8, -0.5).normalized();
  std::vector<Vertex> vertices(mesh.points_Model.size());
  for (std::size_t i = 0; i < vertices.size(); ++i)
  {
    const Eigen::Vector3d point_Camera = modelToCamera * mesh.points_Model[i];
    const CameraModel::Projection seen = camera.project(point_Camera);
    // Far outside of the image it is not drawn, and coordinates stay small.
    if (seen.isUsable() && seen.point_Image.cwiseAbs().maxCoeff() < 1e4)
    {
      const Eigen::Vector3d normal_Camera = modelToCamera.linear() * mesh.normals_Model[i];
      vertices[i] = { true, seen.point_Image, 1 / point_Camera.z(), 0.25 + 0.9 * std::max(0.0, normal_Camera.dot(lamp)) };
    }
  }
  return vertices;
}

cv::Rect boundsOf(const std::vector<Vertex>& vertices, const cv::Size& size)
{
  Eigen::AlignedBox2d box;
  for (const Vertex& vertex : vertices)
  {
    if (vertex.isSeen)
    {
      box.extend(vertex.at);
    }
  }
  if (box.isEmpty())
  {
    return {};
  }
  const cv::Rect area(cv::Point(int(std::floor(box.min().x())), int(std::floor(box.min().y()))),
    cv::Point(int(std::ceil(box.max().x())) + 1, int(std::ceil(box.max().y())) + 1));
  return area & cv::Rect({ 0, 0 }, size);
}

/// The dots that touch a triangle; most have none.
std::vector<Eigen::Vector3d> dotsOn(const std::array<const Eigen::Vector3d*, 3>& corners_Model, const RoomMeshLook& look)
{
  std::vector<Eigen::Vector3d> near;
  const double sideMm = std::max({ (*corners_Model[0] - *corners_Model[1]).norm(), (*corners_Model[1] - *corners_Model[2]).norm(),
    (*corners_Model[2] - *corners_Model[0]).norm() });
  for (const Eigen::Vector3d& dot_Model : look.dots_Model)
  {
    if ((dot_Model - *corners_Model[0]).norm() < look.dotRadiusMm + sideMm)
    {
      near.push_back(dot_Model);
    }
  }
  return near;
}

class Rasterizer
{
public:
  Rasterizer(Samples& samples, const RoomMesh& mesh, const std::vector<Vertex>& vertices, const RoomMeshLook& look)
    : samples_(samples)
    , mesh_(mesh)
    , vertices_(vertices)
    , look_(look)
  {
  }

  void draw(const std::array<int, 3>& triangle)
  {
    const Vertex* corners[3] = {};
    Eigen::Vector2d at[3];
    for (int i = 0; i < 3; ++i)
    {
      corners[i] = &vertices_[std::size_t(triangle[std::size_t(i)])];
      if (!corners[i]->isSeen)
      {
        return;
      }
      at[i] = samples_.own(corners[i]->at);
    }
    // y runs down: counter-clockwise from outside is a negative area in the image. Back faces are hidden by front ones.
    const Eigen::Vector2d first = at[1] - at[0], second = at[2] - at[0];
    const double area = first.x() * second.y() - first.y() * second.x();
    if (area >= 0)
    {
      return;
    }
    const auto low = [&](int axis) { return std::max(0, int(std::ceil(std::min({ at[0](axis), at[1](axis), at[2](axis) })))); };
    const auto high = [&](int axis, int end) {
      return std::min(end - 1, int(std::floor(std::max({ at[0](axis), at[1](axis), at[2](axis) }))));
    };
    const int right = high(0, samples_.light.cols), bottom = high(1, samples_.light.rows);
    const std::array<const Eigen::Vector3d*, 3> corners_Model = { &mesh_.points_Model[std::size_t(triangle[0])],
      &mesh_.points_Model[std::size_t(triangle[1])], &mesh_.points_Model[std::size_t(triangle[2])] };
    const std::vector<Eigen::Vector3d> dots_Model = dotsOn(corners_Model, look_);
    for (int y = low(1); y <= bottom; ++y)
    {
      for (int x = low(0); x <= right; ++x)
      {
        const Eigen::Vector2d here = Eigen::Vector2d(x, y) - at[0];
        const double ofSecond = (here.x() * second.y() - here.y() * second.x()) / area;
        const double ofThird = (first.x() * here.y() - first.y() * here.x()) / area;
        const Eigen::Vector3d shares(1 - ofSecond - ofThird, ofSecond, ofThird);
        if (shares.minCoeff() >= 0)
        {
          this->paint(x, y, corners, corners_Model, dots_Model, shares);
        }
      }
    }
  }

private:
  void paint(int x, int y, const Vertex* const (&corners)[3], const std::array<const Eigen::Vector3d*, 3>& corners_Model,
    const std::vector<Eigen::Vector3d>& dots_Model, const Eigen::Vector3d& shares)
  {
    const Eigen::Vector3d inverseDepths(corners[0]->inverseDepth, corners[1]->inverseDepth, corners[2]->inverseDepth);
    const auto inverseDepth = float(shares.dot(inverseDepths));
    float& nearest = samples_.inverseDepth(y, x);
    if (inverseDepth <= nearest)
    {
      return;
    }
    nearest = inverseDepth;
    const Eigen::Vector3d brightness(corners[0]->brightness, corners[1]->brightness, corners[2]->brightness);
    const Light* color = &look_.color;
    if (!dots_Model.empty())
    {
      const Eigen::Vector3d point_Model =
        shares(0) * *corners_Model[0] + shares(1) * *corners_Model[1] + shares(2) * *corners_Model[2];
      const bool isInDot = std::any_of(dots_Model.begin(), dots_Model.end(),
        [&](const Eigen::Vector3d& dot_Model) { return (dot_Model - point_Model).norm() < look_.dotRadiusMm; });
      color = isInDot ? &look_.dotColor : color;
    }
    samples_.light(y, x) = *color * float(shares.dot(brightness));
  }

  Samples& samples_;
  const RoomMesh& mesh_;
  const std::vector<Vertex>& vertices_;
  const RoomMeshLook& look_;
};

}  // namespace

RoomMesh::RoomMesh(std::vector<Eigen::Vector3d> points, std::vector<std::array<int, 3>> corners)
  : points_Model(std::move(points))
  , triangles(std::move(corners))
  , normals_Model(points_Model.size(), Eigen::Vector3d::Zero())
{
  const auto isPoint = [this](int index) { return index >= 0 && std::size_t(index) < points_Model.size(); };
  const bool isGood = std::all_of(points_Model.begin(), points_Model.end(), [](const auto& point) { return point.allFinite(); }) &&
    std::all_of(triangles.begin(), triangles.end(),
      [&](const auto& triangle) { return std::all_of(triangle.begin(), triangle.end(), isPoint); });
  if (!isGood)
  {
    throw std::invalid_argument("mesh of a simulated room: finite points, and triangles of them, are expected");
  }
  for (const auto& [first, second, third] : triangles)
  {
    const Eigen::Vector3d& origin = points_Model[std::size_t(first)];
    const Eigen::Vector3d toSecond = points_Model[std::size_t(second)] - origin,
                          toThird = points_Model[std::size_t(third)] - origin;
    const Eigen::Vector3d weighted = toSecond.cross(toThird);
    for (const int corner : { first, second, third })
    {
      normals_Model[std::size_t(corner)] += weighted;
    }
  }
  for (Eigen::Vector3d& normal : normals_Model)
  {
    normal.normalize();
  }
}

void drawMesh(
  cv::Mat& light, const CameraModel& camera, const RoomMesh& mesh, const Eigen::Isometry3d& modelToCamera, const RoomMeshLook& look)
{
  const std::vector<Vertex> vertices = project(camera, mesh, modelToCamera);
  const cv::Rect area = boundsOf(vertices, light.size());
  if (area.empty())
  {
    return;
  }
  Samples samples(area);
  Rasterizer rasterizer(samples, mesh, vertices, look);
  for (const std::array<int, 3>& triangle : mesh.triangles)
  {
    rasterizer.draw(triangle);
  }
  samples.averageInto(light);
}

}  // namespace handeye::simulation
