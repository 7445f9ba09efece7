// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LandmarkPanel.h"

#include "WidgetTestSupport.h"

#include <QCheckBox>
#include <QFile>
#include <QLabel>
#include <QPushButton>
#include <QSignalSpy>
#include <QTableWidget>
#include <QTemporaryDir>
#include <QToolButton>

#include <cmath>
#include <functional>
#include <stdexcept>
#include <vector>

using namespace handeye;

namespace
{

const char* const LandmarkFile = HANDEYE_RESOURCES_DIR "/Meshes/VertebraLandmarks.txt";

/// Where the phantom's marker would say the landmarks are.
Eigen::Isometry3d modelToPhantom()
{
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.linear() = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  transform.translation() = Eigen::Vector3d(40, -25, 110);
  return transform;
}

/// What an engine does: registers whenever the pairs are others.
void connectRegistration(LandmarkPanel& panel)
{
  QObject::connect(&panel, &LandmarkPanel::pairsChanged, &panel,
    [&panel]
    {
      const LandmarkPanel::Pairs pairs = panel.pairs();
      panel.setResult(pairs.landmarks.size() >= 3
          ? std::optional<LandmarkRegistrationResult>(registerLandmarks(pairs.points_Model, pairs.points_Phantom))
          : std::nullopt);
    });
}

QString verdictOf(const LandmarkPanel& panel)
{
  return panel.findChild<QLabel*>(QStringLiteral("verdictLabel"))->text();
}

QLabel* fileLabelOf(const LandmarkPanel& panel)
{
  return panel.findChild<QLabel*>(QStringLiteral("fileLabel"));
}

QPushButton* button(const LandmarkPanel& panel, const char* name)
{
  return panel.findChild<QPushButton*>(QString::fromLatin1(name));
}

QString cell(const LandmarkPanel& panel, int row, int column)
{
  return panel.findChild<QTableWidget*>()->item(row, column)->text();
}

void touchAll(LandmarkPanel& panel)
{
  while (panel.currentLandmark() >= 0)
  {
    panel.setTouched(modelToPhantom() * panel.landmarks()[panel.currentLandmark()].point_Model);
  }
}

}  // namespace

class LandmarkPanelTest : public QObject
{
  Q_OBJECT

private slots:
  void TheLandmarks_ComeWithTheirNames()
  {
    LandmarkPanel panel;
    QVERIFY(panel.loadModelLandmarks(QString::fromLatin1(LandmarkFile)));
    QCOMPARE(panel.landmarks().size(), 6);
    QCOMPARE(cell(panel, 0, 1), QStringLiteral("tip of the spinous process"));
    QCOMPARE(panel.currentLandmark(), 0);
    QVERIFY(!button(panel, "touchButton")->isEnabled());  // no tip yet
  }

  void AWrongFile_IsRefusedInWords_AndWhatWasThereStays()
  {
    QTemporaryDir folder;
    const QString path = folder.filePath(QStringLiteral("bad.txt"));
    QFile file(path);
    QVERIFY(file.open(QIODevice::WriteOnly));
    file.write("1 2 3\n4 5\n");
    file.close();
    LandmarkPanel panel;
    QVERIFY(panel.loadModelLandmarks(QString::fromLatin1(LandmarkFile)));
    QVERIFY(!panel.loadModelLandmarks(path));
    QVERIFY2(verdictOf(panel).contains(QStringLiteral("bad.txt")) && verdictOf(panel).contains(QStringLiteral("2")),
      qPrintable(verdictOf(panel)));
    QCOMPARE(panel.landmarks().size(), 6);
    QVERIFY(!panel.loadModelLandmarks(folder.filePath(QStringLiteral("none.txt"))));
    QVERIFY(verdictOf(panel).contains(QStringLiteral("none.txt")));
  }

  void AFailedLoad_IsOverWithTheNextStep()
  {
    LandmarkPanel panel;
    QVERIFY(panel.loadModelLandmarks(QString::fromLatin1(LandmarkFile)));
    const QVector<LandmarkPanel::Landmark> landmarks = panel.landmarks();
    const std::function<void()> touch = [&] { panel.setTouched({ 1, 2, 3 }); };
    const std::function<void()> takeBack = [&]
    {
      panel.setCurrentLandmark(0);
      panel.takeBackCurrent();
    };
    const std::function<void()> skip = [&] { panel.skipCurrent(); };
    const std::function<void()> startOver = [&] { panel.clearTouched(); };
    const std::function<void()> undo = [&] { panel.undo(); };
    const std::function<void()> anotherSession = [&] { panel.setLandmarks(landmarks); };
    const std::function<void()> emptySession = [&] { panel.setLandmarks({}); };
    const std::vector<std::function<void()>> steps = { touch, takeBack, skip, startOver, undo, anotherSession, emptySession };
    for (std::size_t i = 0; i < steps.size(); ++i)
    {
      QVERIFY(!panel.loadModelLandmarks(QStringLiteral("/nowhere/none.txt")));
      QVERIFY2(verdictOf(panel).contains(QStringLiteral("none.txt")), qPrintable(verdictOf(panel)));
      steps[i]();
      QVERIFY2(verdictOf(panel).contains(QStringLiteral("of at least 3")),
        qPrintable(QStringLiteral("step %1: %2").arg(i).arg(verdictOf(panel))));
    }
  }

  void LandmarksOfASession_SayWhereTheyAreFrom()
  {
    LandmarkPanel panel;
    QCOMPARE(fileLabelOf(panel)->text(), QStringLiteral("No landmarks loaded"));
    QVERIFY(panel.loadModelLandmarks(QString::fromLatin1(LandmarkFile)));
    touchAll(panel);
    const QVector<LandmarkPanel::Landmark> landmarks = panel.landmarks();
    panel.setLandmarks(landmarks);
    QCOMPARE(fileLabelOf(panel)->text(), QStringLiteral("6 landmarks of the session"));
    QVERIFY2(fileLabelOf(panel)->toolTip().isEmpty(), qPrintable(fileLabelOf(panel)->toolTip()));
    panel.setLandmarks({});
    QCOMPARE(fileLabelOf(panel)->text(), QStringLiteral("No landmarks loaded"));
  }

  void TouchingOneAfterTheOther_RegistersThePhantom()
  {
    LandmarkPanel panel;
    connectRegistration(panel);
    panel.loadModelLandmarks(QString::fromLatin1(LandmarkFile));
    panel.setTipAvailable(true);
    testing_widgets::show(panel, { 520, 460 });
    QSignalSpy requests(&panel, &LandmarkPanel::touchRequested);
    for (int index = 0; index < 6; ++index)
    {
      QTest::mouseClick(button(panel, "touchButton"), Qt::LeftButton);
      QCOMPARE(requests.count(), index + 1);
      QCOMPARE(requests.last()[0].toInt(), index);
      panel.setTouched(modelToPhantom() * panel.landmarks()[index].point_Model);
      QCOMPARE(button(panel, "saveButton")->isEnabled(), index >= 2);
    }
    QCOMPARE(panel.currentLandmark(), -1);
    QVERIFY(panel.result() && panel.result()->isUsable());
    QVERIFY(panel.result()->modelToPhantom.isApprox(modelToPhantom(), 1e-9));
    QVERIFY2(verdictOf(panel).contains(QStringLiteral("RMS 0.00\u00a0mm over 6 landmarks")), qPrintable(verdictOf(panel)));
    QCOMPARE(cell(panel, 3, 2), QStringLiteral("touched"));
    QCOMPARE(cell(panel, 3, 3), QStringLiteral("0.00"));
  }

  void ASlip_IsNamed_AndTakingItBackMendsIt()
  {
    LandmarkPanel panel;
    connectRegistration(panel);
    panel.loadModelLandmarks(QString::fromLatin1(LandmarkFile));
    panel.setTipAvailable(true);
    touchAll(panel);
    panel.setCurrentLandmark(4);
    panel.setTouched(modelToPhantom() * panel.landmarks()[4].point_Model + Eigen::Vector3d(25, 0, 0));
    QVERIFY(panel.result() && !panel.result()->isUsable());
    QVERIFY(!button(panel, "saveButton")->isEnabled());
    QCOMPARE(panel.result()->worst, 4);
    QVERIFY(!panel.findChild<QTableWidget*>()->item(4, 3)->icon().isNull());
    QVERIFY(panel.findChild<QTableWidget*>()->item(1, 3)->icon().isNull());
    panel.setCurrentLandmark(4);
    panel.takeBackCurrent();
    QCOMPARE(panel.pairs().landmarks, (QVector<int>{ 0, 1, 2, 3, 5 }));
    QVERIFY(panel.result()->isUsable());
    panel.setTouched(modelToPhantom() * panel.landmarks()[4].point_Model);
    QCOMPARE(panel.pairs().landmarks.size(), 6);
    QVERIFY(panel.result()->isUsable());
  }

  void SkippedLandmarks_AreLeftOut_AndResidualsStayWithTheirs()
  {
    LandmarkPanel panel;
    connectRegistration(panel);
    panel.loadModelLandmarks(QString::fromLatin1(LandmarkFile));
    panel.setTipAvailable(true);
    panel.skipCurrent();
    QCOMPARE(panel.currentLandmark(), 1);
    touchAll(panel);
    QCOMPARE(panel.pairs().landmarks, (QVector<int>{ 1, 2, 3, 4, 5 }));
    QCOMPARE(cell(panel, 0, 2), QStringLiteral("skipped"));
    QCOMPARE(cell(panel, 0, 3), QStringLiteral("\u2013"));
    QCOMPARE(cell(panel, 5, 3), QStringLiteral("0.00"));
    panel.setCurrentLandmark(0);
    panel.skipCurrent();
    QCOMPARE(panel.currentLandmark(), 0);
    QVERIFY(!panel.landmarks()[0].skipped);
  }

  void HandsFree_TakesTheTipWhenItRestsElsewhere()
  {
    LandmarkPanel panel;
    panel.loadModelLandmarks(QString::fromLatin1(LandmarkFile));
    panel.setTipAvailable(true);
    const Eigen::Vector3d first = modelToPhantom() * panel.landmarks()[0].point_Model;
    const Eigen::Vector3d second = modelToPhantom() * panel.landmarks()[1].point_Model;
    QVERIFY(!panel.offerTip(first));
    QSignalSpy switched(&panel, &LandmarkPanel::handsFreeChanged);
    panel.findChild<QCheckBox*>()->click();
    QCOMPARE(switched.count(), 1);
    QVERIFY(panel.offerTip(first));
    // It still rests there: that is not the next landmark.
    QVERIFY(!panel.offerTip(first + Eigen::Vector3d(0.5, 0, 0)));
    QVERIFY(panel.offerTip(second));
    QCOMPARE(panel.pairs().landmarks, (QVector<int>{ 0, 1 }));
    panel.setTipAvailable(false, QStringLiteral("The phantom's marker is not seen"));
    QVERIFY(!panel.offerTip(second + Eigen::Vector3d(30, 0, 0)));
    QVERIFY(panel.findChild<QLabel*>(QStringLiteral("tipLabel"))->text().contains(QStringLiteral("marker is not seen")));
  }

  void TheKeyboard_TouchesAndTakesBack()
  {
    LandmarkPanel panel;
    panel.loadModelLandmarks(QString::fromLatin1(LandmarkFile));
    panel.setTipAvailable(true);
    testing_widgets::show(panel, { 520, 460 });
    auto* table = panel.findChild<QTableWidget*>();
    table->setFocus();
    QTRY_VERIFY(table->hasFocus());
    QSignalSpy requests(&panel, &LandmarkPanel::touchRequested), changes(&panel, &LandmarkPanel::pairsChanged);
    QTest::keyClick(table, Qt::Key_Space);
    QCOMPARE(requests.count(), 1);
    panel.setTouched(Eigen::Vector3d(1, 2, 3));
    QTest::keyClick(table, Qt::Key_Up);
    QCOMPARE(panel.currentLandmark(), 0);
    QTest::keyClick(table, Qt::Key_Backspace);
    QCOMPARE(changes.count(), 2);
    QVERIFY(panel.pairs().landmarks.isEmpty());
  }

  void CtrlZ_UndoesAfterAClickWithTheMouse()
  {
    LandmarkPanel panel;
    panel.loadModelLandmarks(QString::fromLatin1(LandmarkFile));
    panel.setTouched({ 1, 2, 3 });
    testing_widgets::show(panel, { 520, 460 });
    QPushButton* const skip = button(panel, "skipButton");
    QTest::mouseClick(skip, Qt::LeftButton);
    QVERIFY(panel.landmarks()[1].skipped);
    QTRY_VERIFY(skip->hasFocus());
    QTest::keyClick(skip, Qt::Key_Z, Qt::ControlModifier);
    QVERIFY(!panel.landmarks()[1].skipped);
    // This button is disabled by its own click.
    QTest::mouseClick(button(panel, "clearButton"), Qt::LeftButton);
    QVERIFY(panel.pairs().landmarks.isEmpty() && !button(panel, "clearButton")->isEnabled());
    QTRY_VERIFY(QApplication::focusWidget() && panel.isAncestorOf(QApplication::focusWidget()));
    QTest::keyClick(QApplication::focusWidget(), Qt::Key_Z, Qt::ControlModifier);
    QCOMPARE(panel.pairs().landmarks, QVector<int>{ 0 });
  }

  void StartingOver_IsUndone_AndTheSentenceSaysSo()
  {
    LandmarkPanel panel;
    connectRegistration(panel);
    panel.loadModelLandmarks(QString::fromLatin1(LandmarkFile));
    testing_widgets::show(panel, { 520, 460 });
    auto* undo = panel.findChild<QToolButton*>(QStringLiteral("undoButton"));
    QVERIFY(!undo->isEnabled());
    touchAll(panel);
    const QString before = verdictOf(panel);
    const std::vector<Eigen::Vector3d> points = panel.pairs().points_Phantom;
    QTest::mouseClick(button(panel, "clearButton"), Qt::LeftButton);
    QVERIFY(panel.pairs().landmarks.isEmpty());
    QVERIFY2(verdictOf(panel).contains(QStringLiteral("0 of at least 3")) &&
        verdictOf(panel).contains(QStringLiteral("Undo brings 6 touched points back")),
      qPrintable(verdictOf(panel)));
    QVERIFY2(undo->toolTip().contains(QStringLiteral("start over")), qPrintable(undo->toolTip()));
    QTest::mouseClick(undo, Qt::LeftButton);
    QCOMPARE(panel.pairs().landmarks.size(), 6);
    QVERIFY(panel.pairs().points_Phantom == points);
    QVERIFY(panel.result() && panel.result()->isUsable());
    QCOMPARE(verdictOf(panel), before);
  }

  void EveryStep_IsUndoneInReverse_AndNotIntoAnotherSession()
  {
    LandmarkPanel panel;
    panel.loadModelLandmarks(QString::fromLatin1(LandmarkFile));
    panel.setTouched({ 1, 2, 3 });
    panel.skipCurrent();
    panel.setCurrentLandmark(0);
    panel.setTouched({ 4, 5, 6 });  // over the first
    panel.setCurrentLandmark(0);
    panel.takeBackCurrent();
    QVERIFY(!panel.landmarks()[0].touched_Phantom);
    panel.undo();
    QCOMPARE(panel.landmarks()[0].touched_Phantom->x(), 4.0);
    panel.undo();
    QCOMPARE(panel.landmarks()[0].touched_Phantom->x(), 1.0);
    QVERIFY(panel.landmarks()[1].skipped);
    panel.undo();
    QVERIFY(!panel.landmarks()[1].skipped);
    QCOMPARE(panel.currentLandmark(), 1);
    panel.undo();
    QVERIFY(panel.pairs().landmarks.isEmpty());
    QCOMPARE(panel.landmarks().size(), 6);
    panel.undo();  // nothing is left: nothing happens
    QCOMPARE(panel.landmarks().size(), 6);
    panel.setTouched({ 1, 2, 3 });
    panel.forgetTouched();
    panel.undo();
    QVERIFY(panel.pairs().landmarks.isEmpty());
  }

  void LoadingOtherLandmarks_IsUndoneToo()
  {
    QTemporaryDir folder;
    QFile file(folder.filePath(QStringLiteral("three.txt")));
    QVERIFY(file.open(QIODevice::WriteOnly));
    file.write("0 0 0\n10 0 0\n0 10 0\n");
    file.close();
    LandmarkPanel panel;
    panel.loadModelLandmarks(QString::fromLatin1(LandmarkFile));
    panel.setTouched({ 1, 2, 3 });
    QVERIFY(panel.loadModelLandmarks(file.fileName()));
    QCOMPARE(panel.landmarks().size(), 3);
    panel.undo();
    QCOMPARE(panel.landmarks().size(), 6);
    QVERIFY(panel.landmarks()[0].touched_Phantom.has_value());
    QVERIFY(fileLabelOf(panel)->text().contains(QStringLiteral("VertebraLandmarks.txt")));
    QVERIFY(fileLabelOf(panel)->toolTip().endsWith(QStringLiteral("VertebraLandmarks.txt")));
  }

  void StartingOver_ForgetsWhatWasTouched()
  {
    LandmarkPanel panel;
    connectRegistration(panel);
    panel.loadModelLandmarks(QString::fromLatin1(LandmarkFile));
    touchAll(panel);
    QVERIFY(panel.result());
    panel.clearTouched();
    QVERIFY(panel.pairs().landmarks.isEmpty());
    QVERIFY(!panel.result());
    QCOMPARE(panel.landmarks().size(), 6);
    QVERIFY(verdictOf(panel).contains(QStringLiteral("0 of at least 3")));
    QVERIFY_EXCEPTION_THROWN(panel.setTouched(Eigen::Vector3d(NAN, 0, 0)), std::invalid_argument);
  }
};

HANDEYE_WIDGET_TEST_MAIN(LandmarkPanelTest)
#include "LandmarkPanelTest.moc"
