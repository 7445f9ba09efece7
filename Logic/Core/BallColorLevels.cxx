// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BallColorLevels.h"

#include "WideVectors.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

namespace handeye
{

namespace
{

constexpr double HighlightValue = 0.75;

/// What the levels above the first ask for at least.
struct Demand
{
  double saturation;
  double chroma;
};
constexpr Demand Demands[BallColorLevels::Count] = { { 0, 0 }, { 0.52, 0 }, { 0.66, 0 }, { 0.45, 0.35 }, { 0.6, 0.55 } };

int toByte(double share)
{
  return int(std::lround(255 * share));
}

/// The plane of colour differences: x = 2R - G - B, y = sqrt(3) (G - B). The hue of HSV is not quite its polar angle; this is the
/// direction of a hue in it.
struct Direction
{
  explicit Direction(double hueDeg)
  {
    const double sector = std::fmod(std::fmod(hueDeg, 360.0) + 360.0, 360.0) / 60;
    const auto channel = [&](double shift)
    {
      const double k = std::fmod(shift + sector, 6.0);
      return 1 - std::clamp(std::min(k, 4 - k), 0.0, 1.0);
    };
    const double red = channel(5), green = channel(3), blue = channel(1);
    x = 2 * red - green - blue;
    y = std::sqrt(3.0) * (green - blue);
  }

  double x;
  double y;
};

/// The hues from one direction to another, turning towards green: two half planes.
struct HueSector
{
  explicit HueSector(const BallColor& color)
  {
    const Direction first(color.hueDeg - color.hueToleranceDeg), last(color.hueDeg + color.hueToleranceDeg);
    set(first, 1, fromFirst);
    set(last, -1, fromLast);
  }

  /// The cross product of an edge's direction with a colour, as factors of blue, green and red; scaled to whole numbers.
  static void set(const Direction& edge, int sign, int (&factors)[3])
  {
    const double scale = sign * 1024 / std::hypot(edge.x, edge.y);
    const double root = std::sqrt(3.0);
    // edge.x * y - edge.y * x
    factors[0] = int(std::lround(scale * (-root * edge.x + edge.y)));
    factors[1] = int(std::lround(scale * (root * edge.x + edge.y)));
    factors[2] = -factors[0] - factors[1];  // a grey pixel has no side
  }

  int fromFirst[3];
  int fromLast[3];
};

struct Thresholds
{
  int saturation[BallColorLevels::Count];
  int chroma[BallColorLevels::Count];
  int value;
  int highlight = toByte(HighlightValue);

  explicit Thresholds(const BallColor& color)
    : value(toByte(color.minimumValue))
  {
    for (int level = 0; level < BallColorLevels::Count; ++level)
    {
      saturation[level] = toByte(std::max(color.minimumSaturation, Demands[level].saturation));
      // A pixel without any chroma has no hue.
      chroma[level] = std::max(1, toByte(std::max(color.minimumChroma, Demands[level].chroma)));
    }
  }
};

/// One row of three planes. Branch-free, so that the compiler makes it work on several pixels at once.
HANDEYE_WIDE_VECTORS void readRow(const uchar* blue, const uchar* green, const uchar* red, int count, const HueSector& sector,
  const Thresholds& limits, uchar* bits)
{
  for (int i = 0; i < count; ++i)
  {
    const int b = blue[i], g = green[i], r = red[i];
    const int value = std::max(b, std::max(g, r)), chroma = value - std::min(b, std::min(g, r));
    const int first = sector.fromFirst[0] * b + sector.fromFirst[1] * g + sector.fromFirst[2] * r;
    const int last = sector.fromLast[0] * b + sector.fromLast[1] * g + sector.fromLast[2] * r;
    const int isHue = int(first >= 0) & int(last >= 0) & int(value >= limits.value);
    const int share = 255 * chroma;
    int met = 0;
    for (int level = 0; level < BallColorLevels::Count; ++level)
    {
      met |= (int(share >= limits.saturation[level] * value) & int(chroma >= limits.chroma[level])) << level;
    }
    const int isColored = -(isHue & (met & 1));
    bits[i] = uchar((met & isColored) | (int(value >= limits.highlight) << 7 & ~isColored));
  }
}

}  // namespace

BallColorLevels::BallColorLevels(const cv::Mat& image, const BallColor& color, const cv::Rect& window)
  : window_(window)
{
  requireColorImage(image);
  bits_.create(window.size(), CV_8U);
  const HueSector sector(color);
  const Thresholds limits(color);
  const bool isBgr = color.channelOrder == BallColor::ChannelOrder::Bgr;
  // A few rows at a time, which stay in the cache from the planes to the bits.
  constexpr int RowsAtOnce = 16;
  std::vector<cv::Mat> planes;
  cv::Mat eight;
  for (int row = 0; row < window.height; row += RowsAtOnce)
  {
    const cv::Rect stripe(window.x, window.y + row, window.width, std::min(RowsAtOnce, window.height - row));
    cv::split(toEightBits(image(stripe), eight), planes);
    for (int i = 0; i < stripe.height; ++i)
    {
      readRow(planes[isBgr ? 0 : 2].ptr(i), planes[1].ptr(i), planes[isBgr ? 2 : 0].ptr(i), window.width, sector, limits,
        bits_.ptr(row + i));
    }
  }
}

cv::Mat BallColorLevels::mask(int level, const cv::Rect& part) const
{
  cv::Mat met;
  cv::bitwise_and(bits_(part - window_.tl()), 1 << level, met);
  return met;
}

cv::Mat BallColorLevels::likelihood() const
{
  cv::Mat count, table(1, 256, CV_8U);
  for (int i = 0; i < 256; ++i)
  {
    int met = 0;
    for (int level = 0; level < Count; ++level)
    {
      met += i >> level & 1;
    }
    table.at<uchar>(i) = uchar(met);
  }
  cv::LUT(bits_, table, count);
  return count;
}

}  // namespace handeye
