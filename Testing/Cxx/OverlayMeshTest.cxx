// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the pipeline makes of a mesh: closed or not, without the half that cannot be seen, with edges that are short enough.
#include "OverlayMesh.h"

#include "ImageBaseline.h"
#include "OverlayRingScene.h"

#include <gtest/gtest.h>
#include <vtkAppendPolyData.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkReverseSense.h>
#include <vtkSphereSource.h>

#include <algorithm>
#include <thread>

using namespace handeye::test;

TEST(OverlayMesh, ClosedSurface_IsTold)
{
  const auto ball = [](double x)
  {
    vtkNew<vtkSphereSource> source;
    source->SetCenter(x, 0, 0);
    source->Update();
    return handeye::triangulatedWithNormals(source->GetOutput());
  };
  const auto both = [](vtkPolyData* a, vtkPolyData* b)
  {
    vtkNew<vtkAppendPolyData> append;
    append->AddInputData(a);
    append->AddInputData(b);
    append->Update();
    return vtkSmartPointer<vtkPolyData>(append->GetOutput());
  };
  vtkNew<vtkReverseSense> insideOut;
  insideOut->SetInputData(ball(3));
  insideOut->Update();
  vtkNew<vtkPolyData> open;
  open->DeepCopy(ball(0));
  open->BuildCells();
  open->DeleteCell(0);
  open->RemoveDeletedCells();
  EXPECT_TRUE(handeye::isClosedSurface(ball(0)));
  EXPECT_TRUE(handeye::isClosedSurface(both(ball(0), ball(3))));
  EXPECT_FALSE(handeye::isClosedSurface(open));
  EXPECT_FALSE(handeye::isClosedSurface(insideOut->GetOutput()));
  EXPECT_FALSE(handeye::isClosedSurface(both(ball(0), insideOut->GetOutput()))) << "one part of it is inside out";
  EXPECT_FALSE(handeye::isClosedSurface(vtkSmartPointer<vtkPolyData>::New()));
}

TEST(OverlayMesh, HalfThatCannotBeSeen_IsLeftOutUnseen)
{
  vtkNew<vtkSphereSource> ball;
  ball->SetRadius(40);
  ball->SetThetaResolution(60);
  ball->SetPhiResolution(60);
  ball->Update();
  // The same ball, but open at a place that is not seen: all of it is drawn.
  vtkNew<vtkSphereSource> openBall;
  openBall->SetRadius(40);
  openBall->SetThetaResolution(60);
  openBall->SetPhiResolution(60);
  openBall->Update();
  vtkSmartPointer<vtkPolyData> open = handeye::triangulatedWithNormals(openBall->GetOutput());
  ASSERT_TRUE(handeye::isClosedSurface(open));
  vtkIdType furthest = 0;
  double z = -1e9;
  for (vtkIdType cell = 0; cell < open->GetNumberOfCells(); ++cell)
  {
    double bounds[6];
    open->GetCellBounds(cell, bounds);
    furthest = bounds[4] > z ? cell : furthest;
    z = std::max(z, bounds[4]);
  }
  open->BuildCells();
  open->DeleteCell(furthest);
  open->RemoveDeletedCells();
  ASSERT_FALSE(handeye::isClosedSurface(open));
  const Pipeline pipeline = ringPipeline(webcam(), scene(640, 480));
  for (const double opacity : { 0.65, 1.0 })
  {
    pipeline->SetModelOpacity(opacity);
    pipeline->SetModelToCamera(handeye::toVtk(Eigen::Isometry3d(Eigen::Translation3d(10, -5, 180))));
    pipeline->SetModel(ball->GetOutput());
    const cv::Mat closed = rendered(pipeline), closedMask = renderedMask(pipeline);
    pipeline->SetModel(open);
    EXPECT_EQ(largestDifference(closedMask, renderedMask(pipeline)), 0);
    // At its rim front and back have the same depth, to 24 bits, and a little other shading.
    EXPECT_LE(largestDifference(closed, rendered(pipeline)), 12);
  }
  // From inside it is the far half that is seen.
  pipeline->SetModel(ball->GetOutput());
  pipeline->SetModelToCamera(handeye::toVtk(Eigen::Isometry3d(Eigen::Translation3d(0, 0, 5))));
  EXPECT_EQ(cv::countNonZero(renderedMask(pipeline)), 640 * 480);
}

TEST(OverlayMesh, Edges_AreShortEnoughForTheNearestDistance)
{
  const Pipeline pipeline = ringPipeline(laparoscope(), scene(720, 576));
  EXPECT_GT(pipeline->GetEdgeErrorPx(), 0);
  EXPECT_LE(pipeline->GetEdgeErrorPx(), 0.05 + 1e-9);
  const vtkIdType before = pipeline->GetModel()->GetNumberOfPolys();
  pipeline->SetNearestDistanceMm(20);
  EXPECT_LE(pipeline->GetEdgeErrorPx(), 0.05 + 1e-9);
  EXPECT_EQ(pipeline->GetModel()->GetNumberOfPolys(), before);
  pipeline->SetCameraModel(handeye::CameraModel(720, 576, laparoscope().cameraMatrix(), {}));
  EXPECT_NEAR(pipeline->GetEdgeErrorPx(), 0, 1e-6);
}

TEST(OverlayMesh, MadeReadyBeside_GivesTheSamePicture)
{
  const Pipeline pipeline = ringPipeline(laparoscope(), scene(720, 576));
  const cv::Mat before = rendered(pipeline);
  handeye::OverlayMesh ready;
  std::thread([&] { ready = handeye::prepareOverlayMesh(pipeline->GetModel()); }).join();
  EXPECT_TRUE(ready.isClosed);
  const vtkIdType triangles = ready.mesh->GetNumberOfPolys();
  const Pipeline other = ringPipeline(laparoscope(), scene(720, 576));
  other->SetPreparedModel(ready);
  EXPECT_EQ(other->GetModel(), ready.mesh);
  EXPECT_EQ(cv::norm(rendered(other), before, cv::NORM_INF), 0);
  EXPECT_LE(other->GetEdgeErrorPx(), 0.05 + 1e-9) << "it is still divided for the lens";
  EXPECT_EQ(ready.mesh->GetNumberOfPolys(), triangles) << "and not changed";
  // It is taken as it is: of one that says that it has no long edges none is divided.
  const Pipeline believing = ringPipeline(laparoscope(), scene(720, 576));
  believing->SetPreparedModel({ ready.mesh, 0, true });
  EXPECT_EQ(believing->GetEdgeErrorPx(), 0);
  // A mesh that changes afterwards is made ready anew.
  vtkNew<vtkSphereSource> ball;
  ball->SetRadius(20);
  ball->Update();
  ready.mesh->DeepCopy(ball->GetOutput());
  EXPECT_GT(cv::norm(rendered(other), before, cv::NORM_INF), 50);
  other->SetPreparedModel({});
  EXPECT_EQ(cv::countNonZero(renderedMask(other)), 0);
}
