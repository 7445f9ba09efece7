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

#include <array>
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

  /// What the model is drawn from, undivided; without a mesh it is made of the model when it is needed.
  void SetBaseMesh(const handeye::OverlayMesh& mesh);

  /// Covariance (px^2) of where the middle of the model is seen; nothing if it is not known.
  std::optional<Eigen::Matrix2d> ErrorCovariancePx() const;

  bool LensIsNew = true;
  bool ErrorIsNew = true;  ///< covariance, lens or way with the lens

private:
  void UpdateLens();
  void UpdateMesh();
  void UpdateStylus();
  void UpdateError();

  /// The lens of the picture as it is shown: none where it is straightened.
  handeye::CameraModel ShownCamera() const;
  double PreparedDistanceMm() const;
  vtkMTimeType ModelTime() const;

  vtkMTimeType MeshTime = 0;
  bool ErrorIsStraight = false;                   ///< the error's field is that of a straightened picture
  handeye::OverlayMesh BaseMesh;                  ///< not divided
  std::map<double, handeye::OverlayMesh> Meshes;  ///< divided, by the longest edge that was asked for
};

namespace handeye
{

/// Copies a picture (8 bits; grey, BGR or BGRA; top row first) into an image with the bottom row first. Colours become RGBA: four
/// bytes a pixel go to the graphics card as they are, three are divided up by its driver, which costs more than all else here.
/// @throws std::invalid_argument for another type of picture
void copyFlipped(const cv::Mat& bgr, vtkImageData* image);

/// Reads a part of a window's picture (x, y from the lower left corner, width, height; device px), top row first, BGR.
void readPixels(vtkRenderWindow* window, vtkUnsignedCharArray* pixels, const std::array<int, 4>& rectangle, cv::Mat& bgr);

/// Reads what a scene's window shows of it, in this size (px); in the window's where it is 0.
/// @return false if nothing was rendered yet
bool readShown(vtkHandEyeOverlayScene* scene, const std::array<int, 2>& size, vtkUnsignedCharArray* pixels, cv::Mat& bgr);

}  // namespace handeye
