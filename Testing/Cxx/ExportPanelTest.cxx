// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ExportPanel.h"

#include "CalibrationExport.h"
#include "CameraFile.h"
#include "NamedTransform.h"
#include "WidgetTestSupport.h"

#include <QCheckBox>
#include <QFile>
#include <QFileInfo>
#include <QLabel>
#include <QPushButton>
#include <QSignalSpy>
#include <QTemporaryDir>
#include <QTextBrowser>

using namespace handeye;

namespace
{

constexpr const char* Calibration = R"({
  "schema": "handeye-calibration/1", "status": "ok", "message": "",
  "markerToCamera": [[0, -1, 0, 12.5], [1, 0, 0, -40], [0, 0, 1, 33], [0, 0, 0, 1]],
  "camera": { "width": 640, "height": 480, "cameraMatrix": [[500, 0, 320], [0, 501, 240], [0, 0, 1]],
              "distortionCoefficients": [0.1, -0.05, 0.001, 0.002, 0] },
  "tip_Stylus_Mm": [0, 0, -150], "ballRadiusMm": 15, "reprojectionRmsPx": 0.6, "pointToLineRmsMm": 0.3,
  "tools": { "stylusToTracker": "StylusToTracker", "markerToTracker": "MarkerToTracker" }, "samples": []
})";

QPushButton* button(const ExportPanel& panel, const char* name)
{
  return panel.findChild<QPushButton*>(QString::fromLatin1(name));
}

QString messageOf(const ExportPanel& panel)
{
  return panel.findChild<QLabel*>(QStringLiteral("messageLabel"))->text();
}

}  // namespace

class ExportPanelTest : public QObject
{
  Q_OBJECT

private slots:
  void init()
  {
    folder_ = std::make_unique<QTemporaryDir>();
    QFile file(folder_->filePath(QStringLiteral("calibration.json")));
    QVERIFY(file.open(QIODevice::WriteOnly));
    file.write(Calibration);
    sources_ = {};
    sources_.calibration = file.fileName().toStdString();
  }

  void WithoutACalibration_NothingCanBeExported()
  {
    ExportPanel panel;
    panel.setFolder(folder_->path());
    QVERIFY(!button(panel, "exportButton")->isEnabled());
    QVERIFY(messageOf(panel).contains(QStringLiteral("no calibration")));
    QVERIFY(!panel.exportNow());
  }

  void EveryFormat_IsWrittenAndReadBack()
  {
    ExportPanel panel;
    panel.setSources(sources_);
    const QString target = folder_->filePath(QStringLiteral("new/export"));
    panel.setFolder(target);
    testing_widgets::show(panel, { 560, 520 });
    QSignalSpy exported(&panel, &ExportPanel::exported);
    QTest::mouseClick(button(panel, "exportButton"), Qt::LeftButton);
    QCOMPARE(exported.count(), 1);
    QVERIFY(panel.writtenFiles().size() >= int(exportFormats().size()));
    for (const QString& path : panel.writtenFiles())
    {
      QVERIFY2(QFileInfo(path).size() > 20, qPrintable(path));
      QVERIFY(path.startsWith(target));
      QVERIFY(panel.findChild<QTextBrowser*>()->toHtml().contains(QFileInfo(path).fileName()));
    }
    // Each file that holds the camera's place holds this one.
    const char* const withTransform[] = { "PlusCoordinateDefinitions.xml", "MarkerToCamera.tfm", "HandEyeCalibration.mrml" };
    for (const char* name : withTransform)
    {
      const Eigen::Isometry3d read =
        io::readTransform((target + QLatin1Char('/') + QString::fromLatin1(name)).toStdString(), "MarkerToCamera");
      QVERIFY2((read.translation() - Eigen::Vector3d(12.5, -40, 33)).norm() < 1e-6, name);
      QVERIFY2(std::abs(read.linear()(0, 1) + 1) < 1e-9, name);
    }
    const char* const withCamera[] = { "PinholeCamera.xml", "camera_opencv.yml", "camera_info_ros.yaml",
      "calib.left.intrinsics.txt", "camera_vasst.xml", "camera_handeye.json" };
    for (const char* name : withCamera)
    {
      const io::CameraFile read = io::readCameraFile((target + QLatin1Char('/') + QString::fromLatin1(name)).toStdString());
      QVERIFY2(std::abs(read.camera.fy() - 501) < 1e-9, name);
      QVERIFY2(std::abs(read.camera.distortionCoefficients()[1] + 0.05) < 1e-9, name);
    }
    QVERIFY(messageOf(panel).contains(QStringLiteral("9 formats")));
  }

  void OnlyWhatIsTicked_IsWritten()
  {
    ExportPanel panel;
    panel.setSources(sources_);
    panel.setFolder(folder_->filePath(QStringLiteral("some")));
    QTest::mouseClick(button(panel, "noneButton"), Qt::LeftButton);
    QVERIFY(panel.formats().isEmpty());
    QVERIFY(!button(panel, "exportButton")->isEnabled());
    panel.setFormats({ QStringLiteral("ros") });
    QVERIFY(panel.exportNow());
    QCOMPARE(panel.writtenFiles().size(), 1);
    QCOMPARE(QFileInfo(panel.writtenFiles()[0]).fileName(), QStringLiteral("camera_info_ros.yaml"));
    QTest::mouseClick(button(panel, "allButton"), Qt::LeftButton);
    QCOMPARE(panel.formats().size(), int(exportFormats().size()));
  }

  void OneFormatThatFails_IsNamed_AndTheOthersAreWritten()
  {
    ExportPanel panel;
    sources_.model = "/no/such/mesh.ply";
    panel.setSources(sources_);
    panel.setFolder(folder_->filePath(QStringLiteral("partly")));
    panel.setFormats({ QStringLiteral("mrml"), QStringLiteral("tfm") });
    QVERIFY(!panel.exportNow());
    QVERIFY2(messageOf(panel).contains(QStringLiteral("MRML")) && messageOf(panel).contains(QStringLiteral("mesh.ply")),
      qPrintable(messageOf(panel)));
    QVERIFY(messageOf(panel).contains(QStringLiteral("1 format written")));
    QCOMPARE(panel.writtenFiles().size(), 1);
  }

  void AFolderThatCannotBe_IsSaidInWords()
  {
    ExportPanel panel;
    panel.setSources(sources_);
    // Below a file there is no folder.
    panel.setFolder(folder_->filePath(QStringLiteral("calibration.json/export")));
    QVERIFY(!panel.exportNow());
    QVERIFY(messageOf(panel).contains(QStringLiteral("cannot be made")));
    QVERIFY(panel.writtenFiles().isEmpty());
  }

  void AnUnusableCalibration_IsNotExported()
  {
    QFile file(QString::fromStdString(sources_.calibration.string()));
    QVERIFY(file.open(QIODevice::WriteOnly));
    file.write(QByteArray(Calibration).replace("\"ok\"", "\"too_few_samples\""));
    file.close();
    ExportPanel panel;
    panel.setSources(sources_);
    panel.setFolder(folder_->filePath(QStringLiteral("none")));
    QVERIFY(!panel.exportNow());
    QVERIFY2(
      messageOf(panel).contains(QStringLiteral("calibration.json")) && messageOf(panel).contains(QStringLiteral("too_few_samples")),
      qPrintable(messageOf(panel)));
    QVERIFY(panel.writtenFiles().isEmpty());
  }

  void TheReport_IsAskedForWithItsFolder()
  {
    ExportPanel panel;
    panel.setFolder(folder_->path());
    QVERIFY(!button(panel, "reportButton")->isEnabled());
    QVERIFY(!button(panel, "reportButton")->toolTip().isEmpty());
    panel.setReportEnabled(true);
    QSignalSpy requested(&panel, &ExportPanel::reportRequested);
    button(panel, "reportButton")->click();
    QCOMPARE(requested.count(), 1);
    QCOMPARE(requested[0][0].toString(), folder_->path());
    panel.addWrittenFile(folder_->filePath(QStringLiteral("report.html")), QStringLiteral("Report"));
    QVERIFY(panel.findChild<QTextBrowser*>()->toPlainText().contains(QStringLiteral("report.html")));
  }

private:
  std::unique_ptr<QTemporaryDir> folder_;
  ExportSources sources_;
};

HANDEYE_WIDGET_TEST_MAIN(ExportPanelTest)
#include "ExportPanelTest.moc"
