// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "HandEyeWorkbench.h"

#include <QWidget>

#include <array>

class QToolButton;

namespace handeye
{

/// The wizard's steps in three rows, each with its state: done, open, or blocked by an earlier one. A click goes there.
class WizardStepBar : public QWidget
{
  Q_OBJECT

public:
  enum class State
  {
    Done,
    Doubtful,  ///< done, and to be looked at
    Open,
    Blocked
  };

  explicit WizardStepBar(QWidget* parent = nullptr);

  static QString nameOf(WizardStep step);

  void setCurrent(WizardStep step);
  /// @param reason for the tooltip: why it is not done, or what blocks it
  void setState(WizardStep step, State state, const QString& reason);
  State state(WizardStep step) const { return states_[std::size_t(step)]; }
  QToolButton* button(WizardStep step) const { return buttons_[std::size_t(step)]; }

signals:
  void chosen(handeye::WizardStep step);

private:
  std::array<QToolButton*, WizardStepCount> buttons_{};
  std::array<State, WizardStepCount> states_{};
};

}  // namespace handeye
