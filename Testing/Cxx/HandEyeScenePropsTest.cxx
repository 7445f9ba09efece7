// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeSceneProps.h"

#include "CameraModel.h"
#include "WidgetTestSupport.h"

#include <vtkActor.h>
#include <vtkBoundingBox.h>
#include <vtkCamera.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkMapper.h>
#include <vtkNew.h>
#include <vtkPropCollection.h>
#include <vtkRenderer.h>
#include <vtkSphereSource.h>

#include <cmath>
#include <stdexcept>

using namespace handeye;

namespace
{

CameraModel cameraOf(const std::vector<double>& distortion = {})
{
  Eigen::Matrix3d matrix;
  matrix << 500, 0, 319.5, 0, 500, 239.5, 0, 0, 1;
  return { 640, 480, matrix, distortion };
}

Eigen::Isometry3d poseOf(double x, double y, double z, double turn = 0)
{
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitY()).toRotationMatrix();
  pose.translation() = Eigen::Vector3d(x, y, z);
  return pose;
}

/// Of everything that is seen, in the tracker's frame.
vtkBoundingBox visibleBounds(vtkRenderer* renderer)
{
  return vtkBoundingBox(renderer->ComputeVisiblePropBounds());
}

bool isNear(double value, double expected, double tolerance)
{
  return std::abs(value - expected) < tolerance;
}

}  // namespace

class HandEyeScenePropsTest : public QObject
{
  Q_OBJECT

private slots:
  void WithoutPoses_OnlyTheTrackerIsSeen()
  {
    HandEyeSceneProps props;
    vtkNew<vtkRenderer> renderer;
    props.addTo(renderer);
    props.setCameraModel(cameraOf());
    props.setStylusTip(Eigen::Vector3d(0, 0, -150), 15);
    props.setCapturedPoints({ { Eigen::Vector3d(1000, 0, 0), 0.5, true } });
    props.setNextPlace(Eigen::Vector3d(0, 0, 5000));
    QVERIFY(!props.isCameraVisible() && !props.isStylusVisible() && !props.isPhantomVisible());
    QVERIFY(visibleBounds(renderer).GetMaxLength() < 700);
    props.setTrackerVisible(false);
    QVERIFY(!visibleBounds(renderer).IsValid());
  }

  void TheFrustum_IsWhereTheCameraLooks()
  {
    HandEyeSceneProps props;
    vtkNew<vtkRenderer> renderer;
    props.addTo(renderer);
    props.setTrackerVisible(false);
    props.setCameraModel(cameraOf(), 500);
    const Eigen::Isometry3d markerToTracker = poseOf(100, 200, 300, 0.4);
    const Eigen::Isometry3d markerToCamera = poseOf(10, -40, 20, -0.2);
    props.setMarkerToTracker(markerToTracker);
    QVERIFY(!props.isCameraVisible());  // there is a marker, and no calibration
    props.setMarkerToCamera(markerToCamera);
    QVERIFY(props.isCameraVisible());
    // The image's corners at the frustum's depth, by plain arithmetic.
    const Eigen::Isometry3d cameraToTracker = markerToTracker * markerToCamera.inverse();
    double largestX = -1e9, largestZ = -1e9;
    for (const double u : { -320.0, 320.0 })
    {
      for (const double v : { -240.0, 240.0 })
      {
        const Eigen::Vector3d corner_Tracker = cameraToTracker * Eigen::Vector3d(u, v, 500);
        largestX = std::max(largestX, corner_Tracker.x());
        largestZ = std::max(largestZ, corner_Tracker.z());
      }
    }
    const vtkBoundingBox box = visibleBounds(renderer);
    QVERIFY(isNear(box.GetBound(1), largestX, 1e-3));
    QVERIFY(isNear(box.GetBound(5), largestZ, 1e-3));
  }

  void AHiddenTool_IsNotShownWhereItLastWas()
  {
    HandEyeSceneProps props;
    vtkNew<vtkRenderer> renderer;
    props.addTo(renderer);
    props.setTrackerVisible(false);
    props.setStylusTip(Eigen::Vector3d(0, 0, -150), 15);
    props.setStylusToTracker(poseOf(500, 0, -1000));
    QVERIFY(props.isStylusVisible());
    // The ball about the tip: 15 mm around (500, 0, -1150).
    QVERIFY(isNear(visibleBounds(renderer).GetBound(4), -1165, 0.2));
    props.setStylusToTracker(std::nullopt);
    QVERIFY(!props.isStylusVisible());
    QVERIFY(!visibleBounds(renderer).IsValid());
    props.setStylusToTracker(poseOf(0, 0, -1000));
    props.setStylusTip(std::nullopt, 15);
    QVERIFY(!props.isStylusVisible());  // the marker stays
    QVERIFY(visibleBounds(renderer).IsValid());
  }

  void CapturedPoints_MoveWithTheCamerasMarker()
  {
    HandEyeSceneProps props;
    vtkNew<vtkRenderer> renderer;
    props.addTo(renderer);
    props.setTrackerVisible(false);
    props.setCapturedPoints({ { Eigen::Vector3d(0, 0, 400), 0.2, true }, { Eigen::Vector3d(300, 0, 200), std::nullopt, false } });
    props.setMarkerToTracker(poseOf(1000, 0, 0));
    vtkBoundingBox box = visibleBounds(renderer);
    QVERIFY(isNear(box.GetBound(5), 406, 0.5));
    QVERIFY(isNear(box.GetBound(1), 1303, 3.1));  // 3.5 to 6: the mapper's bounds take the largest ball for all
    props.setMarkerToTracker(poseOf(1000, 0, 50));
    box = visibleBounds(renderer);
    QVERIFY(isNear(box.GetBound(5), 456, 0.5));
    props.setCapturedPoints({});
    QVERIFY(visibleBounds(renderer).GetBound(5) < 120);
  }

  void ThePhantom_NeedsItsMarkerItsMeshAndItsRegistration()
  {
    HandEyeSceneProps props;
    vtkNew<vtkRenderer> renderer;
    props.addTo(renderer);
    props.setTrackerVisible(false);
    vtkNew<vtkSphereSource> sphere;
    sphere->SetRadius(25);
    sphere->Update();
    props.setPhantomMesh(sphere->GetOutput());
    props.setPhantomToTracker(poseOf(0, 0, -900));
    QVERIFY(!props.isPhantomVisible());
    props.setModelToPhantom(poseOf(0, 200, 0));
    QVERIFY(props.isPhantomVisible());
    QVERIFY(isNear(visibleBounds(renderer).GetBound(3), 225, 1));
    props.setPhantomToTracker(std::nullopt);
    QVERIFY(!props.isPhantomVisible());
    props.setPhantomToTracker(poseOf(0, 0, -900));
    props.setPhantomMesh(nullptr);
    QVERIFY(!props.isPhantomVisible());
  }

  void ItIsSeen_AndResidualsHaveTheirColours()
  {
    QVTKOpenGLNativeWidget widget;
    vtkNew<vtkGenericOpenGLRenderWindow> window;
    widget.setRenderWindow(window);
    vtkNew<vtkRenderer> renderer;
    window->AddRenderer(renderer);
    HandEyeSceneProps props;
    props.addTo(renderer);
    props.setTrackerVisible(false);
    props.setMarkerToTracker(poseOf(0, 0, 0));
    props.setResidualScalePx(2);
    props.setCapturedPoints({ { Eigen::Vector3d(-100, 100, 0), 0.0, true }, { Eigen::Vector3d(100, 100, 0), 5.0, true } });
    renderer->GetActiveCamera()->SetPosition(0, 60, 600);
    renderer->GetActiveCamera()->SetFocalPoint(0, 60, 0);
    renderer->ResetCameraClippingRange();
    testing_widgets::show(widget, { 400, 300 });
    const QImage seen = widget.grabFramebuffer();
    const auto colorAt = [&](double x, double y, double z)
    {
      renderer->SetWorldPoint(x, y, z, 1);
      renderer->WorldToDisplay();
      double display[3];
      renderer->GetDisplayPoint(display);
      return seen.pixelColor(int(display[0]), seen.height() - 1 - int(display[1]));
    };
    const QColor good = colorAt(-100, 100, 6), bad = colorAt(100, 100, 6);
    QVERIFY2(good.green() > good.red() + 40, qPrintable(good.name()));
    QVERIFY2(bad.red() > bad.green() + 60, qPrintable(bad.name()));
  }

  void TakenOut_NothingIsLeftBehind()
  {
    vtkNew<vtkRenderer> first, second;
    {
      HandEyeSceneProps props;
      props.addTo(first);
      QVERIFY(first->GetViewProps()->GetNumberOfItems() > 0);
      props.addTo(second);
      QCOMPARE(first->GetViewProps()->GetNumberOfItems(), 0);
      QVERIFY(second->GetViewProps()->GetNumberOfItems() > 0);
    }
    QCOMPARE(second->GetViewProps()->GetNumberOfItems(), 0);
  }

  void NumbersThatAreNone_AreRefused()
  {
    HandEyeSceneProps props;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation().x() = NAN;
    QVERIFY_EXCEPTION_THROWN(props.setMarkerToTracker(pose), std::invalid_argument);
    QVERIFY_EXCEPTION_THROWN(props.setStylusTip(Eigen::Vector3d(0, 0, 1), 0), std::invalid_argument);
    QVERIFY_EXCEPTION_THROWN(props.setCapturedPoints({ { Eigen::Vector3d(0, NAN, 0), 1.0, true } }), std::invalid_argument);
    QVERIFY_EXCEPTION_THROWN(props.setCameraModel(CameraModel(0, 0, cameraOf().cameraMatrix(), {})), std::invalid_argument);
  }
};

HANDEYE_WIDGET_TEST_MAIN(HandEyeScenePropsTest)
#include "HandEyeScenePropsTest.moc"
