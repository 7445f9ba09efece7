// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "OverlayOracle.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

/// Markers that plain arithmetic puts into a picture, and how far from there they are found.
namespace handeye::test
{

struct MarkerField
{
  vtkSmartPointer<vtkPolyData> mesh;
  std::vector<Eigen::Vector2d> expected_Image;
};

/// Where plain arithmetic sees the middle of a disc's image: the centroid of its bent outline, which near the end of a lens model
/// is not the image of the disc's middle.
inline Eigen::Vector2d discCentroid(const Lens& lens, const Eigen::Vector2d& centre_Normalized, double radius_Normalized)
{
  constexpr int pointsOfAnEdge = 8;
  std::vector<Eigen::Vector2d> outline;
  for (int i = 0; i < DiscCorners * pointsOfAnEdge; ++i)
  {
    const auto corner = [&](int index)
    {
      const double angle = 2 * M_PI * index / DiscCorners;
      return Eigen::Vector2d(centre_Normalized + radius_Normalized * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    };
    const double share = double(i % pointsOfAnEdge) / pointsOfAnEdge;
    const Eigen::Vector2d point = (1 - share) * corner(i / pointsOfAnEdge) + share * corner(i / pointsOfAnEdge + 1);
    outline.push_back(lens.pixel(point.x(), point.y()));
  }
  double area = 0;
  Eigen::Vector2d moment(0, 0);
  const Eigen::Vector2d origin = outline.front();
  for (std::size_t i = 0; i + 1 < outline.size(); ++i)
  {
    const Eigen::Vector2d a = outline[i] - origin, b = outline[i + 1] - origin;
    const double part = a.x() * b.y() - a.y() * b.x();
    area += part;
    moment += part * (a + b) / 3;
  }
  return origin + moment / area;
}

/// Markers over the whole picture, the corners included, at depths from 60 to 700 mm; and where plain arithmetic sees their
/// centres.
/// @param largestRadius points beyond it (X/Z, Y/Z) are left out
inline MarkerField markers(const Lens& lens, double radiusPx, int columns = 13, int rows = 10, double largestRadius = 1e9)
{
  constexpr std::array<double, 4> depths = { 60, 150, 300, 700 };
  const double margin = radiusPx + 4;
  MarkerField field;
  MeshInCamera mesh;
  for (int row = 0; row < rows; ++row)
  {
    for (int column = 0; column < columns; ++column)
    {
      const Eigen::Vector2d wanted(margin + (lens.width - 1 - 2 * margin) * column / (columns - 1.0),
        margin + (lens.height - 1 - 2 * margin) * row / (rows - 1.0));
      Eigen::Vector2d seen;
      if (lens.seenAt(wanted, seen) && seen.norm() < 0.97 * largestRadius)
      {
        const double z = depths[std::size_t(row + 3 * column) % depths.size()];
        mesh.disc(z * seen.homogeneous(), radiusPx * z / lens.fx);
        field.expected_Image.push_back(discCentroid(lens, seen, radiusPx / lens.fx));
      }
    }
  }
  field.mesh = mesh.mesh();
  return field;
}

struct Deviation
{
  double meanPx = 0;
  double maxPx = 0;
};

/// Each expected place has one marker near it, and there are no others. Markers touching the border (clipped) are an error too.
inline Deviation deviation(const cv::Mat& mask, const std::vector<Eigen::Vector2d>& expected)
{
  cv::Mat labels, statistics, centroids;
  const int found = cv::connectedComponentsWithStats(mask, labels, statistics, centroids, 8, CV_32S) - 1;
  EXPECT_EQ(found, int(expected.size()));
  Deviation result;
  for (const Eigen::Vector2d& place : expected)
  {
    double nearest = 1e9;
    for (int label = 1; label <= found; ++label)
    {
      nearest = std::min(nearest, (Eigen::Vector2d(centroids.at<double>(label, 0), centroids.at<double>(label, 1)) - place).norm());
    }
    result.meanPx += nearest / double(expected.size());
    result.maxPx = std::max(result.maxPx, nearest);
  }
  return result;
}

/// The same by centres of brightness, for pictures with smooth edges: whole components, and nothing but components.
inline Deviation weightedDeviation(const cv::Mat& picture, const std::vector<Eigen::Vector2d>& expected)
{
  cv::Mat labels;
  const int found = cv::connectedComponents(picture > 0, labels, 8, CV_32S) - 1;
  EXPECT_EQ(found, int(expected.size()));
  std::vector<Eigen::Vector3d> sums(std::size_t(found + 1), Eigen::Vector3d::Zero());
  for (int v = 0; v < picture.rows; ++v)
  {
    for (int u = 0; u < picture.cols; ++u)
    {
      sums[std::size_t(labels.at<int>(v, u))] += picture.at<uchar>(v, u) * Eigen::Vector3d(u, v, 1);
    }
  }
  Deviation result;
  for (const Eigen::Vector2d& place : expected)
  {
    double nearest = 1e9;
    for (std::size_t label = 1; label < sums.size(); ++label)
    {
      nearest = std::min(nearest, (sums[label].hnormalized() - place).norm());
    }
    result.meanPx += nearest / double(expected.size());
    result.maxPx = std::max(result.maxPx, nearest);
  }
  return result;
}

/// A round spot with a Gaussian profile (sigma 1.5 px), cut off where it would round to nothing.
inline void drawDot(cv::Mat& picture, const Eigen::Vector2d& centre)
{
  for (int v = int(centre.y()) - 6; v <= int(centre.y()) + 7; ++v)
  {
    for (int u = int(centre.x()) - 6; u <= int(centre.x()) + 7; ++u)
    {
      const double value = 250 * std::exp(-(Eigen::Vector2d(u, v) - centre).squaredNorm() / (2 * 1.5 * 1.5));
      picture.at<cv::Vec3b>(v, u) = cv::Vec3b::all(uchar(std::lround(value)));
    }
  }
}

}  // namespace handeye::test
