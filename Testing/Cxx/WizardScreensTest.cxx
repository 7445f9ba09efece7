// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "WizardScreens.h"
#include "LandmarkFiles.h"
#include "LandmarkPanel.h"
#include "VideoView.h"
#include "WidgetTestSupport.h"
#include "WizardDriver.h"
#include "WizardPage.h"
#include "WizardStepBar.h"

#include <QScreen>
#include <QScrollArea>
#include <QTemporaryDir>
#include <QToolButton>

using handeye::HandEyeWorkbench;
using handeye::WizardStep;

/// Every page as a picture, at two sizes, light and dark; nothing cut off.
class WizardScreensTest : public QObject
{
  Q_OBJECT

private slots:
  void everyPage_AtBothSizes();

private:
  void fill(HandEyeCalibrationPanel& panel);
  void takePictures(HandEyeCalibrationPanel& panel, const QSize& size, const QString& mark);

  QStringList faults_;
  QTemporaryDir folder_{ QDir::tempPath() + QStringLiteral("/sessions-XXXXXX") };
};

/// A session with everything in it, and the demo's recording as live video.
void WizardScreensTest::fill(HandEyeCalibrationPanel& panel)
{
  const QString demo = QStringLiteral(HANDEYE_RESOURCES_DIR "/Demo/");
  HandEyeWorkbench& workbench = panel.workbench();
  // Names that say nothing of the machine: the pictures go into the documentation.
  QSignalSpy opened(&workbench, &HandEyeWorkbench::sessionOpened);
  workbench.openSession(folder_.filePath(QStringLiteral("2026-03-02_laparoscope")));
  QTRY_VERIFY_WITH_TIMEOUT(!opened.isEmpty(), PatienceMs);
  handeye::DeviceSetup setup;
  setup.kind = handeye::DeviceSetup::Kind::Recording;
  setup.recording = demo + QStringLiteral("calibration");
  QVERIFY(workbench.connectDevices(setup));
  QVERIFY(panel.openFile(demo + QStringLiteral("camera.yml")));
  panel.goTo(WizardStep::Stylus);
  QVERIFY(panel.openFile(demo + QStringLiteral("pivot.igs.mha")));
  QTRY_VERIFY_WITH_TIMEOUT(workbench.stylus().has_value() && workbench.camera().has_value(), PatienceMs);
  panel.goTo(WizardStep::Capture);
  QVERIFY(panel.openFile(demo + QStringLiteral("calibration")));
  panel.goTo(WizardStep::Validation);
  QVERIFY(panel.openFile(demo + QStringLiteral("validation")));
  QTRY_VERIFY_WITH_TIMEOUT(workbench.validation() && workbench.validation()->projectionErrorPx.count >= 8, PatienceMs);
  const auto landmarks = handeye::readLandmarkLists((demo + QStringLiteral("phantom_model_points.txt")).toStdString(),
    (demo + QStringLiteral("phantom_touched_points.txt")).toStdString());
  panel.goTo(WizardStep::Overlay);
  QTRY_VERIFY_WITH_TIMEOUT(workbench.model() != nullptr, PatienceMs);
  QVector<handeye::LandmarkPanel::Landmark> touched = panel.findChild<handeye::LandmarkPanel*>()->landmarks();
  QCOMPARE(std::size_t(touched.size()), landmarks.points_Model.size());
  for (int i = 0; i < touched.size(); ++i)
  {
    touched[i].point_Model = landmarks.points_Model[std::size_t(i)];
    touched[i].touched_Phantom = landmarks.points_Phantom[std::size_t(i)];
  }
  panel.findChild<handeye::LandmarkPanel*>()->setLandmarks(touched);
  QTRY_VERIFY_WITH_TIMEOUT(workbench.modelToPhantom().has_value(), PatienceMs);
}

void WizardScreensTest::takePictures(HandEyeCalibrationPanel& panel, const QSize& size, const QString& mark)
{
  panel.resize(size);
  for (int i = 0; i < handeye::WizardStepCount; ++i)
  {
    panel.goTo(WizardStep(i));
    QTest::qWait(i == int(WizardStep::Overlay) ? 4000 : 1500);
    // The video is drawn by OpenGL: it is taken from the screen.
    const QPixmap picture = panel.screen()->grabWindow(panel.winId());
    const QString name =
      QStringLiteral("%1/wizard-%2-%3%4x%5.png").arg(screenshotFolder()).arg(i + 1).arg(mark).arg(size.width()).arg(size.height());
    QVERIFY2(picture.save(name), qPrintable(name));
    const QWidget* page = panel.page(WizardStep(i));
    // Words that came with the last frame have their place, too.
    QCoreApplication::sendPostedEvents(nullptr, QEvent::LayoutRequest);
    for (const QString& fault : faultsOf(panel))
    {
      faults_ << QStringLiteral("page %1: %2").arg(i + 1).arg(fault);
    }
    const auto* area = panel.findChild<QScrollArea*>(QStringLiteral("scrollArea"));
    if (page->minimumSizeHint().width() > 394 || page->width() > area->viewport()->width())
    {
      faults_ << QStringLiteral("page %1 needs %2 px").arg(i + 1).arg(page->minimumSizeHint().width());
    }
  }
}

void WizardScreensTest::everyPage_AtBothSizes()
{
  HandEyeCalibrationPanel panel(nullptr, nullptr);
  testing_widgets::show(panel, QSize(1280, 800));
  fill(panel);
  takePictures(panel, QSize(1280, 800), {});
  QApplication::setPalette(testing_widgets::darkPalette());
  takePictures(panel, QSize(2560, 1440), QStringLiteral("dark-"));
  QApplication::setPalette(testing_widgets::lightPalette());
  QVERIFY2(faults_.isEmpty(), qPrintable(faults_.join(QLatin1Char('\n'))));
}

HANDEYE_WIDGET_TEST_MAIN(WizardScreensTest)

#include "WizardScreensTest.moc"
