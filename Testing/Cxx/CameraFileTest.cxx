// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CameraFile.h"

#include "IoTestSupport.h"

#include <opencv2/core/persistence.hpp>

#include <locale>

using namespace handeye::io;
using namespace handeye::io::test;

namespace
{

const cv::Matx33d Intrinsics(601.7, 0, 316.2, 0, 602.9, 244.8, 0, 0, 1);
const std::vector<double> Lens = { 0.041, -0.112, -0.0007, 0.0011, 0.02 };

const std::string RosText = "# written by hand\nimage_width: 640\nimage_height: 480\ncamera_name: 'left eye'\ncamera_matrix:\n"
                            "  rows: 3\n  cols: 3\n  data: [601.7, 0, 316.2, 0, 602.9, 244.8, 0, 0, 1]\n"
                            "distortion_model: plumb_bob\ndistortion_coefficients:\n  rows: 1\n  cols: 5\n"
                            "  data: [0.041, -0.112, -0.0007,\n         0.0011, 0.02]\n"
                            "rectification_matrix:\n  rows: 3\n  cols: 3\n  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]\n";

const std::string CalibrationText = R"({"camera": {"width": 640, "height": 480,
  "cameraMatrix": [[601.7, 0, 316.2], [0, 602.9, 244.8], [0, 0, 1]],
  "distortionCoefficients": [0.041, -0.112, -0.0007, 0.0011, 0.02]},
  "markerToCamera": [[0, -1, 0, 5], [1, 0, 0, 6], [0, 0, 1, 7], [0, 0, 0, 1]], "status": "ok"})";

void expectTheCamera(const CameraFile& file, const std::string& format, bool hasSize = true)
{
  EXPECT_EQ(file.format, format);
  EXPECT_EQ(file.camera.width(), hasSize ? 640 : 0);
  EXPECT_EQ(file.camera.height(), hasSize ? 480 : 0);
  for (int i = 0; i < 9; ++i)
  {
    EXPECT_EQ(file.camera.cameraMatrix()(i / 3, i % 3), Intrinsics(i / 3, i % 3));
  }
  EXPECT_EQ(file.camera.distortionCoefficients(), Lens);
}

void expectRefused(const std::string& text, const std::vector<std::string>& words)
{
  const TemporaryFolder folder;
  const auto path = folder.write("camera.txt", text);
  expectFileError([&] { (void)readCameraFile(path); }, words);
}

std::string replaced(std::string text, const std::string& from, const std::string& to)
{
  const std::size_t found = text.find(from);
  EXPECT_NE(found, std::string::npos) << from;
  return text.replace(found, from.size(), to);
}

}  // namespace

/// Written by OpenCV itself, in all its formats, with what its calibration sample puts beside the camera.
TEST(CameraFile, OpenCV_ReadsWhatFileStorageWrites)
{
  const TemporaryFolder folder;
  for (const std::string ending : { ".yml", ".xml", ".json" })
  {
    for (const bool isCapital : { false, true })
    {
      const auto path = folder.path() / ("camera" + ending);
      {
        cv::FileStorage storage(path.string(), cv::FileStorage::WRITE);
        storage << "calibration_time"
                << "Tue 03 Jun 2025 10:11:12 AM CEST: \"morning\"";
        storage << "nr_of_frames" << 20 << "flags" << 4;
        storage << (isCapital ? "image_Width" : "image_width") << 640 << (isCapital ? "image_Height" : "image_height") << 480;
        storage.writeComment("flags: +fix_k4 +fix_k5");
        storage << (isCapital ? "Camera_Matrix" : "camera_matrix") << cv::Mat(Intrinsics);
        storage << (isCapital ? "Distortion_Coefficients" : "distortion_coefficients") << cv::Mat(Lens);
        storage << "avg_reprojection_error" << 0.123;
        storage << "per_view_reprojection_errors" << cv::Mat(cv::Mat::ones(20, 1, CV_32F));
        storage << "image_points" << cv::Mat(3, 40, CV_32FC2, cv::Scalar(1.5, 2.5));
        storage << "names"
                << "["
                << "a"
                << "b"
                << "]"
                << "nested"
                << "{"
                << "x" << 1 << "list"
                << "[:" << 1 << 2.5 << "]"
                << "}";
      }
      expectTheCamera(readCameraFile(path), "OpenCV");
    }
  }
}

/// OpenCV 2 wrote no "---", and every version leaves out the blanks in { }.
TEST(CameraFile, OpenCV_ReadsWhatIsNotQuiteYaml)
{
  const TemporaryFolder folder;
  const std::string start = "%YAML:1.0\nroi: { x:1, list:[ 1, 2.5 ],\n   y:\"a:b\" }\n";
  const std::string camera = "camera_matrix: { rows:3, cols:3, dt:d, data:[ 601.7, 0., 316.2, 0., 602.9, 244.8, 0., 0., 1. ] }\n";
  const std::string lens = "distortion_coefficients: !!opencv-matrix\n   rows: 5\n   cols: 1\n   dt: d\n"
                           "   data: [ 0.041, -0.112, -0.0007, 0.0011, 0.02 ]\n";
  expectTheCamera(readCameraFile(folder.write("camera.yml", start + camera + lens)), "OpenCV", false);
}

TEST(CameraFile, OpenCV_FormatIsToldByContentNotByName)
{
  const TemporaryFolder folder;
  expectTheCamera(readCameraFile(folder.write("camera.xml", CalibrationText)), "calibration.json");
  expectTheCamera(readCameraFile(folder.write("camera.json", RosText)), "ROS");
  expectTheCamera(readCameraFile(folder.write("camera", "\xEF\xBB\xBF" + RosText)), "ROS");
}

TEST(CameraFile, PinholeXml_HasMarkerToCamera)
{
  const TemporaryFolder folder;
  const auto path = folder.path() / "camera.xml";
  const auto write = [&](const cv::Matx44d& markerToSensor, const cv::Vec3d& offset)
  {
    cv::FileStorage storage(path.string(), cv::FileStorage::WRITE);
    storage << "IntrinsicMatrix" << cv::Mat(Intrinsics) << "DistortionCoefficients" << cv::Mat(Lens);
    storage << "MarkerToSensor" << cv::Mat(markerToSensor) << "CameraPlaneOffset" << cv::Mat(offset);
    storage << "ReprojectionError" << 0.3;
  };
  write(cv::Matx44d(0, -1, 0, 5, 1, 0, 0, 6, 0, 0, 1, 7, 0, 0, 0, 1), cv::Vec3d(0, 0, 0));
  const CameraFile file = readCameraFile(path);
  expectTheCamera(file, "SlicerPinholeCameras", false);
  EXPECT_TRUE(file.warnings.empty());
  ASSERT_TRUE(file.markerToCamera);
  EXPECT_TRUE((*file.markerToCamera * Eigen::Vector3d(1, 2, 3)).isApprox(Eigen::Vector3d(3, 7, 10)));

  write(cv::Matx44d::eye(), cv::Vec3d(0, 0, 2));
  EXPECT_TRUE(hasWarning(readCameraFile(path).warnings, "identity"));
  EXPECT_TRUE(hasWarning(readCameraFile(path).warnings, "CameraPlaneOffset"));
  write(cv::Matx44d::eye() * 2, cv::Vec3d(0, 0, 0));
  expectFileError([&] { (void)readCameraFile(path); }, { "'MarkerToSensor' is not a rigid motion", "rigid 4x4" });
}

TEST(CameraFile, VasstXml_AsTheAppWroteIt)
{
  const TemporaryFolder folder;
  const auto path = folder.write("left.xml",
    "<?xml version=\"1.0\"?>\n<opencv_storage>\n<Intrinsics type_id=\"opencv-matrix\">\n  <rows>3</rows>\n  <cols>3</cols>\n"
    "  <dt>d</dt>\n  <data>\n    601.7 0. 316.2 0. 602.9\n\t244.8 0. 0. 1.</data></Intrinsics>\n"
    "<Distortion_Parameters type_id=\"opencv-matrix\">\n  <rows>5</rows><cols>1</cols><dt>d</dt>\n"
    "  <data>\n    4.1e-02 -1.12e-01\n -7e-4 1.1e-03 2e-02</data></Distortion_Parameters>\n</opencv_storage>");
  expectTheCamera(readCameraFile(path), "VASST", false);
}

TEST(CameraFile, Ros_ReadsBothModelsAndTheMessage)
{
  const TemporaryFolder folder;
  expectTheCamera(readCameraFile(folder.write("ros.yaml", RosText)), "ROS");

  std::string rational = replaced(RosText, "plumb_bob", "rational_polynomial");
  rational = replaced(replaced(rational, "cols: 5", "cols: 8"), "0.02]", "0.02, 0.1, 0.2, 0.3]");
  EXPECT_EQ(readCameraFile(folder.write("rational.yaml", rational)).camera.distortionCoefficients().size(), 8u);

  const auto message = folder.write("message.yaml",
    "header: \n  seq: 1\n  stamp: \n    secs: 1\n    nsecs: 2\n  frame_id: \"camera\"\nheight: 480\nwidth: 640\n"
    "distortion_model: \"plumb_bob\"\nD: [0.041, -0.112, -0.0007, 0.0011, 0.02]\n"
    "K: [601.7, 0.0, 316.2, 0.0, 602.9, 244.8, 0.0, 0.0, 1.0]\nroi: {x_offset: 0, do_rectify: False}\n---\n");
  expectTheCamera(readCameraFile(message), "ROS");

  const auto blockLists = folder.write("block.yaml",
    "image_width: 640\nimage_height: 480\ndistortion_model: plumb_bob\ncamera_matrix:\n  rows: 3\n  cols: 3\n  data:\n"
    "  - 601.7\n  - 0\n  - 316.2\n  - 0\n  - 602.9\n  - 244.8\n  - 0\n  - 0\n  - 1\n"
    "distortion_coefficients:\n  rows: 1\n  cols: 5\n  data:\n    - 0.041\n    - -0.112\n    - -0.0007\n    - 0.0011\n    - "
    "0.02\n");
  expectTheCamera(readCameraFile(blockLists), "ROS");
}

TEST(CameraFile, Ros_OtherModelsAreRefusedByName)
{
  expectRefused(replaced(RosText, "plumb_bob", "equidistant"), { "'distortion_model' is 'equidistant'", "plumb_bob" });
  std::string eight = replaced(replaced(RosText, "cols: 5", "cols: 8"), "0.02]", "0.02, 0, 0, 0]");
  expectRefused(eight, { "8 numbers", "at most 5", "plumb_bob" });
  expectRefused("fisheye_model: 1\n" + RosText, { "fisheye_model", "not supported" });
}

TEST(CameraFile, Text_ScikitSurgery)
{
  const TemporaryFolder folder;
  const std::string matrix = "601.7 0 316.2\n0 6.029e2 244.8\n0 0 1\n";
  expectTheCamera(
    readCameraFile(folder.write("row.txt", "# calib\n" + matrix + "0.041 -0.112 -0.0007 0.0011 0.02\n")), "text", false);
  expectTheCamera(readCameraFile(folder.write("column.txt", matrix + "0.041\n-0.112\n-0.0007\n0.0011\n0.02\n")), "text", false);
  const CameraFile plain = readCameraFile(folder.write("plain.txt", matrix));
  EXPECT_TRUE(plain.camera.distortionCoefficients().empty());
  EXPECT_TRUE(hasWarning(plain.warnings, "no distortion coefficients"));
  expectRefused("601.7 0 316.2\n0 602.9\n0 0 1\n", { "camera.txt, line 2", "2 numbers" });
  expectRefused("601.7 0 316.2\n", { "1 rows", "three rows" });
  expectRefused(matrix + "1 2 3 4\n5 6 7 8\n", { "line 4", "row or column" });
  expectRefused(matrix + "1 2 x 4\n", { "line 4", "'x'" });
}

TEST(CameraFile, CalibrationJson_HasCameraAndMarker)
{
  const TemporaryFolder folder;
  const CameraFile file = readCameraFile(folder.write("calibration.json", CalibrationText));
  expectTheCamera(file, "calibration.json");
  ASSERT_TRUE(file.markerToCamera);
  EXPECT_TRUE((*file.markerToCamera * Eigen::Vector3d(1, 2, 3)).isApprox(Eigen::Vector3d(3, 7, 10)));

  const std::string marker = "[[0, -1, 0, 5], [1, 0, 0, 6], [0, 0, 1, 7], [0, 0, 0, 1]]";
  EXPECT_FALSE(readCameraFile(folder.write("failed.json", replaced(CalibrationText, marker, "null"))).markerToCamera);
  expectRefused(replaced(CalibrationText, marker, "[[1, 0], [0, 1]]"), { "'markerToCamera' is 2x2", "4x4" });
  expectRefused(replaced(CalibrationText, "\"width\": 640", "\"width\": -640"), { "'camera.width' is '-640'" });
  expectRefused(replaced(CalibrationText, "\"width\": 640,", ""), { "'camera.width' is missing" });
  expectRefused(replaced(CalibrationText, "601.7", "\"f\""), { "'camera.cameraMatrix'", "not a number" });
  expectRefused(replaced(CalibrationText, "[0, 602.9, 244.8]", "[0, 602.9]"), { "'camera.cameraMatrix'", "different lengths" });
  expectRefused(CalibrationText.substr(0, 100), { "this is not JSON: line " });
}

TEST(CameraFile, Locale_DoesNotMatter)
{
  struct CommaPoint : std::numpunct<char>
  {
    char do_decimal_point() const override { return ','; }
  };
  const TemporaryFolder folder;
  const auto path = folder.write("ros.yaml", RosText);
  const std::locale previous = std::locale::global(std::locale(std::locale(), new CommaPoint));
  const CameraFile file = readCameraFile(path);
  std::locale::global(previous);
  expectTheCamera(file, "ROS");
}
