// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "HandEyeErrorField.h"
#include "LensAppearance.h"

#include <vtkNew.h>
#include <vtkRenderPass.h>
#include <vtkSmartPointer.h>

#include <array>
#include <memory>

class vtkOpenGLFramebufferObject;
class vtkOpenGLQuadHelper;
class vtkOpenGLRenderWindow;
class vtkShaderProgram;
class vtkTextureObject;

/// Private to the overlay: draws a renderer's props into a texture first, and from there into the window with lines where the model
/// ends and a halo around it: where a point of the model may be by 95 % of the error that is predicted for its place and depth.
///
/// Pixels of the model have alpha ModelAlpha, those of other props OtherAlpha, in what the props draw
/// (LensAppearance::outputAlpha). 2D props (text) come last and untouched.
class vtkHandEyeOutlinePass : public vtkRenderPass
{
public:
  static constexpr double ModelAlpha = 1.0;
  static constexpr double OtherAlpha = 0.5;

  /// Lengths in device px.
  struct Settings
  {
    bool line = false;
    double lineWidthPx = 2;
    std::array<double, 3> lineColor{};
    double depthStepMm = 2;  ///< a surface that lies this much before another has a line between them
    std::shared_ptr<const handeye::HandEyeErrorField> haloField;  ///< null: no halo
    std::array<double, 2> haloScale{ 1, 1 };                      ///< device px by px of the picture
    std::array<double, 3> haloColor{};
    std::array<double, 4> modelRectanglePx{};    ///< x, y, x, y; nothing of the model is outside, seen from the picture's corner
    std::array<double, 2> depthRangeMm{ 1, 2 };  ///< near and far plane
    std::array<double, 2> modelDepthRangeMm{ 1, 2 };  ///< nearest and furthest of the model
    double opacity = 1;                               ///< of lines and halo
    handeye::EyeChannel eye;
  };

  static vtkHandEyeOutlinePass* New();
  vtkTypeMacro(vtkHandEyeOutlinePass, vtkRenderPass)

  void SetSettings(const Settings& settings) { this->Current = settings; }

  void Render(const vtkRenderState* state) override;
  void ReleaseGraphicsResources(vtkWindow* window) override;

protected:
  vtkHandEyeOutlinePass();
  ~vtkHandEyeOutlinePass() override;

private:
  vtkHandEyeOutlinePass(const vtkHandEyeOutlinePass&) = delete;
  void operator=(const vtkHandEyeOutlinePass&) = delete;

  void RenderProps(const vtkRenderState* state, vtkOpenGLRenderWindow* window, int width, int height);
  void Compose(vtkOpenGLRenderWindow* window, const std::array<int, 4>& rectangle);
  void SetParameters(vtkShaderProgram* program, const std::array<int, 4>& rectangle);
  void LoadField(vtkOpenGLRenderWindow* window);
  void SetHaloParameters(vtkShaderProgram* program);

  Settings Current;
  vtkSmartPointer<vtkRenderPass> Props;
  vtkSmartPointer<vtkRenderPass> Texts;
  vtkSmartPointer<vtkOpenGLFramebufferObject> Framebuffer;
  vtkSmartPointer<vtkTextureObject> Colors;
  vtkSmartPointer<vtkTextureObject> Depths;
  std::array<vtkSmartPointer<vtkTextureObject>, 3> Field;         ///< constant, linear, quadratic part of the halo's field
  std::shared_ptr<const handeye::HandEyeErrorField> LoadedField;  ///< that is in them
  std::unique_ptr<vtkOpenGLQuadHelper> Quad;
};
