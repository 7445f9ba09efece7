// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QPointer>
#include <QWidget>

class QSplitter;
class QStackedLayout;

namespace desktop
{

class SceneView;

/// A place for one widget of a module that shows video. It does not own it: before the place goes, the widget is taken out.
class VideoView : public QWidget
{
  Q_OBJECT

public:
  explicit VideoView(QWidget* parent = nullptr);
  ~VideoView() override;

  /// Null: none; words are shown instead.
  void setWidget(QWidget* widget);
  QWidget* widget() const { return this->Widget; }

private:
  QStackedLayout* Stack;
  QPointer<QWidget> Widget;
};

/// Video and three-dimensional view, arranged.
class ViewArea : public QWidget
{
  Q_OBJECT

public:
  enum Layout
  {
    VideoOnly,
    SceneOnly,
    SideBySide,
    Stacked
  };

  explicit ViewArea(QWidget* parent = nullptr);

  VideoView* video() const { return this->Video; }
  SceneView* scene() const { return this->Scene; }

  void setLayoutKind(Layout layout);
  Layout layoutKind() const { return this->Kind; }

  /// Where the border between the views is.
  QByteArray saveState() const;
  void restoreState(const QByteArray& state);

private:
  QSplitter* Splitter;
  VideoView* Video;
  SceneView* Scene;
  Layout Kind = SideBySide;
};

}  // namespace desktop
