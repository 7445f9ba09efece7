// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkSlicerHandEyeCalibrationModuleLogicExport.h"

#include <opencv2/core.hpp>
#include <vtkObject.h>

#include <memory>
#include <string>

class vtkHandEyeOverlayPipeline;
class vtkRenderWindow;

/// Two overlays, one for each eye of a stereo camera, in one window: for displays and glasses that give each eye its own picture.
///
/// Each eye is a vtkHandEyeOverlayPipeline with its own lens, video and modelToCamera (its own hand-eye); what holds for one of
/// them holds here. Both are drawn on the graphics card in one rendering; nothing is read back. GetLeft() and GetRight() must not
/// be attached to this window themselves.
///
///     p_Left = modelToLeft * p_Model      p_Right = modelToRight * p_Model
///
/// All calls belong to the thread that renders.
class VTK_SLICER_HANDEYECALIBRATION_MODULE_LOGIC_EXPORT vtkHandEyeStereoOverlay : public vtkObject
{
public:
  static vtkHandEyeStereoOverlay* New();
  vtkTypeMacro(vtkHandEyeStereoOverlay, vtkObject)
  void PrintSelf(std::ostream& os, vtkIndent indent) override;

  enum class Layout
  {
    SideBySide,  ///< the left eye's picture on the left
    TopBottom,   ///< the left eye's picture on top
    Interlaced,  ///< the left eye has the uppermost row of the window, and every other from there
    Anaglyph     ///< red for the left eye (brightness only), green and blue for the right one: red-cyan glasses
  };
  void SetLayout(Layout layout);
  Layout GetLayout();

  /// Side by side and top-bottom: each picture fills its half of the window, half as wide or high as it is, for displays that
  /// stretch it again. Off until set: the pictures keep their aspect.
  void SetSqueezed(bool squeezed);
  bool GetSqueezed();

  /// The left eye's picture where the right one's would be, and the other way round.
  void SetSwapped(bool swapped);
  bool GetSwapped();

  vtkHandEyeOverlayPipeline* GetLeft();
  vtkHandEyeOverlayPipeline* GetRight();

  /// 's' goes to the next layout, 'e' exchanges the eyes; every other key goes to both eyes. @return false for one without a
  /// meaning
  bool HandleKey(char key);

  /// Why a model is not drawn, naming the eye; empty if both are.
  std::string GetProblem();

  /// Shows both in this window, from its next rendering on; null takes them out. The window is not kept alive.
  void AttachTo(vtkRenderWindow* window);

  /// Renders both apart from any window. Side by side the picture is twice as wide as an eye's, top-bottom twice as high; squeezed,
  /// interlaced or as an anaglyph it has the size of one eye's (the larger one's).
  /// @param bgr receives the picture, 8 bits, top row first
  /// @throws std::runtime_error with a sentence if a visible model cannot be drawn, or if no size is known
  void RenderToImage(cv::Mat& bgr);

  /// Reads what the window shows since its last rendering, without bars: side by side and top-bottom as both eyes' pictures in
  /// their videos' own size next to each other, as an anaglyph in the left video's size; interlaced as it is in the window.
  /// @param bgr receives the picture, 8 bits, top row first
  /// @return false if nothing was rendered yet
  bool ReadShown(cv::Mat& bgr);

protected:
  vtkHandEyeStereoOverlay();
  ~vtkHandEyeStereoOverlay() override;

private:
  vtkHandEyeStereoOverlay(const vtkHandEyeStereoOverlay&) = delete;
  void operator=(const vtkHandEyeStereoOverlay&) = delete;

  class Internals;
  std::unique_ptr<Internals> Internal;
};
