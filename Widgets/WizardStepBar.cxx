// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "WizardStepBar.h"

#include "Look.h"

#include <QButtonGroup>
#include <QGridLayout>
#include <QToolButton>

namespace handeye
{

namespace
{

constexpr int Columns = 3;

QString stateWord(WizardStepBar::State state)
{
  switch (state)
  {
    case WizardStepBar::State::Done:
      return WizardStepBar::tr("done");
    case WizardStepBar::State::Doubtful:
      return WizardStepBar::tr("done, but look at its verdict");
    case WizardStepBar::State::Open:
      return WizardStepBar::tr("open");
    case WizardStepBar::State::Blocked:
      return WizardStepBar::tr("blocked");
  }
  return {};
}

QIcon stateIcon(WizardStepBar::State state)
{
  switch (state)
  {
    case WizardStepBar::State::Done:
      return icon(QStringLiteral("step-done"));
    case WizardStepBar::State::Doubtful:
      return icon(QStringLiteral("step-doubtful"));
    case WizardStepBar::State::Open:
      return icon(QStringLiteral("step-open"));
    case WizardStepBar::State::Blocked:
      return icon(QStringLiteral("step-blocked"));
  }
  return {};
}

}  // namespace

WizardStepBar::WizardStepBar(QWidget* parent)
  : QWidget(parent)
{
  auto* layout = new QGridLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(2);
  auto* group = new QButtonGroup(this);
  for (int i = 0; i < WizardStepCount; ++i)
  {
    auto* button = new QToolButton(this);
    button->setObjectName(QStringLiteral("stepButton%1").arg(i + 1));
    button->setText(nameOf(WizardStep(i)));
    button->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
    button->setCheckable(true);
    button->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
    group->addButton(button, i);
    layout->addWidget(button, i / Columns, i % Columns);
    buttons_[std::size_t(i)] = button;
    connect(button, &QToolButton::clicked, this, [this, i] { emit chosen(WizardStep(i)); });
    setState(WizardStep(i), State::Open, {});
  }
  for (int column = 0; column < Columns; ++column)
  {
    layout->setColumnStretch(column, 1);
  }
  setCurrent(WizardStep::Devices);
}

QString WizardStepBar::nameOf(WizardStep step)
{
  switch (step)
  {
    case WizardStep::Devices:
      return tr("1 Devices");
    case WizardStep::Camera:
      return tr("2 Camera");
    case WizardStep::Stylus:
      return tr("3 Stylus");
    case WizardStep::Ball:
      return tr("4 Ball");
    case WizardStep::Capture:
      return tr("5 Capture");
    case WizardStep::Validation:
      return tr("6 Validation");
    case WizardStep::Comparison:
      return tr("7 Comparison");
    case WizardStep::Overlay:
      return tr("8 Overlay");
    case WizardStep::Finish:
      return tr("9 Finish");
  }
  return {};
}

void WizardStepBar::setCurrent(WizardStep step)
{
  button(step)->setChecked(true);
  // A dark style draws a button that is down much like the others.
  for (int each = 0; each < WizardStepCount; ++each)
  {
    QFont font = this->font();
    font.setBold(WizardStep(each) == step);
    button(WizardStep(each))->setFont(font);
  }
}

void WizardStepBar::setState(WizardStep step, State state, const QString& reason)
{
  QToolButton* const stepButton = button(step);
  const QString words = nameOf(step) + QStringLiteral(": ") + stateWord(state);
  const QString tip = reason.isEmpty() ? words : words + QLatin1Char('\n') + reason;
  if (states_[std::size_t(step)] == state && stepButton->toolTip() == tip)
  {
    return;
  }
  states_[std::size_t(step)] = state;
  stepButton->setIcon(stateIcon(state));
  stepButton->setToolTip(tip);
  stepButton->setAccessibleName(words);
}

}  // namespace handeye
