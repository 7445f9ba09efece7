// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CameraModel.h"
#include "HandEyeErrorField.h"
#include "LensAppearance.h"
#include "LensWarp.h"
#include "OverlayLook.h"

#include <vtkNew.h>
#include <vtkObject.h>
#include <vtkSmartPointer.h>
#include <vtkWeakPointer.h>

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>

class vtkActor;
class vtkHandEyeLensMapper;
class vtkHandEyeOutlinePass;
class vtkHandEyeVideoMapper;
class vtkImageData;
class vtkMatrix4x4;
class vtkPolyData;
class vtkRenderer;
class vtkRenderWindow;
class vtkTextActor;
class vtkTexture;

/// What an overlay shows, the same in every window that shows it.
struct vtkHandEyeOverlayState
{
  std::optional<handeye::CameraModel> Camera;    ///< with an image size; empty if no model can be drawn
  handeye::LensWarp Lens;                        ///< of the camera
  std::array<int, 2> ImageSize{ 0, 0 };          ///< px; 0 if neither a frame nor a camera is known
  vtkSmartPointer<vtkImageData> Video;           ///< null: nothing but the model
  vtkSmartPointer<vtkPolyData> RawMesh;          ///< makeRawVideoMesh()
  vtkSmartPointer<vtkPolyData> UndistortedMesh;  ///< makeUndistortedVideoMesh(); null until needed
  vtkSmartPointer<vtkPolyData> Mesh;             ///< null: nothing but the video
  bool MeshIsClosed = false;                     ///< its inside cannot be seen from outside
  vtkNew<vtkMatrix4x4> ModelToCamera;
  std::array<double, 3> Color{};
  double Opacity = 1;
  double Fade = 1;  ///< of all that is drawn over the video
  bool ModelVisible = true;
  bool MaskMode = false;
  handeye::OverlayLook Look;
  vtkSmartPointer<vtkPolyData> StylusBody, StylusRay, StylusTip;
  vtkSmartPointer<vtkMatrix4x4> StylusTipToCamera;  ///< null: the stylus is not known
  /// What the calibration predicts for each place of the picture as it is shown; null: not known.
  std::shared_ptr<const handeye::HandEyeErrorField> ErrorField;
  std::optional<std::array<double, 2>> ErrorAxes_Px;  ///< half axes of 95 % of the error in the model's middle, if that is in view
  std::string Notice;                                 ///< written into the picture; may be empty
};

/// Private to vtkHandEyeOverlayPipeline: the renderers and props that show a vtkHandEyeOverlayState in one window.
///
/// Three layers: the bars beside the picture (the scene's part of the window), the video and the model (both in the picture's
/// letterboxed viewport). The scene asks for the state whenever its window renders, so that size, device pixel ratio and data are
/// always those of that moment.
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

  vtkRenderer* GetModelRenderer() { return this->ModelRenderer; }

  /// The scene's part of its window: x, y, width, height as shares; all of it until set.
  void SetArea(const std::array<double, 4>& area) { this->Area = area; }

  /// The picture is drawn this much narrower and lower than it is, for displays that widen it again.
  void SetSqueeze(const std::array<double, 2>& squeeze) { this->Squeeze = squeeze; }

  /// Which of two eyes it is: nothing special until set. Rows alternate by the window's.
  enum class Eye
  {
    Both,
    LeftRows,
    RightRows,
    RedOfLeft,
    CyanOfRight
  };
  void SetEye(Eye eye) { this->EyeMode = eye; }

  /// The picture's place in its window: x, y (of the lower left corner), width, height in device px, as last rendered.
  const std::array<int, 4>& GetPictureRectangle() const { return this->PictureRectangle; }

  /// The largest rectangle of the picture's aspect in a rectangle (x, y, width, height), centred, on whole pixels.
  static std::array<int, 4> Letterbox(const std::array<double, 2>& imageSize, const std::array<int, 4>& area);

protected:
  vtkHandEyeOverlayScene();
  ~vtkHandEyeOverlayScene() override;

private:
  vtkHandEyeOverlayScene(const vtkHandEyeOverlayScene&) = delete;
  void operator=(const vtkHandEyeOverlayScene&) = delete;

  void SetUpVideo();
  void SetUpModel();
  void SetUpTexts();
  void Synchronize();
  void SynchronizeViewports(const vtkHandEyeOverlayState& state);
  void SynchronizeVideo(const vtkHandEyeOverlayState& state);
  void SynchronizeCamera(const vtkHandEyeOverlayState& state);
  void SynchronizeModel(const vtkHandEyeOverlayState& state);
  void SynchronizeProperty(const vtkHandEyeOverlayState& state);
  void SynchronizeAppearance(const vtkHandEyeOverlayState& state);
  void SynchronizeStylus(const vtkHandEyeOverlayState& state);
  void SynchronizeOutline(const vtkHandEyeOverlayState& state);
  void SynchronizeTexts(const vtkHandEyeOverlayState& state);
  handeye::LensAppearance Appearance(const vtkHandEyeOverlayState& state) const;
  handeye::EyeChannel Channel() const;
  bool IsModelSeen(const vtkHandEyeOverlayState& state) const;
  bool NeedsOutlinePass(const vtkHandEyeOverlayState& state) const;
  double HaloReach(const vtkHandEyeOverlayState& state) const;
  std::array<double, 4> ModelRectangle(const vtkHandEyeOverlayState& state, double marginPx) const;

  std::function<const vtkHandEyeOverlayState&()> StateSource;
  vtkWeakPointer<vtkRenderWindow> Window;
  std::array<double, 4> Area{ 0, 0, 1, 1 };
  std::array<double, 2> Squeeze{ 1, 1 };
  Eye EyeMode = Eye::Both;
  std::array<int, 4> PictureRectangle{ 0, 0, 0, 0 };
  std::array<double, 2> DepthRangeMm{ 1, 2 };       ///< near and far plane
  std::array<double, 2> ModelDepthRangeMm{ 1, 2 };  ///< nearest and furthest Z of the model's bounding box
  vtkNew<vtkRenderer> BarsRenderer;
  vtkNew<vtkRenderer> VideoRenderer;
  vtkNew<vtkRenderer> ModelRenderer;
  vtkNew<vtkTexture> VideoTexture;
  vtkNew<vtkHandEyeVideoMapper> VideoMapper;
  vtkNew<vtkActor> VideoActor;
  vtkNew<vtkHandEyeLensMapper> DepthMapper, BodyMapper, ModelMapper, RayMapper, TipMapper;
  vtkNew<vtkActor> DepthActor, BodyActor, ModelActor, RayActor, TipActor;
  vtkNew<vtkHandEyeOutlinePass> OutlinePass;
  vtkNew<vtkTextActor> NoticeActor, LegendActor;
};
