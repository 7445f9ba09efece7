// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CalibratedEye.h"
#include "OverlayArguments.h"
#include "OverlayPose.h"
#include "OverlayRecorder.h"
#include "PoseAge.h"
#include "PoseSmoother.h"
#include "Recording.h"
#include "ResultFiles.h"
#include "SequenceMetafileWriter.h"
#include "vtkHandEyeOverlayPipeline.h"

#include <nlohmann/json.hpp>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <memory>
#include <optional>
#include <string>

namespace handeye::cli
{

/// One eye of an overlay over a recording: its images, its lens, its hand-eye.
class OverlayEye
{
public:
  OverlayEye(const OverlayArguments& arguments, const StoredCalibration& stored, const io::Recording& recording,
    const CalibratedEye& eye, vtkPolyData* model, vtkHandEyeOverlayPipeline* pipeline);

  /// Gives the pipeline all that it needs for a frame.
  /// @param timeSec of the frame
  /// @return what became of it, for the result: `status`, `message` and what was asked for besides
  nlohmann::json set(int frame, double timeSec);

  /// ModelToCamera (nothing while the model is not drawn) and, where a stylus is shown, StylusTipToCamera.
  const OverlayTransformSet& transforms() const { return transforms_; }
  bool isDrawn() const { return isDrawn_; }

private:
  bool isInView(const Eigen::Isometry3d& modelToCamera) const;
  std::optional<Eigen::Isometry3d> fadedPose(const OverlayPose& pose, int frame, double timeSec, nlohmann::json& row);
  void setStylus(int frame);

  const OverlayArguments& arguments_;
  const io::Recording& recording_;
  CameraModel camera_;
  OverlayTransforms transformsOfRig_;
  ToolNames tools_;
  double latencySec_;
  vtkPolyData* model_;
  vtkHandEyeOverlayPipeline* pipeline_;
  std::optional<Eigen::Isometry3d> stylusTipToStylus_;
  OverlayTransformSet transforms_;
  bool isDrawn_ = false;
  PoseSmoother smoother_;
  std::optional<Eigen::Isometry3d> lastModelToCamera_;
  std::optional<double> markerSeenSec_, phantomSeenSec_, placedSec_;
};

/// Draws the model onto the frames of a recording, one PNG a frame, and a video if one was asked for.
class OverlayWriter
{
public:
  OverlayWriter(const OverlayArguments& arguments, const StoredCalibration& stored, const io::Recording& recording);

  /// @return what became of the frame, for the result
  nlohmann::json draw(int frame);

  /// Finishes the files.
  void close();

  int drawn() const { return drawn_; }

private:
  void setUpRight(const StoredCalibration& stored);
  nlohmann::json say(int frame, nlohmann::json row) const;

  const OverlayArguments& arguments_;
  const io::Recording& recording_;
  std::optional<io::Recording> right_;
  vtkSmartPointer<vtkPolyData> model_;
  vtkNew<vtkHandEyeOverlayPipeline> pipeline_;
  vtkNew<vtkHandEyeStereoOverlay> stereo_;
  std::unique_ptr<OverlayEye> leftEye_, rightEye_;
  std::unique_ptr<io::SequenceMetafileWriter> metafile_;
  std::unique_ptr<OverlayRecorder> video_;
  int drawn_ = 0;
};

}  // namespace handeye::cli
