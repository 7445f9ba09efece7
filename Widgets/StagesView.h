// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QImage>
#include <QWidget>

#include <array>

namespace cv
{
class Mat;
}

namespace handeye
{

struct BallStages;

/// The steps of finding the ball as the paper's figure has them, live: the image, what suits the ball's colour, what is left
/// without
/// speckle, the outline that was fitted; with captions. One row, or two by two where that shows them larger.
class StagesView : public QWidget
{
  Q_OBJECT

public:
  static constexpr int Count = 4;

  explicit StagesView(QWidget* parent = nullptr);

  /// @param image the frame (BGR), @param stages what drawBallStages() made of it
  void setStages(const cv::Mat& image, const BallStages& stages);
  /// Takes the pictures away; the captions stay.
  void clear();

  /// The captions, in the pictures' order.
  static QString caption(int index);
  /// Where a picture is (logical px); empty without pictures.
  QRect pictureRectangle(int index) const;

  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;
  int heightForWidth(int width) const override;

signals:
  /// A click on one of the pictures, in px of the image: learns the colour there.
  void imageClicked(QPointF point_Image_Px);

protected:
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  bool event(QEvent* event) override;

private:
  std::array<QImage, Count> pictures_;
};

}  // namespace handeye
