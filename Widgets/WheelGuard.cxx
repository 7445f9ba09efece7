// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "WheelGuard.h"

#include <QAbstractSpinBox>
#include <QComboBox>
#include <QEvent>
#include <QSlider>

namespace handeye
{

WheelGuard::WheelGuard(QWidget& root)
  : QObject(&root)
{
  QList<QWidget*> inputs;
  for (QComboBox* const box : root.findChildren<QComboBox*>())
  {
    inputs << box;
  }
  for (QAbstractSpinBox* const box : root.findChildren<QAbstractSpinBox*>())
  {
    inputs << box;
  }
  for (QSlider* const slider : root.findChildren<QSlider*>())
  {
    inputs << slider;
  }
  for (QWidget* const input : inputs)
  {
    input->setFocusPolicy(Qt::StrongFocus);  // not by the wheel
    input->installEventFilter(this);
  }
}

bool WheelGuard::eventFilter(QObject* watched, QEvent* event)
{
  const auto* input = qobject_cast<QWidget*>(watched);
  if (event->type() == QEvent::Wheel && input && !input->hasFocus())
  {
    event->ignore();  // and goes on to the page
    return true;
  }
  return QObject::eventFilter(watched, event);
}

}  // namespace handeye
