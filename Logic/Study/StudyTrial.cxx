// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "StudyTrial.h"

#include "PivotCalibration.h"
#include "StudyPlaces.h"

#include <cmath>
#include <stdexcept>

namespace handeye::study
{

namespace
{

constexpr double Degree = EIGEN_PI / 180;
const Eigen::Vector3d Tip_Stylus(-1.9, 0.4, 186.4);

/// Makes one repetition, drawing from one stream of random numbers.
class TrialMaker
{
public:
  TrialMaker(const StudyCamera& camera, const StudyEye& eye, const StudyNoise& noise, const TrialSize& size, unsigned seed,
    const StudyPictures* pictures)
    : camera_(camera)
    , eye_(eye)
    , noise_(noise)
    , size_(size)
    , pictures_(pictures)
    , random_(seed)
    , attitude_Camera_(random_.rotation())
    , lens_(drawLens())
    , boardScale_(1 + random_.normal(noise.boardScaleShare))
  {
  }

  StudyTrial make()
  {
    StudyTrial trial{ lens_, {}, {}, {}, {}, Eigen::Matrix3d::Zero() };
    calibrateTip(trial);
    for (int i = 0; i < size_.ballSamples; ++i)
    {
      addBall(i, trial.ball.samples, nullptr, pictures_ != nullptr ? &trial.ball.publishedSamples : nullptr);
    }
    addBoardViews(trial.board);
    for (int i = 0; i < size_.validationSamples; ++i)
    {
      addBall(i, trial.validation, &trial.trueValidation, nullptr);
    }
    return trial;
  }

private:
  /// The lens as its calibration would have found it.
  CameraModel drawLens()
  {
    Eigen::Matrix3d matrix = eye_.camera.cameraMatrix();
    const double focal = random_.normal(noise_.lensFocalShare);
    const Eigen::Vector2d center = random_.normal2(noise_.lensCenterPx);
    matrix.topLeftCorner<2, 2>() *= 1 + focal;
    matrix.topRightCorner<2, 1>() += center;
    return CameraModel(eye_.camera.width(), eye_.camera.height(), matrix, eye_.camera.distortionCoefficients());
  }

  /// A pose as the tracker reports it, with so much of its noise.
  Eigen::Isometry3d tracked(const Eigen::Isometry3d& pose, double share = 1)
  {
    Eigen::Isometry3d reported = pose;
    reported.linear() = pose.linear() * rotationFromVector(random_.normal3(share * noise_.trackingSigmaRad));
    reported.translation() += random_.normal3(share * noise_.trackingSigmaMm);
    return reported;
  }

  /// A rotation by up to this angle about any axis.
  Eigen::Matrix3d turned(double upToRad)
  {
    const Eigen::Vector3d axis = random_.normal3(1).normalized();
    return rotationFromVector(random_.uniform(0, upToRad) * axis);
  }

  Eigen::Isometry3d anyPose()
  {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = random_.rotation();
    pose.translation() = Eigen::Vector3d(0, 0, -1200) + random_.normal3(100);
    return pose;
  }

  void calibrateTip(StudyTrial& trial)
  {
    const Eigen::Vector3d pivot_Tracker(20, -70, -1300);
    std::vector<Eigen::Isometry3d> poses;
    for (int i = 0; i < size_.pivotPoses; ++i)
    {
      Eigen::Isometry3d stylusToTracker = Eigen::Isometry3d::Identity();
      stylusToTracker.linear() = turned(45 * Degree);
      stylusToTracker.translation() = pivot_Tracker - stylusToTracker.linear() * Tip_Stylus;
      poses.push_back(tracked(stylusToTracker));
    }
    const PivotCalibrationResult pivot = calibratePivot(poses);
    if (!pivot.isUsable())
    {
      throw std::runtime_error("the study's stylus cannot be calibrated: " + pivot.message);
    }
    tip_Stylus_ = pivot.tip_Stylus;
    trial.tipCovariance_Stylus = pivot.tipCovariance;
  }

  /// The ball as seen: found in a picture, or projected with noise. @return false where it is not found
  bool seeBall(const Eigen::Vector3d& ball_Camera, BallDetectionOptions::Method method, HandEyeSample& sample)
  {
    if (pictures_ != nullptr)
    {
      const BallDetection found = pictures_->findBall(ball_Camera, method, pictureSeed_);
      sample.ball_Image = found.ball_Image;
      // Found with the true lens, looked at with the one that the methods are told.
      sample.ray_Eye = found.isFound() ? lens_.unproject(found.ball_Image).ray_Camera : found.ray_Camera;
      sample.apparentDistanceMm = found.distanceMm;
      sample.sigmaPx = std::sqrt(found.covariance_Image.trace() / 2);
      return found.isFound();
    }
    sample.ball_Image = eye_.camera.project(ball_Camera).point_Image + random_.normal2(noise_.ballSigmaPx);
    sample.ray_Eye = lens_.unproject(sample.ball_Image).ray_Camera;
    sample.apparentDistanceMm = ball_Camera.norm();
    sample.sigmaPx = noise_.ballSigmaPx;
    return true;
  }

  void addBall(int frame, std::vector<HandEyeSample>& samples, std::vector<HandEyeSample>* trueSamples,
    std::vector<HandEyeSample>* publishedSamples)
  {
    const Eigen::Vector3d ball_Camera = drawBallPlace(camera_, eye_, random_);
    const Eigen::Vector3d ball_Marker = eye_.markerToCamera.inverse() * ball_Camera;
    const Eigen::Isometry3d markerToTracker = anyPose();
    Eigen::Isometry3d stylusToTracker = Eigen::Isometry3d::Identity();
    // A hand holds the stylus much the same way all the time, as seen from the camera.
    const Eigen::Matrix3d stylusToCamera = attitude_Camera_ * turned(35 * Degree);
    const Eigen::Matrix3d stylusToMarker = eye_.markerToCamera.linear().transpose() * stylusToCamera;
    stylusToTracker.linear() = markerToTracker.linear() * stylusToMarker;
    stylusToTracker.translation() = markerToTracker * ball_Marker - stylusToTracker.linear() * Tip_Stylus;
    const Eigen::Isometry3d trackerToMarker = tracked(markerToTracker).inverse();
    const Eigen::Isometry3d stylusReported = tracked(stylusToTracker, trueSamples == nullptr ? noise_.stylusShare : 1);
    HandEyeSample sample;
    sample.frame = frame;
    sample.tip_Marker = trackerToMarker * (stylusReported * tip_Stylus_);
    sample.stylusToMarker = trackerToMarker.linear() * stylusReported.linear();
    pictureSeed_ = random_.seed();
    if (publishedSamples != nullptr)
    {
      HandEyeSample published = sample;
      if (seeBall(ball_Camera, BallDetectionOptions::Method::Hough, published))
      {
        publishedSamples->push_back(published);
      }
    }
    if (!seeBall(ball_Camera, BallDetectionOptions::Method::Exact, sample))
    {
      return;
    }
    samples.push_back(sample);
    if (trueSamples != nullptr)
    {
      sample.tip_Marker = ball_Marker;
      sample.ball_Image = eye_.camera.project(ball_Camera).point_Image;
      sample.ray_Eye = lens_.unproject(sample.ball_Image).ray_Camera;
      trueSamples->push_back(sample);
    }
  }

  /// @return false where the board is not found
  bool seeBoard(const Eigen::Isometry3d& boardToCamera, BoardHandEyeView& view)
  {
    if (pictures_ != nullptr)
    {
      // A board that is printed larger looks like one of the right size that is nearer by the same ratio.
      Eigen::Isometry3d drawnToCamera = boardToCamera;
      drawnToCamera.translation() /= boardScale_;
      const BoardDetection found = pictures_->findBoard(drawnToCamera, random_.seed());
      view.ids = found.ids;
      view.points_Board = found.points_Board;
      view.points_Image = found.points_Image;
      return found.isUsable();
    }
    view.points_Board = boardPoints(camera_.board);
    for (std::size_t i = 0; i < view.points_Board.size(); ++i)
    {
      const Eigen::Vector3d point_Camera = boardToCamera * (boardScale_ * view.points_Board[i]);
      view.ids.push_back(int(i));
      view.points_Image.push_back(eye_.camera.project(point_Camera).point_Image + random_.normal2(noise_.cornerSigmaPx));
    }
    return true;
  }

  void addBoardViews(std::vector<BoardHandEyeView>& views)
  {
    const Eigen::Isometry3d boardToTracker = anyPose();
    for (int i = 0; i < size_.boardViews; ++i)
    {
      const Eigen::Isometry3d boardToCamera =
        drawBoardPose(camera_, eye_, size_.boardTiltDeg * Degree, size_.boardRollDeg * Degree, random_);
      const Eigen::Isometry3d boardToMarker = eye_.markerToCamera.inverse() * boardToCamera;
      BoardHandEyeView view;
      view.frame = i;
      view.markerToTracker = tracked(boardToTracker * boardToMarker.inverse());
      view.boardToTracker = tracked(boardToTracker);
      if (seeBoard(boardToCamera, view))
      {
        views.push_back(std::move(view));
      }
    }
  }

  const StudyCamera& camera_;
  const StudyEye& eye_;
  const StudyNoise& noise_;
  const TrialSize& size_;
  const StudyPictures* pictures_;
  StudyRandom random_;
  Eigen::Matrix3d attitude_Camera_;
  CameraModel lens_;
  double boardScale_ = 1;  ///< of the print, over what the methods are told
  Eigen::Vector3d tip_Stylus_ = Tip_Stylus;
  unsigned pictureSeed_ = 0;
};

}  // namespace

StudyTrial makeTrial(const StudyCamera& camera, const StudyEye& eye, const StudyNoise& noise, const TrialSize& size, unsigned seed,
  const StudyPictures* pictures)
{
  return TrialMaker(camera, eye, noise, size, seed, pictures).make();
}

}  // namespace handeye::study
