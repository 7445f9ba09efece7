// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// A small part of the grid of study_segmentation, with its marks as limits.
#include "SegmentationStudy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>

using namespace handeye;
using namespace handeye::test;

namespace
{

constexpr double LargestBiasPx = 0.02;
/// The mark of the spread, over the bound.
constexpr double MarkOfRatio = 1.3;

struct Condition
{
  StudyCell cell;
  StudyEffort effort;
};

std::string nameOf(const ::testing::TestParamInfo<Condition>& info)
{
  const StudyCell& cell = info.param.cell;
  const auto whole = [](double value) { return std::to_string(int(std::lround(value))); };
  return cell.lens + "_" + whole(cell.radiusPx) + "px_" + whole(cell.offAxisDeg) + "deg_" + whole(100 * cell.hiddenShare) +
    "hidden_noise" + whole(cell.noise) + (info.param.effort.parts == 1 ? "_blurredPixels" : "");
}

void PrintTo(const Condition& condition, std::ostream* os)
{
  *os << nameOf({ condition, 0 });
}

class BallAccuracy : public ::testing::TestWithParam<Condition>
{
};

// The last two blur the pixels in place of the light, as many renderers do.
// Fewer places where there are more pixels: the grid matters less, and the pictures are larger.
INSTANTIATE_TEST_SUITE_P(Grid, BallAccuracy,
  ::testing::Values(Condition{ { "webcam", 6, 0, 0, 1 }, { 12, 8, false } },
    Condition{ { "headset", 6, 35, 0, 3 }, { 12, 8, false } }, Condition{ { "barrel", 14, 24, 0, 2 }, { 10, 8, false } },
    Condition{ { "webcam", 6, 12, 0.25, 3 }, { 12, 8, false } }, Condition{ { "headset", 6, 12, 0.5, 1 }, { 12, 8, false } },
    Condition{ { "barrel", 6, 24, 0.5, 3 }, { 12, 8, false } }, Condition{ { "webcam", 9, 12, 0.25, 1 }, { 12, 8, false } },
    Condition{ { "headset", 9, 24, 0.5, 1 }, { 12, 8, false } }, Condition{ { "webcam", 14, 12, 0.25, 1 }, { 10, 8, false } },
    Condition{ { "headset", 30, 35, 0, 1 }, { 8, 8, false } }, Condition{ { "barrel", 30, 0, 0.5, 1 }, { 8, 8, false } },
    Condition{ { "webcam", 60, 24, 0.5, 3 }, { 6, 8, false } }, Condition{ { "headset", 120, 12, 0.25, 2 }, { 4, 12, false } },
    Condition{ { "barrel", 200, 35, 0, 1 }, { 3, 16, false } }, Condition{ { "webcam", 14, 24, 0.25, 1 }, { 10, 8, false, 1 } },
    Condition{ { "headset", 30, 0, 0.5, 1 }, { 8, 8, false, 1 } }),
  nameOf);

}  // namespace

TEST_P(BallAccuracy, BiasAndSpread_AreWithinTheMarks)
{
  const StudyResult result = runStudyCell(GetParam().cell, GetParam().effort);
  std::printf("bias %.4f +- %.4f px, spread %.4f px, bound %.4f px, ratio %.2f, claimed %.4f px, found %d of %d\n", result.biasPx,
    result.biasUncertaintyPx, result.spreadPx, result.boundPx, result.ratio(), result.claimedPx, result.found, result.tried);
  ASSERT_EQ(result.found, result.tried);
  EXPECT_LT(result.biasPx, LargestBiasPx);
  // The spread of n errors is itself known to one part in sqrt(2 n), each of two coordinates: three times that is granted.
  const double granted = 1 + 3 / std::sqrt(4.0 * result.tried);
  EXPECT_LT(result.ratio(), MarkOfRatio * granted);
  EXPECT_GT(result.ratio(), 1 / granted) << "nothing unbiased is better than the bound: the study is wrong";
  EXPECT_GT(result.claimedPx, 0.8 * result.spreadPx) << "the detection claims to be better than it is";
}

TEST(SegmentationStudy, Bound_GoesWithTheNoiseAndWithWhatIsSeen)
{
  const StudyEffort effort;
  const double whole = studyBound({ "webcam", 30, 12, 0, 1 }, effort);
  const double noisy = studyBound({ "webcam", 30, 12, 0, 3 }, effort);
  const double hidden = studyBound({ "webcam", 30, 12, 0.5, 1 }, effort);
  const double larger = studyBound({ "webcam", 120, 12, 0, 1 }, effort);
  EXPECT_NEAR(noisy / whole, std::sqrt((9 + 1.0 / 12) / (1 + 1.0 / 12)), 1e-9);
  EXPECT_GT(hidden, 1.5 * whole);
  EXPECT_NEAR(larger / whole, 0.5, 0.05) << "four times the outline, half the error";
}

TEST(SegmentationStudy, Bound_AgreesWithTheTextbookOnAStraightEdge)
{
  // On the axis, not hidden: with c the contrast's square summed over the channels and the edge a Gaussian's integral in grey
  // levels (nearly so: the encoding bends it), a pixel's length of outline gives the information c / (2 sqrt(pi) blur sigma^2)
  // along its normal.
  const StudyEffort effort;
  const double noise = 2, blurPx = std::sqrt(0.7 * 0.7 + 1.0 / 12), radiusPx = 50;
  double contrast = 0;
  for (const auto& [inside, outside] : { std::pair(39.0, 129.0), std::pair(33.4, 134.2), std::pair(195.0, 131.6) })
  {
    contrast += (inside - outside) * (inside - outside);
  }
  const double perPixel = contrast / (2 * std::sqrt(double(EIGEN_PI)) * blurPx * (noise * noise + 1.0 / 12));
  const double information = perPixel * double(EIGEN_PI) * radiusPx;  // half of the outline's length counts for each coordinate
  const double bound = studyBound({ "webcam", radiusPx, 0, 0, noise }, effort);
  EXPECT_NEAR(bound * std::sqrt(information), 1, 0.12);
}

TEST(SegmentationStudy, WrongCells_ThrowASentence)
{
  EXPECT_THROW((void)studyBound({ "fish eye", 30, 0, 0, 1 }, {}), std::invalid_argument);
  EXPECT_THROW((void)studyBound({ "webcam", 200, 80, 0, 1 }, {}), std::invalid_argument);
}
