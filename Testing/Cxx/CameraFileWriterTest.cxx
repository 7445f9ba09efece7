// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CameraFileWriter.h"
#include "IoTestSupport.h"
#include "NamedTransform.h"
#include "Simulation.h"
#include "TestCameras.h"

#include <opencv2/core.hpp>

namespace
{

using namespace handeye;
using namespace handeye::io;
using handeye::test::typicalMarkerToCamera;
using io::test::TemporaryFolder;

CameraFile exampleCamera()
{
  return { handeye::test::webcam(), typicalMarkerToCamera(), "", {} };
}

struct Case
{
  const char* name;
  CameraFormat format;
  const char* file;
  const char* readAs;
  bool hasSize, hasMarker;
};

class EachFormat : public ::testing::TestWithParam<Case>
{
};

TEST_P(EachFormat, ReadsBackTheSameNumbers)
{
  const TemporaryFolder folder;
  const CameraFile camera = exampleCamera();
  std::vector<std::string> warnings;
  const auto files = writeCameraFile(folder.path() / GetParam().file, camera, GetParam().format, warnings);
  const CameraFile back = readCameraFile(files.at(0));
  EXPECT_EQ(back.format, GetParam().readAs);
  EXPECT_EQ(back.camera.cameraMatrix(), camera.camera.cameraMatrix());
  EXPECT_EQ(back.camera.distortionCoefficients(), camera.camera.distortionCoefficients());
  EXPECT_EQ(back.camera.width(), GetParam().hasSize ? 640 : 0);
  ASSERT_EQ(back.markerToCamera.has_value(), GetParam().hasMarker);
  if (back.markerToCamera)
  {
    EXPECT_LT((back.markerToCamera->matrix() - camera.markerToCamera->matrix()).norm(), 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(CameraFileWriter, EachFormat,
  ::testing::Values(Case{ "yaml", CameraFormat::OpenCV, "camera.yml", "OpenCV", true, true },
    Case{ "xml", CameraFormat::OpenCV, "camera.xml", "OpenCV", true, true },
    Case{ "pinhole", CameraFormat::PinholeXml, "camera.xml", "SlicerPinholeCameras", false, true },
    Case{ "vasst", CameraFormat::Vasst, "camera.xml", "VASST", false, false },
    Case{ "ros", CameraFormat::Ros, "camera.yaml", "ROS", true, false },
    Case{ "text", CameraFormat::SurgeryText, "calib.left.intrinsics.txt", "text", false, false },
    Case{ "json", CameraFormat::Json, "camera.json", "calibration.json", true, true }),
  [](const auto& parameter) { return parameter.param.name; });

/// The peer's own reader, of what is in OpenCV's format.
void expectOpenCVReads(const std::filesystem::path& path, const std::string& matrixKey, const std::string& coefficientsKey)
{
  cv::FileStorage storage(path.string(), cv::FileStorage::READ);
  ASSERT_TRUE(storage.isOpened());
  cv::Mat matrix, coefficients, marker;
  storage[matrixKey] >> matrix;
  storage[coefficientsKey] >> coefficients;
  storage["MarkerToSensor"] >> marker;
  const CameraFile camera = exampleCamera();
  ASSERT_EQ(matrix.size(), cv::Size(3, 3));
  ASSERT_EQ(coefficients.size(), cv::Size(1, 5));  // N x 1
  ASSERT_EQ(marker.size(), cv::Size(4, 4));
  EXPECT_EQ(matrix.at<double>(0, 2), camera.camera.cx());
  EXPECT_EQ(coefficients.at<double>(1), camera.camera.distortionCoefficients()[1]);
  EXPECT_EQ(marker.at<double>(1, 3), camera.markerToCamera->translation().y());
}

TEST(CameraFileWriter, OpenCV_ReadsItsOwnFormats)
{
  const TemporaryFolder folder;
  std::vector<std::string> warnings;
  for (const char* name : { "camera.yml", "camera.xml" })
  {
    expectOpenCVReads(writeCameraFile(folder.path() / name, exampleCamera(), CameraFormat::OpenCV, warnings)[0], "camera_matrix",
      "distortion_coefficients");
  }
  EXPECT_TRUE(warnings.empty());
  expectOpenCVReads(writeCameraFile(folder.path() / "pinhole.xml", exampleCamera(), CameraFormat::PinholeXml, warnings)[0],
    "IntrinsicMatrix", "DistortionCoefficients");
}

TEST(CameraFileWriter, PinholeXml_SaysWhatItsReaderDoes)
{
  const TemporaryFolder folder;
  std::vector<std::string> warnings;
  const auto files = writeCameraFile(folder.path() / "pinhole.xml", exampleCamera(), CameraFormat::PinholeXml, warnings);
  EXPECT_TRUE(io::test::hasWarning(warnings, "CameraPlaneOffset"));
  EXPECT_NE(io::test::readBytes(files[0]).find("overwrites DistortionCoefficients"), std::string::npos);
}

TEST(CameraFileWriter, SurgeryText_HasTheMarkerInASecondFile)
{
  const TemporaryFolder folder;
  std::vector<std::string> warnings;
  const auto files =
    writeCameraFile(folder.path() / "calib.left.intrinsics.txt", exampleCamera(), CameraFormat::SurgeryText, warnings);
  ASSERT_EQ(files.size(), 2U);
  EXPECT_EQ(files[1].filename(), "calib.left.handeye.txt");
  EXPECT_LT((readTransform(files[1], "").matrix() - typicalMarkerToCamera().matrix()).norm(), 1e-12);
}

TEST(CameraFileWriter, Ros_IsInMetres)
{
  const TemporaryFolder folder;
  std::vector<std::string> warnings;
  const auto files = writeCameraFile(folder.path() / "camera.yaml", exampleCamera(), CameraFormat::Ros, warnings);
  const std::string text = io::test::readBytes(files[0]);
  EXPECT_NE(text.find("metres"), std::string::npos);
  std::istringstream numbers(text.substr(text.find("marker_to_camera (m): ") + 22));
  double entry = 0;
  for (int i = 0; i < 4; ++i)
  {
    numbers >> entry;
  }
  EXPECT_DOUBLE_EQ(entry, 0.018);  // the x of 18 mm
}

TEST(CameraFileWriter, WhatAFormatCannotHold_IsRefused)
{
  const TemporaryFolder folder;
  std::vector<std::string> warnings;
  CameraFile camera = exampleCamera();
  camera.markerToCamera.reset();
  io::test::expectFileError(
    [&] { writeCameraFile(folder.path() / "a.xml", camera, CameraFormat::PinholeXml, warnings); }, { "a.xml", "marker" });
  camera.camera = handeye::test::tilted();
  io::test::expectFileError([&] { writeCameraFile(folder.path() / "a.yaml", camera, CameraFormat::Ros, warnings); }, { "8", "14" });
  camera.camera = CameraModel(0, 0, handeye::test::webcam().cameraMatrix(), {});
  io::test::expectFileError([&] { writeCameraFile(folder.path() / "a.yml", camera, CameraFormat::OpenCV, warnings); }, { "width" });
  EXPECT_EQ(folder.entryCount(), 0U);
}

}  // namespace
