// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QPointF>
#include <QSize>
#include <QString>
#include <QWidget>
#include <vtkNew.h>

#include <functional>

class vtkContext2D;
class vtkContextScene;
class vtkHandEyePainterDevice;

namespace handeye
{

/// Shows a scene of VTK's charts, painted by Qt; see vtkHandEyePainterDevice. Repaint it with update() when the scene has changed.
class ChartCanvas : public QWidget
{
public:
  explicit ChartCanvas(QWidget* parent = nullptr);
  ~ChartCanvas() override;

  vtkContextScene* scene() const { return scene_; }

  /// Called before each painting with the size (logical px) that there is.
  void setBeforePainting(std::function<void(const QSize&)> prepare) { beforePainting_ = std::move(prepare); }
  /// What is to be said of a place, in the scene's coordinates (px from the lower left); empty for the tool tip of the whole.
  void setToolTipAt(std::function<QString(const QPointF&)> words) { toolTipAt_ = std::move(words); }

protected:
  void paintEvent(QPaintEvent* event) override;
  bool event(QEvent* event) override;

private:
  vtkNew<vtkContextScene> scene_;
  vtkNew<vtkContext2D> context_;
  vtkNew<vtkHandEyePainterDevice> device_;
  std::function<void(const QSize&)> beforePainting_;
  std::function<QString(const QPointF&)> toolTipAt_;
};

}  // namespace handeye
