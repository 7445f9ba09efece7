// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Look.h"
#include "vtkHandEyeStereoOverlay.h"

#include <QPointF>
#include <QPolygonF>
#include <QString>
#include <QWidget>

#include <memory>
#include <optional>

class QVTKOpenGLNativeWidget;
class vtkHandEyeOverlayPipeline;
class vtkRenderWindow;

namespace cv
{
class Mat;
}

namespace handeye
{

/// Live video with the overlay on it, letterboxed, and marks over it for the person who holds the ball.
///
/// The picture and the model come from a vtkHandEyeOverlayPipeline of its own (lens, mesh, pose and looks are set there; call
/// requestRender() then). Marks are drawn by Qt in a transparent widget on top, sharp at any device pixel ratio, and are placed by
/// the pipeline's own mapping, so that they stay on the picture through every resize.
///
/// All points are pixels of the recorded (distorted) image, `..._Image_Px`, integer coordinates being pixel centres.
///
/// Applications call QSurfaceFormat::setDefaultFormat(QVTKOpenGLNativeWidget::defaultFormat()) before their QApplication.
class VideoView : public QWidget
{
  Q_OBJECT

public:
  /// The ball as it was found, or what speaks against it.
  struct DetectionMark
  {
    Level level = Level::Good;             ///< Good: solid line; else dashed
    std::optional<QPointF> ball_Image_Px;  ///< where the ball's centre projects: a cross
    QPolygonF outline_Image_Px;            ///< closed line; may be empty
    QString text;                          ///< beside the ball: "not still", "0.3 px"; may be empty
  };

  /// The place where the ball is wanted next.
  struct GhostBall
  {
    QPolygonF outline_Image_Px;  ///< closed line, also the place of the hint
    QString hint;                ///< "5 cm further away"; may be empty
    Level level = Level::Info;   ///< Good: the ball is there
  };

  explicit VideoView(QWidget* parent = nullptr);
  ~VideoView() override;

  /// A frame (8 bits; grey, BGR or BGRA; top row first); copied. An empty one takes the video away and shows the placeholder.
  /// @throws std::invalid_argument for another type of picture
  void setFrame(const cv::Mat& bgr);
  bool hasFrame() const;
  /// Size of the last frame in px; empty without one.
  QSize frameSize() const;

  /// Words that are shown while there is no video.
  void setPlaceholderText(const QString& text);

  /// What draws the picture; owned by the view.
  vtkHandEyeOverlayPipeline* pipeline() const;
  vtkRenderWindow* renderWindow() const;

  /// Two eyes: `pipeline()` is the left one's, this the right one's; it is seen while there is a layout.
  vtkHandEyeOverlayPipeline* rightPipeline() const;
  /// How both eyes share the view; nothing: the left (or only) eye alone. Places in the picture are not known while two are
  /// shown: there are no marks then.
  void setStereo(const std::optional<vtkHandEyeStereoOverlay::Layout>& layout, bool isSwapped = false);
  std::optional<vtkHandEyeStereoOverlay::Layout> stereo() const;

  /// How large a pixel of the video is, in pixels of the screen: below 1 the view shows less than the video has; 0 without a video.
  double shownScale() const;

  /// What was rendered last, without marks and bars, brought to the video's size: see vtkHandEyeOverlayPipeline::ReadShown().
  bool readShown(cv::Mat& bgr) const;

  /// Renders soon, once for many requests; needed after changes to the pipeline only.
  void requestRender();

  /// Marks; nothing takes them away.
  void setDetection(const std::optional<DetectionMark>& detection);
  void setGhostBall(const std::optional<GhostBall>& ghost);
  /// Words over the upper part of the picture, with the icon of their level; an empty text takes them away.
  void setBanner(const QString& text, Level level = Level::Info);
  QString banner() const;
  /// A bright frame around the picture that fades: a sample was taken.
  void flash();

  /// Between this widget's coordinates (logical px from the upper left corner) and the image's, as last rendered. Nothing without a
  /// picture; widgetToImage() also outside of it.
  std::optional<QPointF> imageToWidget(const QPointF& point_Image_Px) const;
  std::optional<QPointF> widgetToImage(const QPointF& point_Widget) const;

  /// What is seen now, marks included, in device pixels.
  QImage snapshot();

  QSize sizeHint() const override;

signals:
  /// After each rendering that was asked for.
  void rendered();
  /// A click of the left button on the picture (never beside it).
  void imageClicked(QPointF point_Image_Px);
  /// A key that was pressed while the view has the focus: Qt::Key, Qt::KeyboardModifiers. Tab, Shift+Tab and what the application
  /// has shortcuts for stay theirs.
  void keyPressed(int key, Qt::KeyboardModifiers modifiers);

protected:
  bool eventFilter(QObject* watched, QEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void changeEvent(QEvent* event) override;
  void showEvent(QShowEvent* event) override;

private:
  class Private;
  std::unique_ptr<Private> d;
};

}  // namespace handeye
