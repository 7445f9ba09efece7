// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "EigenVtk.h"

#include <gtest/gtest.h>
#include <vtkImageData.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>

#include <limits>
#include <stdexcept>

namespace
{

Eigen::Isometry3d quarterTurnAboutZ()
{
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  transform.translation() << 10, 20, 30;
  return transform;
}

}  // namespace

TEST(EigenVtk, KnownPoint_IsMappedAlikeByBoth)
{
  const auto matrix = handeye::toVtk(quarterTurnAboutZ());
  const double point_A[4] = { 1, 2, 3, 1 };
  double point_B[4];
  matrix->MultiplyPoint(point_A, point_B);
  EXPECT_EQ(point_B[0], 8);
  EXPECT_EQ(point_B[1], 21);
  EXPECT_EQ(point_B[2], 33);
  EXPECT_TRUE((quarterTurnAboutZ() * Eigen::Vector3d(1, 2, 3)).isApprox(Eigen::Vector3d(8, 21, 33)));
}

TEST(EigenVtk, Matrices_SurviveTheRoundTrip)
{
  Eigen::Matrix4d numbers;
  numbers << 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16;
  vtkNew<vtkMatrix4x4> matrix;
  handeye::toVtk(numbers, matrix);
  EXPECT_EQ(matrix->GetElement(0, 3), 4);
  EXPECT_EQ(matrix->GetElement(3, 0), 13);
  EXPECT_EQ(handeye::toEigen(matrix), numbers);

  const auto rigid = handeye::toVtk(quarterTurnAboutZ());
  EXPECT_TRUE(handeye::toIsometry(rigid).isApprox(quarterTurnAboutZ(), 1e-12));
}

TEST(EigenVtk, NonRigidMatrix_IsRefusedAsIsometry)
{
  vtkNew<vtkMatrix4x4> matrix;
  matrix->SetElement(0, 0, 2);
  EXPECT_THROW(static_cast<void>(handeye::toIsometry(matrix)), std::invalid_argument);
  matrix->SetElement(0, 0, -1);
  EXPECT_THROW(static_cast<void>(handeye::toIsometry(matrix)), std::invalid_argument);
  matrix->SetElement(0, 0, std::numeric_limits<double>::quiet_NaN());
  EXPECT_THROW(static_cast<void>(handeye::toIsometry(matrix)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(handeye::toIsometry(nullptr)), std::invalid_argument);
  EXPECT_THROW(handeye::toVtk(quarterTurnAboutZ(), nullptr), std::invalid_argument);
}

TEST(EigenVtk, Picture_HasItsFirstRowOnTopAndItsColours)
{
  cv::Mat picture(2, 3, CV_8UC3, cv::Scalar(0, 0, 0));
  picture.at<cv::Vec3b>(0, 0) = { 255, 10, 20 };  // blue, top left
  vtkNew<vtkImageData> image;
  handeye::toVtk(picture, image);
  ASSERT_EQ(image->GetDimensions()[0], 3);
  ASSERT_EQ(image->GetDimensions()[1], 2);
  const auto* topLeft = static_cast<unsigned char*>(image->GetScalarPointer(0, 1, 0));
  EXPECT_EQ(topLeft[0], 20);
  EXPECT_EQ(topLeft[1], 10);
  EXPECT_EQ(topLeft[2], 255);
}

TEST(EigenVtk, Pictures_SurviveTheRoundTripAndReuseTheImage)
{
  cv::Mat first(48, 65, CV_8UC3), second(48, 65, CV_8UC3);
  cv::randu(first, 0, 256);
  cv::randu(second, 0, 256);
  vtkNew<vtkImageData> image;
  handeye::toVtk(first, image);
  EXPECT_EQ(cv::norm(handeye::toOpenCV(image), first, cv::NORM_INF), 0);
  const void* memory = image->GetScalarPointer();
  const vtkMTimeType before = image->GetMTime();
  handeye::toVtk(second, image);
  EXPECT_EQ(image->GetScalarPointer(), memory);
  EXPECT_GT(image->GetMTime(), before);
  EXPECT_EQ(cv::norm(handeye::toOpenCV(image), second, cv::NORM_INF), 0);
  const cv::Mat smaller = first(cv::Rect(3, 5, 20, 10));
  handeye::toVtk(smaller, image);
  EXPECT_EQ(cv::norm(handeye::toOpenCV(image), smaller, cv::NORM_INF), 0);
}

TEST(EigenVtk, GreyAndAlpha_BecomeColour)
{
  vtkNew<vtkImageData> image;
  handeye::toVtk(cv::Mat(4, 4, CV_8UC1, cv::Scalar(77)), image);
  EXPECT_EQ(cv::norm(handeye::toOpenCV(image), cv::Mat(4, 4, CV_8UC3, cv::Scalar(77, 77, 77)), cv::NORM_INF), 0);
  handeye::toVtk(cv::Mat(4, 4, CV_8UC4, cv::Scalar(1, 2, 3, 4)), image);
  EXPECT_EQ(cv::norm(handeye::toOpenCV(image), cv::Mat(4, 4, CV_8UC3, cv::Scalar(1, 2, 3)), cv::NORM_INF), 0);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 1);
  *static_cast<unsigned char*>(image->GetScalarPointer(0, 3, 0)) = 9;
  EXPECT_EQ(handeye::toOpenCV(image).at<cv::Vec3b>(0, 0), cv::Vec3b(9, 9, 9));
}

TEST(EigenVtk, OtherPictures_AreRefused)
{
  vtkNew<vtkImageData> image;
  EXPECT_THROW(handeye::toVtk(cv::Mat(), image), std::invalid_argument);
  EXPECT_THROW(handeye::toVtk(cv::Mat(4, 4, CV_16UC3), image), std::invalid_argument);
  EXPECT_THROW(handeye::toVtk(cv::Mat(4, 4, CV_8UC2), image), std::invalid_argument);
  EXPECT_THROW(handeye::toVtk(cv::Mat(4, 4, CV_8UC3), nullptr), std::invalid_argument);
  EXPECT_THROW(handeye::toOpenCV(image), std::invalid_argument);
  EXPECT_THROW(handeye::toOpenCV(nullptr), std::invalid_argument);
  image->SetDimensions(4, 4, 2);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  EXPECT_THROW(handeye::toOpenCV(image), std::invalid_argument);
  image->SetDimensions(4, 4, 1);
  image->AllocateScalars(VTK_FLOAT, 3);
  EXPECT_THROW(handeye::toOpenCV(image), std::invalid_argument);
}
