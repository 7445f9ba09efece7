// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the camera cannot see, or sees only in part: behind it, around it, and where the lens' formula would fold back.
#include "OverlayOracle.h"

#include <gtest/gtest.h>
#include <vtkNew.h>
#include <vtkSphereSource.h>

#include <algorithm>
#include <cmath>
#include <iostream>

namespace
{

using namespace handeye::test;

class OverlayFrustum : public testing::TestWithParam<Lens>
{
};

}  // namespace

TEST_P(OverlayFrustum, FloorOfTwoTriangles_FromBehindTheCameraToFar_IsBentAndNotSmeared)
{
  // The largest triangles there can be: a floor 40 mm under the camera that begins behind it.
  constexpr double floorY = 40, halfWidth = 45, behind = -200, far = 500, nearPlane = 1;
  const Lens lens = GetParam();
  MeshInCamera floor;
  const vtkIdType a = floor.add({ -halfWidth, floorY, behind }), b = floor.add({ halfWidth, floorY, behind }),
                  c = floor.add({ halfWidth, floorY, far }), d = floor.add({ -halfWidth, floorY, far });
  floor.face({ a, b, c });
  floor.face({ a, c, d });
  const auto pipeline = maskPipeline(lens, floor.mesh());
  cv::Mat picture;
  pipeline->RenderToImage(picture);
  // Promised for a distance of 50 mm; the floor begins nearer, and for some lenses a million triangles do not suffice for 0.05 px.
  EXPECT_LT(pipeline->GetEdgeErrorPx(), 0.25);
  const cv::Mat mask = grey(picture);
  int wrong = 0, inside = 0;
  for (int v = 0; v < lens.height; v += 3)
  {
    for (int u = 0; u < lens.width; u += 3)
    {
      Eigen::Vector2d seen;
      if (!lens.seenAt({ double(u), double(v) }, seen))
      {
        continue;
      }
      const double z = floorY / seen.y();
      const double x = seen.x() * z;
      // Pixels whose centre is within 0.1 px or so of the floor's outline may be either.
      const double border = 0.15 * std::max(z, 1.0) / lens.fx;
      const double farBorder = 0.15 * z * z / floorY / lens.fy;
      if (std::abs(std::abs(x) - halfWidth) < border || std::abs(z - far) < farBorder)
      {
        continue;
      }
      const bool expected = z > nearPlane && z < far && std::abs(x) < halfWidth;
      inside += expected;
      wrong += expected != (mask.at<uchar>(v, u) != 0);
    }
  }
  std::cout << lens.name << ": " << inside << " pixels of the floor looked at, " << wrong << " wrong\n";
  EXPECT_GT(inside, 1000);
  EXPECT_EQ(wrong, 0);
}

INSTANTIATE_TEST_SUITE_P(Lenses, OverlayFrustum, testing::ValuesIn(allLenses), [](const auto& lens) { return lens.param.name; });

TEST(OverlayFrustum, FarOffTheAxis_NothingFoldsBackIntoThePicture)
{
  for (const Lens& lens : { barrelLens, laparoscopeLens, wideLens })
  {
    int foldedByArithmetic = 0;
    for (double angle = 0; angle < 6.2; angle += 0.26)
    {
      for (const double radius : { 1.35, 1.45, 1.58, 1.7, 2.2, 4.0, 15.0 })
      {
        const double x = radius * std::cos(angle), y = radius * std::sin(angle);
        const Eigen::Vector2d naive = lens.pixel(x, y);
        foldedByArithmetic += naive.x() > 0 && naive.y() > 0 && naive.x() < lens.width && naive.y() < lens.height;
        MeshInCamera mesh;
        mesh.disc(200 * Eigen::Vector3d(x, y, 1), 4);
        cv::Mat picture;
        maskPipeline(lens, mesh.mesh())->RenderToImage(picture);
        ASSERT_EQ(cv::countNonZero(grey(picture)), 0) << lens.name << " at " << x << ", " << y;
      }
      angle += 0.7;
    }
    std::cout << lens.name << ": " << foldedByArithmetic << " of the markers would have folded back\n";
    EXPECT_TRUE(lens.name != "StrongBarrel" || foldedByArithmetic > 0);
  }
}

TEST(OverlayFrustum, LargeMeshAroundTheView_LeavesThePictureFree)
{
  // A ring around the axis, from just outside the picture to beside the camera: every vertex is outside, at folding radii too.
  for (const Lens& lens : { barrelLens, laparoscopeLens, webcamLens, wideLens })
  {
    MeshInCamera ring;
    constexpr int sides = 12;
    for (int i = 0; i < sides; ++i)
    {
      const double angle = 2 * M_PI * i / sides;
      const Eigen::Vector3d outward(std::cos(angle), std::sin(angle), 0);
      ring.add(400 * outward + Eigen::Vector3d(0, 0, 200));
      ring.add(2000 * outward + Eigen::Vector3d(0, 0, 5));
    }
    for (int i = 0; i < sides; ++i)
    {
      const vtkIdType here = 2 * i, next = 2 * ((i + 1) % sides);
      ring.face({ here, here + 1, next + 1 });
      ring.face({ here, next + 1, next });
    }
    cv::Mat picture;
    maskPipeline(lens, ring.mesh())->RenderToImage(picture);
    EXPECT_EQ(cv::countNonZero(grey(picture)), 0) << lens.name;
  }
}

TEST(OverlayFrustum, BehindTheCamera_NothingIsDrawn)
{
  for (const Lens& lens : allLenses)
  {
    for (const Eigen::Vector3d& centre :
      { Eigen::Vector3d(0, 0, -200), Eigen::Vector3d(60, -40, -300), Eigen::Vector3d(0, 0, -31) })
    {
      vtkNew<vtkSphereSource> sphere;
      sphere->SetRadius(30);
      sphere->SetThetaResolution(40);
      sphere->SetPhiResolution(40);
      const Eigen::Vector3d centre_Model = somePose().inverse() * centre;
      sphere->SetCenter(centre_Model.x(), centre_Model.y(), centre_Model.z());
      sphere->Update();
      cv::Mat picture;
      maskPipeline(lens, sphere->GetOutput())->RenderToImage(picture);
      EXPECT_EQ(cv::countNonZero(grey(picture)), 0) << lens.name << " at Z = " << centre.z();
    }
  }
}

TEST(OverlayFrustum, AroundTheCamera_EverythingIsCovered)
{
  // The camera is inside of the mesh: wherever the lens model reaches, there is wall.
  vtkNew<vtkSphereSource> sphere;
  sphere->SetRadius(120);
  sphere->SetThetaResolution(60);
  sphere->SetPhiResolution(60);
  const Eigen::Vector3d centre_Model = somePose().inverse() * Eigen::Vector3d(10, -5, 20);
  sphere->SetCenter(centre_Model.x(), centre_Model.y(), centre_Model.z());
  sphere->Update();
  for (const Lens& lens : { webcamLens, laparoscopeLens })
  {
    cv::Mat picture;
    maskPipeline(lens, sphere->GetOutput())->RenderToImage(picture);
    EXPECT_EQ(cv::countNonZero(grey(picture)), lens.width * lens.height) << lens.name;
  }
}
