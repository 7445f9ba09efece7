// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "NavigationHost.h"

#include <QFrame>
#include <QVector>
#include <QWidget>

class QHBoxLayout;
class QLabel;

namespace desktop
{

/// The light of one stream: a sign whose form and colour say how it is, the name, and the state in words: "60 Hz, 12 ms", "stale 1.2 s",
/// "lost". The sign is a disc, a triangle, or a cross.
class StreamLightWidget : public QFrame
{
  Q_OBJECT

public:
  explicit StreamLightWidget(QWidget* parent = nullptr);

  void setStream(const NavigationHost::Stream& stream);

  /// What is shown beside the name.
  static QString stateText(const NavigationHost::Stream& stream);
  /// The same as a sentence, with source and reason.
  static QString description(const NavigationHost::Stream& stream);
  /// How wide the light of a stream of this name is, px.
  static int widthFor(const QString& name, const QFontMetrics& metrics);

private:
  QLabel* Sign;
  QLabel* Name;
  QLabel* State;
};

/// A row of lights for a status bar. Streams beyond those that fit into three quarters of the window are in a last label, "+3", with the
/// worst of their states; its tooltip has them all.
class StreamLights : public QWidget
{
  Q_OBJECT

public:
  explicit StreamLights(QWidget* parent = nullptr);

  void setStreams(const QVector<NavigationHost::Stream>& streams);
  const QVector<NavigationHost::Stream>& streams() const { return this->Streams; }

protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

private:
  int countThatFits() const;

  QVector<NavigationHost::Stream> Streams;
  QVector<StreamLightWidget*> Lights;
  QHBoxLayout* Row;
  StreamLightWidget* Rest = nullptr;
};

}  // namespace desktop
