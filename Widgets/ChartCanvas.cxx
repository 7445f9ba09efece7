// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ChartCanvas.h"

#include "vtkHandEyePainterDevice.h"

#include <QHelpEvent>
#include <QPainter>
#include <QToolTip>
#include <vtkContext2D.h>
#include <vtkContextScene.h>

namespace handeye
{

ChartCanvas::ChartCanvas(QWidget* parent)
  : QWidget(parent)
{
}

ChartCanvas::~ChartCanvas() = default;

void ChartCanvas::paintEvent(QPaintEvent*)
{
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.fillRect(rect(), palette().base());
  if (beforePainting_)
  {
    beforePainting_(size());
  }
  device_->SetPainter(&painter, size());
  context_->Begin(device_);
  scene_->SetGeometry(width(), height());
  scene_->Paint(context_);
  context_->End();
  device_->SetPainter(nullptr, size());
}

bool ChartCanvas::event(QEvent* event)
{
  if (event->type() == QEvent::ToolTip && toolTipAt_)
  {
    auto* const help = static_cast<QHelpEvent*>(event);
    const QString words = toolTipAt_({ double(help->x()), double(height() - 1 - help->y()) });
    if (!words.isEmpty())
    {
      QToolTip::showText(help->globalPos(), words, this);
      return true;
    }
  }
  return QWidget::event(event);
}

}  // namespace handeye
