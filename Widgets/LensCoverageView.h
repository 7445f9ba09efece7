// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LensTask.h"

#include <QWidget>

namespace handeye
{

/// Where in the image the views of a board have points: cells, stronger with more points, and the points themselves.
class LensCoverageView : public QWidget
{
  Q_OBJECT

public:
  explicit LensCoverageView(QWidget* parent = nullptr);

  void setState(const LensTask::State& state);
  QSize sizeHint() const override { return { 320, 190 }; }
  QSize minimumSizeHint() const override { return { 160, 120 }; }

protected:
  void paintEvent(QPaintEvent* event) override;

private:
  LensTask::State state_;
};

}  // namespace handeye
