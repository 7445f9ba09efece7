// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FoldBehind.h"

#include <QToolButton>

namespace handeye
{

void foldBehind(QToolButton& button, QWidget& content)
{
  button.setCheckable(true);
  button.setAutoRaise(true);
  button.setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  const auto show = [&button, &content](bool isOpen)
  {
    button.setArrowType(isOpen ? Qt::DownArrow : Qt::RightArrow);
    content.setVisible(isOpen);
  };
  QObject::connect(&button, &QToolButton::toggled, &content, show);
  show(button.isChecked());
}

}  // namespace handeye
