// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "RoomPhantom.h"
#include "EigenVtk.h"
#include "FileError.h"
#include "MeshReader.h"
#include "SimulatedRoom.h"
#include "VideoView.h"
#include "WidgetTestSupport.h"
#include "vtkHandEyeOverlayPipeline.h"

#include <QtTest>
#include <vtkMatrix4x4.h>
#include <vtkPolyData.h>

using namespace handeye;

/// The phantom of the simulated room and the model that is drawn over it are two programs' work; they have to agree.
class RoomPhantomTest : public QObject
{
  Q_OBJECT

private slots:
  void roomsVertebra_CoversWhatTheOverlayCovers();
  void vertebra_HasNothingThatIsRed();
  void fileThatIsNone_IsRefused();

private:
  const std::filesystem::path file_ = HANDEYE_RESOURCES_DIR "/Meshes/Vertebra.ply";
};

void RoomPhantomTest::roomsVertebra_CoversWhatTheOverlayCovers()
{
  simulation::RoomOptions room;
  // A lens that bends more than the room's own, and the phantom where that is seen.
  const CameraModel camera(640, 480, room.camera.cameraMatrix(), { -0.28, 0.09, 0.001, -0.002, 0 });
  Eigen::Isometry3d modelToCamera = Eigen::Isometry3d::Identity();
  modelToCamera.linear() = Eigen::AngleAxisd(1.9, Eigen::Vector3d(1, 0.3, -0.4).normalized()).toRotationMatrix();
  modelToCamera.translation() = Eigen::Vector3d(-75, 45, 260);

  VideoView view;
  testing_widgets::show(view, { 640, 480 });
  vtkHandEyeOverlayPipeline* const pipeline = view.pipeline();
  pipeline->SetCameraModel(camera);
  pipeline->SetModel(readMesh(file_));
  pipeline->SetModelToCamera(toVtk(modelToCamera));
  pipeline->SetModelVisible(true);
  pipeline->SetMaskMode(true);
  view.setFrame(cv::Mat(480, 640, CV_8UC3, cv::Scalar::all(0)));
  QTest::qWait(500);
  cv::Mat overlay;
  QVERIFY(view.readShown(overlay));
  QCOMPARE(overlay.cols, 640);

  cv::Mat light(480, 640, CV_32FC3, cv::Scalar::all(0));
  simulation::drawMesh(light, camera, *readRoomMesh(file_), modelToCamera);
  int both = 0, either = 0;
  for (int row = 0; row < light.rows; ++row)
  {
    for (int column = 0; column < light.cols; ++column)
    {
      const bool isDrawn = light.at<cv::Vec3f>(row, column)[1] > 0.06F, isCovered = overlay.at<cv::Vec3b>(row, column)[1] > 127;
      both += isDrawn && isCovered ? 1 : 0;
      either += isDrawn || isCovered ? 1 : 0;
    }
  }
  qInfo("%d px are covered by both, %d by either", both, either);
  QVERIFY(both > 10000);
  QVERIFY(both > 0.98 * either);  // the outline's pixels, which are half covered, are one or the other
}

void RoomPhantomTest::vertebra_HasNothingThatIsRed()
{
  simulation::RoomOptions options;
  options.imageNoise = 0;
  const simulation::SimulatedRoom without(options);
  options.phantomMesh = readRoomMesh(file_);
  options.landmarks_Model = { { 0.445, -65.43, -15.757 }, { 42.2, -35.8, 1.5 } };
  const simulation::SimulatedRoom with(options);
  const auto countRed = [](const cv::Mat& picture)
  {
    int red = 0;
    for (int row = 0; row < picture.rows; ++row)
    {
      for (int column = 0; column < picture.cols; ++column)
      {
        const cv::Vec3b pixel = picture.at<cv::Vec3b>(row, column);
        red += pixel[2] > 1.6 * pixel[1] && pixel[2] > 1.6 * pixel[0] ? 1 : 0;
      }
    }
    return red;
  };
  QVERIFY(cv::norm(with.picture(1), without.picture(1), cv::NORM_INF) > 30);
  QVERIFY(countRed(with.picture(1)) <= countRed(without.picture(1)));
}

void RoomPhantomTest::fileThatIsNone_IsRefused()
{
  QVERIFY_EXCEPTION_THROWN(readRoomMesh("/nowhere/bone.ply"), io::FileError);
}

HANDEYE_WIDGET_TEST_MAIN(RoomPhantomTest)

#include "RoomPhantomTest.moc"
