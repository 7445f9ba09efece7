// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "HandEyeCalibrationPanel.h"
#include "HandEyeWorkbench.h"

#include <QElapsedTimer>
#include <QLabel>
#include <QPushButton>
#include <QString>
#include <QTimer>
#include <QtTest>

#include <algorithm>

/// Clicks through a panel's real buttons, as a person does.
class WizardDriver
{
public:
  explicit WizardDriver(HandEyeCalibrationPanel& panel)
    : panel_(panel)
  {
  }

  template<typename Widget = QPushButton> Widget* find(const char* name) const
  {
    return panel_.findChild<Widget*>(QString::fromLatin1(name));
  }
  /// A child of the page that is shown.
  template<typename Widget = QPushButton> Widget* onPage(const char* name) const
  {
    return reinterpret_cast<QWidget*>(panel_.page(panel_.currentStep()))->findChild<Widget*>(QString::fromLatin1(name));
  }

  static void click(QAbstractButton* button) { QTest::mouseClick(button, Qt::LeftButton); }
  static void check(QAbstractButton* box)
  {
    QTest::mouseClick(box, Qt::LeftButton, Qt::NoModifier, QPoint(8, box->height() / 2));
  }

  bool canGoNext() const { return find("nextButton")->isEnabled() && find("nextButton")->isVisible(); }
  /// Why Next is closed, and what was refused, as they stand on the screen.
  QString reason() const { return visibleText("reasonLabel"); }
  QString message() const { return visibleText("messageLabel"); }
  QString missing() const { return visibleText("missingLabel"); }
  QString visibleText(const char* name) const
  {
    const QLabel* label = find<QLabel>(name);
    return label->isVisible() ? label->text() : QString();
  }

private:
  HandEyeCalibrationPanel& panel_;
};

/// The longest time in which the event loop did not come round.
class StallMeter : public QObject
{
public:
  StallMeter()
  {
    timer_.setInterval(2);
    timer_.setTimerType(Qt::PreciseTimer);
    connect(&timer_, &QTimer::timeout, this,
      [this]
      {
        const qint64 elapsed = clock_.restart();
        longestMs_ = std::max(longestMs_, elapsed);
        over50_ += elapsed > 50 ? 1 : 0;
      });
  }
  void start()
  {
    clock_.start();
    timer_.start();
  }
  void stop() { timer_.stop(); }
  qint64 longestMs() const { return longestMs_; }
  int countOver50Ms() const { return over50_; }

private:
  QTimer timer_;
  QElapsedTimer clock_;
  qint64 longestMs_ = 0;
  int over50_ = 0;
};
