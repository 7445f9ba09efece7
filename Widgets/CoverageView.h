// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QPointF>
#include <QSize>
#include <QVector>
#include <QWidget>

#include <array>
#include <optional>

namespace handeye
{

/// Where the ball has been: the image in 4 x 4 fields, once for each of three bands of distance, with the count of samples in each
/// and the next place highlighted. Tooltips, and the line below for the keyboard (arrows), say which pixels and millimetres a field
/// is.
class CoverageView : public QWidget
{
  Q_OBJECT

public:
  static constexpr int Columns = 4, Rows = 4, Bands = 3;

  struct Place
  {
    QPointF ball_Image_Px;
    double distanceMm = 0;
  };
  struct Field
  {
    int column = 0, row = 0, band = 0;  ///< from the left, from the top, from near
    bool operator==(const Field& other) const { return column == other.column && row == other.row && band == other.band; }
  };

  explicit CoverageView(QWidget* parent = nullptr);

  /// Of the camera, px.
  void setImageSize(const QSize& size);
  /// The working range, mm; 150 to 700 until set. @throws std::invalid_argument unless 0 <= nearest < furthest
  void setWorkingRange(double nearestMm, double furthestMm);

  /// The samples that are used. What is outside of the image or the range counts for the field nearest to it.
  void setPlaces(const QVector<Place>& places);
  /// Where the ball is wanted next; nothing takes the highlight away.
  void setNextPlace(const std::optional<Place>& place);
  /// Where the ball is now, as a ring.
  void setCurrentPlace(const std::optional<Place>& place);

  Field fieldOf(const Place& place) const;
  int count(const Field& field) const;
  /// Fields that have a sample, of 48.
  int filledCount() const;
  /// Where a field is in this widget.
  QRectF fieldRectangle(const Field& field) const;
  /// What the tooltip says of a field.
  QString describe(const Field& field) const;

  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;

protected:
  void paintEvent(QPaintEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void focusInEvent(QFocusEvent* event) override;
  void focusOutEvent(QFocusEvent* event) override;
  bool event(QEvent* event) override;

private:
  bool hasWordsBelow() const;
  void paintBand(QPainter& painter, int band) const;
  void paintMarks(QPainter& painter, int band, const QRectF& grid) const;
  std::optional<Field> fieldAt(const QPointF& point_Widget) const;
  void updateAccessibility();

  QSize imageSize_;
  double nearestMm_ = 150, furthestMm_ = 700;
  std::array<int, Columns * Rows * Bands> counts_{};
  std::optional<Place> next_, current_;
  Field focus_;
};

}  // namespace handeye
