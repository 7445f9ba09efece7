// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "OverlayMesh.h"
#include "vtkHandEyeOverlayPipeline.h"
#include "vtkHandEyeOverlayScene.h"

#include <vtkImageData.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkRenderWindow.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>

#include <map>
#include <optional>
#include <string>

/// Private to vtkHandEyeOverlayPipeline.
class vtkHandEyeOverlayPipeline::Internals
{
public:
  vtkHandEyeOverlayState State;
  std::optional<handeye::CameraModel> Camera;  ///< as set
  vtkSmartPointer<vtkPolyData> Model;          ///< as set
  vtkNew<vtkImageData> Frame;                  ///< for SetVideoFrame()
  handeye::StylusShape StylusShape;
  std::optional<Eigen::Matrix<double, 6, 6>> Covariance;
  double NearestDistanceMm = 50;
  double LongestEdgeMm = 0;   ///< of the mesh that is drawn
  double MeshDistanceMm = 0;  ///< for which it was prepared: a power of two times the nearest distance, no further than the model
  std::string Problem;

  vtkNew<vtkHandEyeOverlayScene> WindowScene;
  vtkNew<vtkHandEyeOverlayScene> ImageScene;
  vtkSmartPointer<vtkRenderWindow> ImageWindow;
  vtkNew<vtkUnsignedCharArray> Pixels;

  /// Brings the state up to date with what was set since.
  const vtkHandEyeOverlayState& Update();
  void Render(int width, int height, cv::Mat& bgr);

  /// Covariance (px^2) of where the middle of the model is seen; nothing if it is not known.
  std::optional<Eigen::Matrix2d> ErrorCovariancePx() const;

  bool LensIsNew = true;

private:
  void UpdateLens();
  void UpdateMesh();
  void UpdateStylus();
  void UpdateError();

  double PreparedDistanceMm() const;

  vtkMTimeType MeshTime = 0;
  handeye::OverlayMesh BaseMesh;                  ///< not divided
  std::map<double, handeye::OverlayMesh> Meshes;  ///< divided, by the longest edge that was asked for
};

namespace handeye
{

/// Copies a picture (8 bits; grey, BGR or BGRA; top row first) into an image with the bottom row first. The colours' order is kept
/// where it is BGR; others become RGB.
/// @return whether it is BGR
/// @throws std::invalid_argument for another type of picture
bool copyFlipped(const cv::Mat& bgr, vtkImageData* image);

/// Reads a window's picture, top row first, BGR.
void readPixels(vtkRenderWindow* window, vtkUnsignedCharArray* pixels, int width, int height, cv::Mat& bgr);

}  // namespace handeye
