// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

class QToolButton;
class QWidget;

namespace handeye
{

/// Puts what is needed now and then behind a button that opens and closes it; closed at first. The button keeps its words and gets an
/// arrow; it tells assistive technology whether it is open (checked).
void foldBehind(QToolButton& button, QWidget& content);

}  // namespace handeye
