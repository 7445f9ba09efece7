// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "EvenLightFit.h"

#include "EdgeProfiles.h"
#include "EvenLightModel.h"
#include "OutlineHiding.h"
#include "OutlinePixels.h"
#include "OutlineSide.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace handeye
{

namespace
{

/// Pixels so many blurs from an edge say whether it is one; pixels so many blurs from it have a say in where it is.
constexpr double BlursOfEdge = 2.5;
constexpr double BlursThatCount = 3;
constexpr std::size_t FewestNormals = 8;
constexpr int Rounds = 5;
constexpr int RoundsOfHidingEdges = 3;
constexpr int RoundsOfSettling = 3;
/// Squares of differences in units of the noise' variance: of normals that have what the model says, all across and near the edge, and
/// of a pixel that counts.
constexpr float LargestOfNormal = 2;
constexpr float LargestOfEdge = 4;
constexpr float LargestOfPixel = 36;
/// Of the pixels where an outline goes under a hiding edge: where three lights meet the model is coarser.
constexpr float LargestOfHiding = 8;
/// Of full light's encoded value: the blur is a Gaussian's only to so much, however little noise there is.
constexpr float LeastNoise = 2.5F / 255;
/// Normals beside such a one are left out, too.
constexpr int BesideWrong = 1;
/// The noise is that of the best of the normals that are trusted, so many of them.
constexpr double CleanShare = 0.3;
/// Of the change of the light between the nearer and the further half of a stretch.
constexpr double LargestChange = 3;
/// Twice as much where an outline has only so many normals: there are few independent ones among them.
constexpr double FewNormals = 100;
/// A larger scatter (of full light's encoded value) is not the noise of a camera alone.
constexpr float LargestNoise = 4 / 255.0F;
/// The light is not even where fewer normals than this share of those with a right edge have what the model says.
constexpr double LeastGood = 0.7;
/// A fit that ends further than this from where it started has followed something else.
constexpr double LargestMovePx = 1;
/// What hides a part may reach into the stretches of the normals at the ends of a seen part: a third of it, at most so many px, is not
/// trusted at first.
constexpr double LargestEndPx = 8;
/// Nothing is hidden where so much of the outline is supported.
constexpr double Whole = 0.9;
/// How well a hiding edge is known before (px, rad), so that the equations can be solved.
constexpr double EdgeSigmaPx = 2;
constexpr double EdgeSigmaTurn = 0.7;
/// How well the outline (px, root mean square all around) and the blur (px) are known before.
constexpr double StartSigmaPx = 0.2;
constexpr double StartBlurSigmaPx = 0.2;

/// The supported normals without the ends of each stretch of them.
std::vector<char> trusted(const SphereCone::Outline& outline, const EvenLightStart& start, double spacingPx)
{
  const std::size_t count = outline.points_Image.size();
  std::vector<char> isSupported(count, 0);
  for (const std::size_t index : start.support)
  {
    isSupported[index] = 1;
  }
  // One normal that was not found is no end.
  std::vector<char> flags = isSupported;
  for (std::size_t i = 0; i < count; ++i)
  {
    flags[i] = char(isSupported[i] | (isSupported[(i + 1) % count] & isSupported[(i + count - 1) % count]));
  }
  for (const OutlineRun& run : runsOf(flags))
  {
    const int end = std::min(run.count / 3, int(LargestEndPx / spacingPx));
    for (int k = 0; k < end; ++k)
    {
      isSupported[std::size_t(run.first + k) % count] = 0;
      isSupported[std::size_t(run.first + run.count - 1 - k) % count] = 0;
    }
  }
  return isSupported;
}

/// The fit to the pixels, round by round.
class EvenLightFitter
{
public:
  EvenLightFitter(const LinearLightImage& light, const SphereCone::Outline& outline, const EvenLightStart& start)
    : outline_(outline)
    , start_(start)
    , startStep_(start.step)
    , startBlurPx_(std::max(start.blurPx, EdgeProfiles::SharpestPx))
    , model_(outline, start.radiusPx, startBlurPx_)
    , isTrusted_(trusted(outline, start, model_.spacingPx()))
    , pixels_(pixelsAlongOutline(light, outline, start.radiusPx, model_.deepestPx(), model_.furthestPx()))
  {
  }

  std::optional<EvenLightResult> fit()
  {
    if (!look())
    {
      return std::nullopt;
    }
    std::vector<HidingEdge> edges =
      findHidingEdges({ outline_, pixels_, model_.inside(), model_.outside(), isEdge_, model_.nearPx(), noise_ });
    for (;;)
    {
      // What turns out not to be a straight edge is left out, and all is done again.
      const bool isFitted = fitWith(edges);
      std::vector<HidingEdge> right;
      for (std::size_t i = 0; i < edges.size() && isFitted; ++i)
      {
        if (isRight(int(i)))
        {
          right.push_back(edges[i]);
        }
      }
      if (right.size() == edges.size())
      {
        return isFitted ? std::optional(result()) : std::nullopt;
      }
      edges = right;
    }
  }

private:
  void collect()
  {
    const bool isWhole = double(start_.support.size()) >= Whole * double(isTrusted_.size());
    depthPx_ = isWhole || !model_.edges().empty() ? model_.deepestPx() : model_.shallowPx();
    model_.collect(pixels_, depthPx_);
  }

  /// A round without a step, as if nothing were hidden. Where the start is not good enough to judge by, it is first made better on
  /// the trusted normals.
  bool look() { return lookOnce() || (settle() && lookOnce()); }

  bool lookOnce()
  {
    model_.place(startStep_, startBlurPx_, {});
    isEven_ = isTrusted_;
    noise_ = LargestNoise * LargestNoise;
    collect();
    model_.average(isEven_);
    return isEven() && judge();
  }

  /// The trusted normals may be a short arc, which leaves the outline's far side free: it is held by where the edges put it.
  bool settle()
  {
    if (std::exchange(isSettled_, true) || std::size_t(std::count(isTrusted_.begin(), isTrusted_.end(), char(1))) < FewestNormals)
    {
      return false;
    }
    model_.place(startStep_, startBlurPx_, {});
    isEdge_ = isTrusted_;
    noise_ = LargestNoise * LargestNoise;
    for (int round = 0; round < RoundsOfSettling; ++round)
    {
      collect();
      model_.average(isTrusted_);
      if (!move(true, startInformation()))
      {
        return false;
      }
    }
    if (movedPx() > LargestMovePx)
    {
      return false;
    }
    startStep_ = model_.step();
    startBlurPx_ = std::max(model_.blurPx(), EdgeProfiles::SharpestPx);
    return true;
  }

  /// Of the outline and the blur, as well as the start knows them.
  Eigen::Matrix4d startInformation() const
  {
    Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
    for (const Eigen::Vector3d& rate : outline_.rates)
    {
      information.topLeftCorner<3, 3>() += rate * rate.transpose();
    }
    information *= double(noise_) / (StartSigmaPx * StartSigmaPx * double(outline_.rates.size()));
    information(3, 3) = double(noise_) / (StartBlurSigmaPx * StartBlurSigmaPx);
    return information;
  }

  bool fitWith(const std::vector<HidingEdge>& edges)
  {
    if (!look())
    {
      return false;
    }
    // The hiding edges alone first, in the light that is known so far: they are good to a px only.
    model_.place(startStep_, startBlurPx_, edges);
    for (int round = 0; round < RoundsOfHidingEdges && !edges.empty(); ++round)
    {
      if (!move(false))
      {
        return false;
      }
    }
    for (int round = 0; round < Rounds; ++round)
    {
      collect();
      model_.average(isEven_);
      if (!judge() || !move(true))
      {
        return false;
      }
    }
    const auto good = std::count(isEdge_.begin(), isEdge_.end(), char(1));
    return double(good) >= LeastGood * double(start_.support.size()) && movedPx() <= LargestMovePx;
  }

  EvenLightResult result() const
  {
    double seen = 0;
    for (std::size_t i = 0; i < isEdge_.size(); ++i)
    {
      seen += isEdge_[i] != 0 && !model_.isHidden(i) ? 1 : 0;
    }
    return { model_.step(), seen / double(isEdge_.size()) };
  }

  /// From where the fit started, at most along the outline.
  double movedPx() const
  {
    double most = 0;
    for (const Eigen::Vector3d& rate : outline_.rates)
    {
      most = std::max(most, std::abs(rate.dot(model_.step() - start_.step)));
    }
    return most;
  }

  /// The scatter about the model is that of noise, and the light on either side changes by no more.
  bool isEven() const
  {
    const double largest = LargestChange * (1 + FewNormals / double(isTrusted_.size()));
    return noise_ <= LargestNoise * LargestNoise && model_.change() < largest * double(tolerated());
  }

  /// That differences are judged by.
  float tolerated() const { return std::max(noise_, LeastNoise * LeastNoise); }

  /// Finds the noise, the normals across which there is something else than the ball and what is around it (near the edge, or
  /// anywhere), and the light of the others. @return false where the light is not even.
  bool judge()
  {
    OutlineScatter everywhere(isTrusted_.size()), nearEdge(isTrusted_.size());
    for (const OutlinePixel& pixel : pixels_)
    {
      const PixelDifference difference = model_.differenceOf(pixel);
      if (difference.isCounted && difference.inside * model_.blurPx() <= depthPx_)
      {
        everywhere.add(pixel.index, difference.square());
        if (difference.isWithin(BlursOfEdge))
        {
          nearEdge.add(pixel.index, difference.square());
        }
      }
    }
    std::vector<double> known = everywhere.shares(isTrusted_);
    if (known.size() < FewestNormals)
    {
      return false;
    }
    const auto nth = known.begin() + std::ptrdiff_t(CleanShare * double(known.size()));
    std::nth_element(known.begin(), nth, known.end());
    noise_ = float(*nth);
    isEven_ = everywhere.areBelow(LargestOfNormal * tolerated(), BesideWrong);
    isEdge_ = nearEdge.areBelow(LargestOfEdge * tolerated(), 0);
    model_.average(isEven_);
    if (!isEven())
    {
      return false;
    }
    model_.gather(noise_, isEven_);
    return true;
  }

  /// Whether the pixels near a hiding edge are what the model says.
  bool isRight(int edge) const
  {
    double sum = 0, count = 0;
    for (const OutlinePixel& pixel : pixels_)
    {
      const PixelDifference difference = model_.differenceOf(pixel);
      if (difference.isCounted && difference.edge == edge)
      {
        sum += double(difference.square());
        count += 3;
      }
    }
    return count > 0 && sum / count <= double(LargestOfHiding * tolerated());
  }

  /// A step of Gauss and Newton: of all, or of the hiding edges alone.
  /// @param prior what is known of outline and blur besides
  bool move(bool isOfAll, const Eigen::Matrix4d& prior = Eigen::Matrix4d::Zero())
  {
    using Model = EvenLightModel;
    const int count = model_.parameterCount();
    Model::Matrix information = Model::Matrix::Zero(count, count);
    Model::Vector right = Model::Vector::Zero(count);
    information.topLeftCorner<4, 4>() = prior;
    for (int i = Model::OfOutline; i < count; i += Model::OfEdge)
    {
      information(i, i) = double(noise_) / (EdgeSigmaPx * EdgeSigmaPx);
      information(i + 1, i + 1) = double(noise_) / (EdgeSigmaTurn * EdgeSigmaTurn);
    }
    for (const OutlinePixel& pixel : pixels_)
    {
      const PixelDifference difference = model_.differenceOf(pixel);
      const float square = isOfAll ? difference.square() / (LargestOfPixel * tolerated()) : 0;
      if (difference.isCounted && (isEdge_[pixel.index] != 0 || !isOfAll) && difference.isWithin(BlursThatCount) && square < 1)
      {
        model_.add(pixel, difference, double((1 - square) * (1 - square)), information, right);
      }
    }
    Model::Vector by = Model::Vector::Zero(count);
    if (isOfAll)
    {
      by = information.ldlt().solve(right);
    }
    else
    {
      const int ofEdges = count - Model::OfOutline;
      const Model::Matrix alone = information.bottomRightCorner(ofEdges, ofEdges);
      by.tail(ofEdges) = alone.ldlt().solve(right.tail(ofEdges));
    }
    if (!by.allFinite())
    {
      return false;
    }
    model_.move(by);
    return true;
  }

  const SphereCone::Outline& outline_;
  const EvenLightStart& start_;
  Eigen::Vector3d startStep_;
  double startBlurPx_;
  bool isSettled_ = false;  ///< the start was made better than it came
  EvenLightModel model_;
  std::vector<char> isTrusted_;  ///< normals that are even for certain, if any are
  std::vector<char> isEven_;     ///< the light across the normal is the model's
  std::vector<char> isEdge_;     ///< near the edge it is
  std::vector<OutlinePixel> pixels_;
  double depthPx_ = 0;  ///< deeper inside it is not known what may be in front of the ball
  float noise_ = 0;     ///< variance of the encoded value
};

}  // namespace

std::optional<EvenLightResult> fitInEvenLight(
  const LinearLightImage& light, const SphereCone::Outline& outline, const EvenLightStart& start)
{
  return EvenLightFitter(light, outline, start).fit();
}

}  // namespace handeye
