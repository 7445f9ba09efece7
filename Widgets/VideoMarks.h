// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "VideoView.h"

#include <QWidget>

#include <functional>
#include <optional>

namespace handeye
{

/// Private to VideoView: the transparent widget that draws marks and words over the video. It takes no mouse and no focus.
class VideoMarks : public QWidget
{
  Q_OBJECT

public:
  using Mapping = std::function<std::optional<QPointF>(const QPointF&)>;

  /// @param imageToWidget from px of the image to this widget's coordinates
  VideoMarks(const Mapping& imageToWidget, QWidget* parent);

  std::optional<VideoView::DetectionMark> detection;
  std::optional<VideoView::GhostBall> ghost;
  QString banner;
  Level bannerLevel = Level::Info;
  QString placeholder;
  QSize frameSize;   ///< empty: the placeholder covers everything
  double flash = 0;  ///< 0 to 1

  /// Draws as in a paint event.
  void draw(QPainter& painter) const;

protected:
  void paintEvent(QPaintEvent* event) override;

private:
  QPolygonF mapped(const QPolygonF& line_Image_Px) const;
  QRectF pictureRectangle() const;
  void drawPlaceholder(QPainter& painter) const;
  void drawGhost(QPainter& painter) const;
  void drawDetection(QPainter& painter) const;
  void drawBanner(QPainter& painter) const;
  void drawFlash(QPainter& painter) const;
  void drawLabel(QPainter& painter, const QPointF& anchor, const QString& text, const QColor& color) const;

  Mapping imageToWidget_;
};

}  // namespace handeye
