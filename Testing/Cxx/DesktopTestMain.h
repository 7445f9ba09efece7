// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ApplicationSetup.h"

#include <QApplication>
#include <QSettings>
#include <QtTest>

/// As QTEST_MAIN, with what NavigationDesktop says before and after there is an application, and settings that begin empty.
#define DESKTOP_TEST_MAIN(TestClass)                                                                                               \
  int main(int argc, char** argv)                                                                                                  \
  {                                                                                                                                \
    desktop::prepareApplication();                                                                                                 \
    QApplication application(argc, argv);                                                                                          \
    desktop::finishApplication();                                                                                                  \
    QApplication::setOrganizationName("Test");                                                                                     \
    QApplication::setApplicationName(#TestClass);                                                                                  \
    QSettings().clear();                                                                                                           \
    TestClass test;                                                                                                                \
    return QTest::qExec(&test, argc, argv);                                                                                        \
  }
