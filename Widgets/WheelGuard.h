// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QObject>

class QWidget;

namespace handeye
{

/// Lets the mouse wheel change a choice, a number or a slider only while that has the focus; otherwise the page below it scrolls.
///
/// Who scrolls down a page with the pointer over it would choose another stream for a marker without seeing it.
class WheelGuard : public QObject
{
  Q_OBJECT

public:
  /// For all that is below the root now; belongs to it.
  explicit WheelGuard(QWidget& root);

  bool eventFilter(QObject* watched, QEvent* event) override;
};

}  // namespace handeye
