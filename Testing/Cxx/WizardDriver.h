// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "HandEyeCalibrationPanel.h"
#include "HandEyeWorkbench.h"
#include "WizardPage.h"

#include <QElapsedTimer>
#include <QLabel>
#include <QPushButton>
#include <QString>
#include <QTimer>
#include <QToolButton>
#include <QtTest>

#include <algorithm>
#include <ctime>

/// How long a test waits for what takes a moment on a free machine; on one that is shared, flushing a file may take seconds.
constexpr int PatienceMs = 60000;

/// What was refused, in the output of a test that fails.
inline void printRefusals(HandEyeCalibrationPanel& panel)
{
  QObject::connect(&panel.workbench(), &handeye::HandEyeWorkbench::refused,
    [](handeye::WizardStep step, const QString& message) { qInfo("refused on page %d: %s", int(step) + 1, qPrintable(message)); });
}

/// Until everything that was to be stored by now is on the disk.
inline void waitUntilStored(handeye::HandEyeWorkbench& workbench)
{
  bool isStored = false;
  workbench.afterStoring([&isStored] { isStored = true; });
  QTRY_VERIFY_WITH_TIMEOUT(isStored, PatienceMs);
}

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
    return static_cast<QWidget*>(panel_.page(panel_.currentStep()))->findChild<Widget*>(QString::fromLatin1(name));
  }

  static void click(QAbstractButton* button) { QTest::mouseClick(button, Qt::LeftButton); }
  static void check(QAbstractButton* box) { QTest::mouseClick(box, Qt::LeftButton, Qt::NoModifier, QPoint(8, box->height() / 2)); }

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

/// For how long the event loop did not come round: by the clock, and by what the window's thread itself worked in that time. On a
/// machine that is shared, or that draws OpenGL in software with threads of its own, only the second says something of the program.
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
        const qint64 elapsedMs = clock_.restart();
        const double worked = workedMs(), workMs = worked - lastWorkMs_;
        lastWorkMs_ = worked;
        longestMs_ = std::max(longestMs_, elapsedMs);
        if (workMs > longestWorkMs_)
        {
          longestWorkMs_ = workMs;
          phaseOfLongest_ = phase_;
        }
        over50_ += workMs > 50 ? 1 : 0;
      });
  }
  void start()
  {
    clock_.start();
    lastWorkMs_ = workedMs();
    timer_.start();
  }
  void stop() { timer_.stop(); }
  /// For what is said of the longest.
  void setPhase(const QString& phase) { phase_ = phase; }

  qint64 longestMs() const { return longestMs_; }
  double longestWorkMs() const { return longestWorkMs_; }
  int countOver50Ms() const { return over50_; }
  QString phaseOfLongest() const { return phaseOfLongest_; }

private:
  static double workedMs()
  {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return double(time.tv_sec) * 1e3 + double(time.tv_nsec) * 1e-6;
  }

  QTimer timer_;
  QElapsedTimer clock_;
  QString phase_, phaseOfLongest_;
  qint64 longestMs_ = 0;
  double lastWorkMs_ = 0, longestWorkMs_ = 0;
  int over50_ = 0;
};
