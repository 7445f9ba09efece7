// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "OutlineHiding.h"
#include "OutlinePixels.h"
#include "OutlineSide.h"
#include "SphereCone.h"

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <vector>

namespace handeye
{

/// What a pixel should be by the model, and is; in units of the noise of the encoded value.
struct PixelDifference
{
  bool isCounted = false;  ///< the model says something of the pixel
  Eigen::Vector3f difference = Eigen::Vector3f::Zero();
  Eigen::Vector3f byInside = Eigen::Vector3f::Zero();  ///< how fast what it should be changes with `inside`
  Eigen::Vector3f bySeen = Eigen::Vector3f::Zero();    ///< and with `seen`
  double inside = 0;                                   ///< of the pixel, inwards from the outline, in blurs
  double seen = 0;                                     ///< away from the hiding edge, in blurs
  double turnRate = 0;                                 ///< px for each rad that the hiding edge turns
  int edge = -1;                                       ///< the hiding edge, if one is near

  float square() const { return difference.squaredNorm(); }
  bool isWithin(double blurs) const { return std::abs(inside) < blurs || (edge >= 0 && std::abs(seen) < blurs); }
};

/// The pixels around an outline in even light: a ball, what is around it, and what hides parts of it, seen through blurred optics.
/// Internal to the detection.
///
/// Parameters: the outline's step (SphereCone::moved()), the blur (px), and of each hiding edge its offset (px) and its turn (rad).
class EvenLightModel
{
public:
  static constexpr int MostParameters = 12;
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, MostParameters, 1>;
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, MostParameters, MostParameters>;
  static constexpr int OfOutline = 4;
  static constexpr int OfEdge = 2;

  /// @param outline kept by the caller
  EvenLightModel(const SphereCone::Outline& outline, double radiusPx, double blurPx);

  /// How far from the outline the light is that counts as that of either side, px.
  double nearPx() const { return nearPx_; }
  double deepestPx() const { return deepestPx_; }
  /// How deep inside one may look where it is not known what hides a part: that may reach half way across the ball.
  double shallowPx() const;
  double furthestPx() const;
  double spacingPx() const { return spacingPx_; }

  /// Back to a place.
  void place(const Eigen::Vector3d& step, double blurPx, const std::vector<HidingEdge>& edges);
  const Eigen::Vector3d& step() const { return step_; }
  double blurPx() const { return blurPx_; }
  const std::vector<HidingEdge>& edges() const { return edges_; }
  int parameterCount() const { return OfOutline + OfEdge * int(edges_.size()); }
  void move(const Vector& by);

  /// The light on either side from the pixels that are far from any edge, and inside no deeper than that (px).
  void collect(const std::vector<OutlinePixel>& pixels, double deepestPx);
  /// Averaged over the normals that are good.
  void average(const std::vector<char>& isGood);
  void gather(float noiseVariance, const std::vector<char>& isGood);
  /// The larger of the two sides' OutlineSide::change().
  double change() const;
  const OutlineSide& inside() const { return inside_; }
  const OutlineSide& outside() const { return outside_; }

  /// Whether the outline is behind something at a normal.
  bool isHidden(std::size_t normal) const;

  PixelDifference differenceOf(const OutlinePixel& pixel) const;

  /// Adds a pixel to the normal equations.
  void add(const OutlinePixel& pixel, const PixelDifference& difference, double weight, Matrix& information, Vector& right) const;

private:
  /// What a hiding edge makes of a pixel.
  struct Hiding
  {
    bool isCounted = true;  ///< it is seen, or what is seen of it is known
    int edge = -1;          ///< so near that there are three lights
    double beyondPx = 0;
  };

  double shift(std::size_t normal) const { return outline_.rates[normal].dot(step_); }
  void assignEdges();
  Hiding hidingOf(const OutlinePixel& pixel) const;
  void compareWithTwo(const OutlinePixel& pixel, PixelDifference& result) const;
  void compareWithThree(const OutlinePixel& pixel, PixelDifference& result) const;

  const SphereCone::Outline& outline_;
  double nearPx_, deepestPx_, radiusPx_, spacingPx_;
  Eigen::Vector3d step_ = Eigen::Vector3d::Zero();
  double blurPx_;
  OutlineSide inside_, outside_;
  std::vector<HidingEdge> edges_;
  std::vector<int> edgeOf_;  ///< normal by normal: the hiding edge that is near, or that there is none, or that it is hidden
};

}  // namespace handeye
