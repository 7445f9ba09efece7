// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CameraModel.h"
#include "OverlayLook.h"
#include "OverlayStylus.h"
#include "vtkSlicerHandEyeCalibrationModuleLogicExport.h"

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vtkObject.h>

#include <memory>
#include <optional>
#include <string>

namespace handeye
{
struct OverlayMesh;
}

class vtkHandEyeOverlayScene;
class vtkImageData;
class vtkMatrix4x4;
class vtkPolyData;
class vtkRenderer;
class vtkRenderWindow;

/// Draws a mesh on a live video where the camera would see it: the augmented view of the navigation, on screen or into a picture.
///
/// Two ways with the lens (OverlayLook::undistorted). Raw: the video is shown as the camera records it, and the mesh is bent as the
/// lens bends light. Undistorted: the graphics card straightens the video, to what a pinhole camera with the same focal lengths,
/// principal point and size would see, and the mesh is drawn plainly. Either way both fit over the whole picture, at any depth. In
/// a window of any size the picture is letterboxed (centred, never stretched), and
/// video and mesh stay registered through every resize and device pixel ratio. Away from what is drawn, no pixel of the raw video
/// is changed.
///
///     p_Camera = modelToCamera * p_Model        then as CameraModel projects it; Camera: x right, y down, z forward; mm
///
/// Long edges are divided until the largest error of drawing them straight is below 0.05 px at the model's distance
/// (GetEdgeErrorPx), or at the nearest one that is worked at (SetNearestDistanceMm) where it is nearer. The model is not drawn
/// where the lens model cannot be believed (CameraModel::maximumRadius()), nor while the video's size is not the camera's;
/// GetProblem() then says why.
///
/// Setters take effect at the next rendering; none renders. All calls belong to the thread that renders.
class VTK_SLICER_HANDEYECALIBRATION_MODULE_LOGIC_EXPORT vtkHandEyeOverlayPipeline : public vtkObject
{
public:
  static vtkHandEyeOverlayPipeline* New();
  vtkTypeMacro(vtkHandEyeOverlayPipeline, vtkObject)
  void PrintSelf(std::ostream& os, vtkIndent indent) override;

  /// The lens. A camera without an image size takes that of the video.
  void SetCameraModel(const handeye::CameraModel& camera);

  /// A frame of the video (8 bits; grey, BGR or BGRA; top row first); copied. An empty frame takes the video away.
  /// @throws std::invalid_argument for another type of picture
  void SetVideoFrame(const cv::Mat& bgr);

  /// The same from a VTK image (8 bits; 1, 3 or 4 components; bottom row first); shared, not copied: call Modified() on it when its
  /// pixels change. Null takes the video away.
  void SetVideoImage(vtkImageData* image);

  /// The mesh, mm; shared, not copied, not changed. Null takes the model away. @sa handeye::readMesh()
  void SetModel(vtkPolyData* model);
  /// The same of what handeye::prepareOverlayMesh() made of it, in another thread for instance: it is not made here again. (Long edges
  /// are still divided at the first rendering, for this lens.)
  void SetPreparedModel(const handeye::OverlayMesh& model);
  vtkPolyData* GetModel();

  /// Where the mesh is: p_Camera = modelToCamera * p_Model, mm, affine; copied. The identity until set.
  /// @throws std::invalid_argument if it is null or not finite
  void SetModelToCamera(vtkMatrix4x4* modelToCamera);

  /// How it looks; @throws std::invalid_argument as OverlayLook::check() does
  void SetLook(const handeye::OverlayLook& look);
  const handeye::OverlayLook& GetLook();

  /// Does what handeye::overlayKeys() says of a key; the look and the opacity change. @return false for a key without a meaning
  bool HandleKey(char key);

  /// The whole overlay over the video, 1 (all there) to 0 (gone): a model whose pose is old fades. @sa handeye::judgePoseAge()
  void SetFade(double fade);
  double GetFade();

  /// A sentence in the picture, for the person in front of it: which tool is not seen. Empty: none.
  void SetNotice(const std::string& notice);
  std::string GetNotice();

  /// Covariance of the hand-eye calibration (rotation vector rad, translation mm; `Camera` frame), for the halo; nothing: not
  /// known.
  /// @throws std::invalid_argument if a number is not finite
  void SetCalibrationCovariance(const std::optional<Eigen::Matrix<double, 6, 6>>& covariance);

  /// The error (px of the picture, root mean square of both directions) that the covariance predicts in the model's middle; nothing
  /// without a covariance, or where the middle is not in view of the lens model.
  std::optional<double> GetPredictedErrorPx();

  /// What the stylus looks like; @throws std::invalid_argument as StylusShape::check() does
  void SetStylusShape(const handeye::StylusShape& shape);

  /// Where the stylus is: p_Camera = stylusTipToCamera * p_StylusTip, mm; copied. Null: it is not seen, nothing of it is shown.
  /// @throws std::invalid_argument if it is not finite
  void SetStylusTipToCamera(vtkMatrix4x4* stylusTipToCamera);

  void SetModelVisible(bool visible);
  bool GetModelVisible();

  /// 0 (not seen) to 1; 0.65 until set. Only the foremost surface is seen, at any opacity.
  void SetModelOpacity(double opacity);
  double GetModelOpacity();

  /// Red, green, blue, 0 to 1; the ivory of bone until set.
  void SetModelColor(double red, double green, double blue);

  /// White where the model is and black elsewhere, whatever its opacity; no video. In RenderToImage() every pixel is one or the
  /// other: white if its centre is covered.
  void SetMaskMode(bool mask);
  bool GetMaskMode();

  /// The nearest distance at which the model is worked with; 50 mm until set.
  void SetNearestDistanceMm(double distance);
  double GetNearestDistanceMm();

  /// By how many pixels an edge of the model is drawn too straight where it is, but at the nearest distance if it is nearer, at
  /// most; 0 without a lens or a model.
  double GetEdgeErrorPx();

  /// Why the model is not drawn, as a sentence for the person in front of the screen; empty if it is (or is hidden on purpose).
  std::string GetProblem();

  /// Shows the overlay in this window, from its next rendering on; null takes it out. Layers 0 to 2 of the window belong to the
  /// pipeline then. The window is not kept alive.
  void AttachTo(vtkRenderWindow* window);

  /// For props of one's own over the video: this renderer's camera is the video's pinhole part, in the `Camera` frame; a mesh shown
  /// with a vtkHandEyeLensMapper also gets the lens.
  vtkRenderer* GetModelRenderer();

  /// Between pixels of the attached window (device px from the lower left corner; whole numbers are pixel centres) and of the
  /// recorded video (from the upper left corner; also while it is shown undistorted), as last rendered.
  /// @return false if nothing was rendered yet, or for a place that the lens model does not reach
  bool DisplayToImage(const double point_Display[2], double point_Image[2]);
  bool ImageToDisplay(const double point_Image[2], double point_Display[2]);

  /// Renders the overlay in the video's own size, apart from any window attached; anti-aliased unless it is a mask.
  /// @param bgr receives the picture, 8 bits, top row first
  /// @throws std::runtime_error with GetProblem()'s sentence if a visible model cannot be drawn, or if no size is known
  void RenderToImage(cv::Mat& bgr);

  /// Reads the picture that the attached window shows since its last rendering, without the bars beside it, brought to the
  /// video's own size: a pixel of the picture is a pixel of the video, whatever the window's size.
  /// @param bgr receives the picture, 8 bits, top row first
  /// @return false if nothing was rendered yet
  bool ReadShown(cv::Mat& bgr);

protected:
  vtkHandEyeOverlayPipeline();
  ~vtkHandEyeOverlayPipeline() override;

private:
  vtkHandEyeOverlayPipeline(const vtkHandEyeOverlayPipeline&) = delete;
  void operator=(const vtkHandEyeOverlayPipeline&) = delete;

  friend class vtkHandEyeStereoOverlay;
  void ConnectScene(vtkHandEyeOverlayScene* scene);

  class Internals;
  std::unique_ptr<Internals> Internal;
};
