// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CameraModel.h"
#include "LensWarp.h"

#include <vtkNew.h>
#include <vtkObject.h>
#include <vtkSmartPointer.h>
#include <vtkWeakPointer.h>

#include <array>
#include <functional>
#include <optional>

class vtkActor;
class vtkHandEyeLensMapper;
class vtkImageData;
class vtkMatrix4x4;
class vtkPolyData;
class vtkRenderer;
class vtkRenderWindow;
class vtkTexture;

/// What an overlay shows, the same in every window that shows it.
struct vtkHandEyeOverlayState
{
  std::optional<handeye::CameraModel> Camera;  ///< with an image size; empty if no model can be drawn
  handeye::LensWarp Warp;
  std::array<int, 2> ImageSize{ 0, 0 };  ///< px; 0 if neither a frame nor a camera is known
  vtkSmartPointer<vtkImageData> Video;   ///< null: nothing but the model
  vtkSmartPointer<vtkPolyData> Mesh;     ///< null: nothing but the video
  vtkNew<vtkMatrix4x4> ModelToCamera;
  std::array<double, 3> Color{};
  double Opacity = 1;
  bool ModelVisible = true;
  bool MaskMode = false;
};

/// Private to vtkHandEyeOverlayPipeline: the renderers and props that show a vtkHandEyeOverlayState in one window.
///
/// Three layers: the bars beside the picture (whole window), the video and the model (both in the picture's letterboxed viewport).
/// The scene asks for the state whenever its window renders, so that size, device pixel ratio and data are always those of that
/// moment.
class vtkHandEyeOverlayScene : public vtkObject
{
public:
  static vtkHandEyeOverlayScene* New();
  vtkTypeMacro(vtkHandEyeOverlayScene, vtkObject)

  /// Where the scene gets what it shows, at each rendering.
  void SetStateSource(std::function<const vtkHandEyeOverlayState&()> source);

  /// Adds the renderers to a window and takes them out of the one before; null only takes them out.
  void AttachTo(vtkRenderWindow* window);
  vtkRenderWindow* GetRenderWindow();

  vtkRenderer* GetVideoRenderer() { return this->VideoRenderer; }
  vtkRenderer* GetModelRenderer() { return this->ModelRenderer; }

  /// The picture's place in its window: x, y (of the lower left corner), width, height in device px, as last rendered.
  const std::array<int, 4>& GetPictureRectangle() const { return this->PictureRectangle; }

  /// The largest rectangle of the picture's aspect in a window, centred, on whole pixels.
  static std::array<int, 4> Letterbox(const std::array<int, 2>& imageSize, const int windowSize[2]);

protected:
  vtkHandEyeOverlayScene();
  ~vtkHandEyeOverlayScene() override;

private:
  vtkHandEyeOverlayScene(const vtkHandEyeOverlayScene&) = delete;
  void operator=(const vtkHandEyeOverlayScene&) = delete;

  void SetUpVideo();
  void SetUpModel();
  void Synchronize();
  void SynchronizeViewports(const vtkHandEyeOverlayState& state);
  void SynchronizeVideo(const vtkHandEyeOverlayState& state);
  void SynchronizeCamera(const vtkHandEyeOverlayState& state);
  void SynchronizeModel(const vtkHandEyeOverlayState& state);
  void SynchronizeAppearance(const vtkHandEyeOverlayState& state);

  std::function<const vtkHandEyeOverlayState&()> StateSource;
  vtkWeakPointer<vtkRenderWindow> Window;
  std::array<int, 4> PictureRectangle{ 0, 0, 0, 0 };
  vtkNew<vtkRenderer> BarsRenderer;
  vtkNew<vtkRenderer> VideoRenderer;
  vtkNew<vtkRenderer> ModelRenderer;
  vtkNew<vtkTexture> VideoTexture;
  vtkNew<vtkActor> VideoActor;
  vtkNew<vtkHandEyeLensMapper> DepthMapper;
  vtkNew<vtkHandEyeLensMapper> ModelMapper;
  vtkNew<vtkActor> DepthActor;
  vtkNew<vtkActor> ModelActor;
};
