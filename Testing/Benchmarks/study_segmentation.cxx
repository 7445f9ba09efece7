// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// How well the ball's centre is found, against the truth and against the bound that the noise of the pixels sets: apparent radius
// 6 to 200 px, 0 to 35 deg off the axis, three lenses, up to half of the outline hidden, noise of 1 to 3 grey levels. One line of
// CSV a condition on standard output; plot_segmentation.py draws it.
#include "SegmentationStudy.h"

#include <CLI/CLI.hpp>
#include <opencv2/core/utility.hpp>

#include <cstdio>
#include <exception>

namespace
{

using namespace handeye;
using namespace handeye::test;

struct Grid
{
  std::vector<std::string> lenses;
  std::vector<double> radiiPx = { 6, 9, 14, 25, 50, 100, 200 };
  std::vector<double> offAxisDeg = { 0, 12, 24, 35 };
  std::vector<double> hiddenShares = { 0, 0.25, 0.5 };
  std::vector<double> noises = { 1, 3 };
};

void printCell(const StudyCell& cell, const StudyEffort& effort, const BallDetectionOptions& options)
{
  const StudyResult result = runStudyCell(cell, effort, options);
  std::printf("%s,%g,%g,%g,%g,%d,%d,%.5f,%.5f,%.5f,%.5f,%.5f,%.5f,%.3f\n", cell.lens.c_str(), cell.radiusPx, cell.offAxisDeg,
    cell.hiddenShare, cell.noise, result.tried, result.found, result.biasPx, result.biasUncertaintyPx, result.systematicPx,
    result.spreadPx, result.boundPx, result.claimedPx, result.ratio());
  std::fflush(stdout);
}

void run(const Grid& grid, const StudyEffort& effort, const BallDetectionOptions& options)
{
  std::printf(
    "lens,radius_px,off_axis_deg,hidden_share,noise,tried,found,bias_px,bias_uncertainty_px,systematic_px,spread_px,bound_px,"
    "claimed_px,ratio\n");
  for (const std::string& lens : grid.lenses)
  {
    for (const double radiusPx : grid.radiiPx)
    {
      for (const double offAxisDeg : grid.offAxisDeg)
      {
        for (const double hiddenShare : grid.hiddenShares)
        {
          for (const double noise : grid.noises)
          {
            printCell({ lens, radiusPx, offAxisDeg, hiddenShare, noise }, effort, options);
          }
        }
      }
    }
  }
}

}  // namespace

int main(int argc, char** argv)
{
  Grid grid;
  for (const StudyLens& lens : studyLenses())
  {
    grid.lenses.push_back(lens.name);
  }
  StudyEffort effort;
  BallDetectionOptions options;
  CLI::App app("How well the ball's centre is found: CSV on standard output");
  app.add_option("--lens", grid.lenses, "Of webcam, headset, barrel");
  app.add_option("--radius", grid.radiiPx, "Apparent radii, px");
  app.add_option("--off-axis", grid.offAxisDeg, "Angles off the axis, deg");
  app.add_option("--hidden", grid.hiddenShares, "Shares of the outline that are hidden");
  app.add_option("--noise", grid.noises, "Standard deviations of the noise, grey levels");
  app.add_option("--places", effort.places, "Places of the ball against the pixels")->check(CLI::PositiveNumber);
  app.add_option("--draws", effort.draws, "Draws of noise at each place, at least 2")->check(CLI::Range(2, 10000));
  app
    .add_option(
      "--parts", effort.parts, "Parts of a pixel, in each direction, whose light is blurred by the optics; 1 blurs pixels")
    ->check(CLI::Range(1, 16));
  app.add_flag("--shaded", effort.isShaded, "A lamp from above instead of one colour all over the ball");
  app.add_option("--minimum-fill", options.minimumFill, "Least share of the disc that must have the ball's colour");
  CLI11_PARSE(app, argc, argv);
  cv::setNumThreads(1);
  try
  {
    run(grid, effort, options);
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "study_segmentation: %s\n", error.what());
    return 2;
  }
  return 0;
}
