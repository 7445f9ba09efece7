// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkBoundingBox.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkNew.h>
#include <vtkOrientationMarkerWidget.h>
#include <vtkRenderer.h>

#include <QTimer>
#include <QWidget>

#include <memory>

class QLabel;
class QToolButton;
class QVTKOpenGLNativeWidget;

namespace desktop
{

class SceneFloor;

/// The three-dimensional view, mm: a renderer for the props of modules, axes in a corner, a floor, and buttons to look from each side.
///
/// As long as nobody has turned the view, it is reset by itself when the scene outgrows what was shown; the reset button brings that back.
///
/// requestRender() costs nothing: the view draws once for many requests, and not faster than every 16 ms, or a third of the time
/// where drawing is slow.
class SceneView : public QWidget
{
  Q_OBJECT

public:
  explicit SceneView(QWidget* parent = nullptr);
  ~SceneView() override;

  vtkRenderer* renderer() const;
  void requestRender();

  /// How many pictures were drawn because of requests.
  int renderCount() const { return this->RenderCount; }

public slots:
  /// Turns to see everything from the present side; a standard view of the origin if there is nothing.
  void resetCamera();
  /// Looks along an axis (0 x, 1 y, 2 z), from its positive or negative end.
  void lookAlong(int axis, bool fromPositive);

protected:
  void changeEvent(QEvent* event) override;
  void showEvent(QShowEvent* event) override;

private:
  void makeBar();
  void applyTheme();
  void render();
  void setFloor(int plane);
  /// Without the floor; puts the floor under it.
  void measureScene(double bounds[6]);
  /// Resets the camera if something has come outside of what it was reset for.
  void fitIfOutgrown();
  void stopFitting();
  void fitCamera(const double bounds[6]);

  QVTKOpenGLNativeWidget* View;
  QWidget* Bar;
  QToolButton* Reset = nullptr;
  QToolButton* Sides = nullptr;
  QLabel* Scale = nullptr;
  vtkNew<vtkGenericOpenGLRenderWindow> Window;
  vtkNew<vtkRenderer> Renderer;
  vtkNew<vtkOrientationMarkerWidget> Axes;
  std::unique_ptr<SceneFloor> Floor;
  vtkBoundingBox Shown;   ///< what the camera was last reset for
  bool IsFitting = true;  ///< nobody has turned the view since
  QTimer RenderTimer;
  int RenderCount = 0;
};

}  // namespace desktop
