// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "StudyPictures.h"

#include "BallDetector.h"
#include "BoardPicture.h"
#include "SphereRenderer.h"
#include "StudyPlaces.h"

#include <cmath>

namespace handeye::study
{

namespace
{

constexpr double BlurPx = 0.7, SensorNoise = 1.5;

simulation::Photograph photograph(unsigned seed)
{
  simulation::Photograph how;
  how.blurPx = BlurPx;
  how.noise = SensorNoise;
  how.seed = seed;
  return how;
}

}  // namespace

struct StudyPictures::Parts
{
  StudyCamera camera;
  CameraModel lens;
  simulation::RayTable rays;
  simulation::BoardPicture board;
};

StudyPictures::StudyPictures(const StudyCamera& camera, const StudyEye& eye)
  : parts_(new Parts{ camera, eye.camera, simulation::RayTable(eye.camera), { camera.board, eye.camera } })
{
}

StudyPictures::~StudyPictures() = default;

BallDetection StudyPictures::findBall(const Eigen::Vector3d& ball_Camera, BallDetectionOptions::Method method, unsigned seed) const
{
  simulation::RenderedBall ball;
  ball.center_Camera = ball_Camera;
  ball.radiusMm = parts_->camera.ballRadiusMm;
  ball.isShaded = true;
  const cv::Mat picture =
    simulation::SphereScene(parts_->lens, simulation::TableGrey, &parts_->rays).add(ball).photograph(photograph(seed));
  BallDetectionOptions options;
  options.method = method;
  return detectBall(picture, parts_->lens, parts_->camera.ballRadiusMm, options);
}

BoardDetection StudyPictures::findBoard(const Eigen::Isometry3d& boardToCamera, unsigned seed) const
{
  return detectBoard(parts_->board.take(boardToCamera, photograph(seed)), parts_->camera.board);
}

FeatureNoise measureFeatureNoise(
  const StudyCamera& camera, const StudyEye& eye, const StudyPictures& pictures, int pictureCount, unsigned seed)
{
  FeatureNoise noise;
  StudyRandom random(seed);
  double ballSquares = 0, cornerSquares = 0;
  for (int i = 0; i < pictureCount; ++i)
  {
    const Eigen::Vector3d ball_Camera = drawBallPlace(camera, eye, random);
    const BallDetection ball = pictures.findBall(ball_Camera, BallDetectionOptions::Method::Exact, random.seed());
    ++noise.balls;
    if (ball.isFound())
    {
      ++noise.ballsFound;
      ballSquares += (ball.ball_Image - eye.camera.project(ball_Camera).point_Image).squaredNorm();
    }
    const Eigen::Isometry3d boardToCamera = drawBoardPose(camera, eye, random);
    const BoardDetection board = pictures.findBoard(boardToCamera, random.seed());
    ++noise.boards;
    noise.boardsFound += board.isUsable() ? 1 : 0;
    for (std::size_t k = 0; board.isUsable() && k < board.ids.size(); ++k)
    {
      const Eigen::Vector3d corner_Camera = boardToCamera * board.points_Board[k];
      cornerSquares += (board.points_Image[k] - eye.camera.project(corner_Camera).point_Image).squaredNorm();
      ++noise.corners;
    }
  }
  noise.ballSigmaPx = noise.ballsFound > 0 ? std::sqrt(ballSquares / (2 * noise.ballsFound)) : 0;
  noise.cornerSigmaPx = noise.corners > 0 ? std::sqrt(cornerSquares / (2 * noise.corners)) : 0;
  return noise;
}

}  // namespace handeye::study
