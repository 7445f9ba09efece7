// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QProxyStyle>

namespace desktop
{

/// Fusion, whose check boxes and radio buttons are told from the ground by a frame that has a contrast with it, on light and on dark.
/// Fusion's own frame is a darker shade of the window, which a dark window swallows.
class ThemeStyle : public QProxyStyle
{
  Q_OBJECT

public:
  ThemeStyle();

  void drawPrimitive(
    PrimitiveElement element, const QStyleOption* option, QPainter* painter, const QWidget* widget = nullptr) const override;
};

}  // namespace desktop
