// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LinearLightImage.h"

#include <cmath>
#include <vector>

namespace handeye
{

namespace
{

std::vector<float> makeTable(int count)
{
  std::vector<float> table;
  for (int i = 0; i < count; ++i)
  {
    const double value = double(i) / (count - 1);
    table.push_back(float(value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4)));
  }
  return table;
}

const float* tableFor(int depth)
{
  static const std::vector<float> eight = makeTable(256);
  if (depth == CV_8U)
  {
    return eight.data();
  }
  static const std::vector<float> sixteen = makeTable(65536);
  return sixteen.data();
}

}  // namespace

LinearLightImage::LinearLightImage(const cv::Mat& image)
  : image_(image)
  , table_(tableFor(image.depth()))
{
}

template<typename Pixel>
void LinearLightImage::interpolate(
  const Eigen::Vector2d& first, const Eigen::Vector2d& step, int count, Eigen::Vector3f* light) const
{
  const int channels = image_.channels();
  const uchar* const data = image_.data;
  const std::size_t rowBytes = image_.step[0];
  for (int i = 0; i < count; ++i)
  {
    const double x = first.x() + i * step.x(), y = first.y() + i * step.y();
    const int column = int(x), row = int(y);
    const float fx = float(x - column), fy = float(y - row);
    const uchar* const at = data + std::size_t(row) * rowBytes + std::size_t(column * channels) * sizeof(Pixel);
    const auto* const upper = reinterpret_cast<const Pixel*>(at);
    const auto* const lower = reinterpret_cast<const Pixel*>(at + rowBytes);
    for (int c = 0; c < 3; ++c)
    {
      const float top = table_[upper[c]] + fx * (table_[upper[c + channels]] - table_[upper[c]]);
      const float bottom = table_[lower[c]] + fx * (table_[lower[c + channels]] - table_[lower[c]]);
      light[i][c] = top + fy * (bottom - top);
    }
  }
}

void LinearLightImage::along(const Eigen::Vector2d& first, const Eigen::Vector2d& step, int count, Eigen::Vector3f* light) const
{
  image_.depth() == CV_16U ? interpolate<ushort>(first, step, count, light) : interpolate<uchar>(first, step, count, light);
}

Eigen::Vector3f LinearLightImage::pixel(int column, int row) const
{
  const auto read = [&](const auto* values) { return Eigen::Vector3f(table_[values[0]], table_[values[1]], table_[values[2]]); };
  const int first = column * image_.channels();
  return image_.depth() == CV_16U ? read(image_.ptr<ushort>(row) + first) : read(image_.ptr<uchar>(row) + first);
}

float LinearLightImage::slope(float light)
{
  constexpr float EndOfStraightPart = 0.0031308F;
  return light > EndOfStraightPart ? 2.4F / 1.055F * std::pow(light, 1.4F / 2.4F) : 1 / 12.92F;
}

}  // namespace handeye
