// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CameraFileWriter.h"

#include "AtomicFile.h"
#include "FileError.h"
#include "NamedTransform.h"
#include "NumberText.h"

#include <nlohmann/json.hpp>

namespace handeye::io
{

namespace
{

using Path = std::filesystem::path;
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

const char* const Convention = "p_Camera = markerToCamera * p_Marker, mm; Camera is OpenCV's frame (x right, y down, z forward); "
                               "integer pixel coordinates are pixel centres";

std::string numbersOf(const Matrix& matrix, const std::string& separator)
{
  std::string text;
  for (Eigen::Index i = 0; i < matrix.size(); ++i)
  {
    text += (i == 0 ? "" : separator) + formatDouble(matrix.data()[i]);
  }
  return text;
}

Matrix coefficientsOf(const CameraModel& camera)
{
  return Eigen::VectorXd::Map(camera.distortionCoefficients().data(), Eigen::Index(camera.distortionCoefficients().size()));
}

/// FileStorage's spelling of a matrix, in YAML or XML.
class Storage
{
public:
  explicit Storage(bool isXml)
    : isXml_(isXml)
    , text_(isXml ? "<?xml version=\"1.0\"?>\n<opencv_storage>\n" : "%YAML:1.0\n---\n")
  {
  }

  void comment(const std::string& line) { text_ += isXml_ ? "<!-- " + line + " -->\n" : "# " + line + "\n"; }

  void scalar(const std::string& key, const std::string& value)
  {
    text_ += isXml_ ? "<" + key + ">" + value + "</" + key + ">\n" : key + ": " + value + "\n";
  }

  void matrix(const std::string& key, const Matrix& matrix)
  {
    const std::string rows = std::to_string(matrix.rows()), columns = std::to_string(matrix.cols());
    text_ += isXml_ ? "<" + key + " type_id=\"opencv-matrix\">\n  <rows>" + rows + "</rows>\n  <cols>" + columns +
        "</cols>\n  <dt>d</dt>\n  <data>\n    " + numbersOf(matrix, " ") + "</data></" + key + ">\n"
                    : key + ": !!opencv-matrix\n   rows: " + rows + "\n   cols: " + columns + "\n   dt: d\n   data: [ " +
        numbersOf(matrix, ", ") + " ]\n";
  }

  std::string text() const { return text_ + (isXml_ ? "</opencv_storage>\n" : ""); }

private:
  bool isXml_;
  std::string text_;
};

void requireImageSize(const Path& path, const CameraModel& camera)
{
  if (!camera.hasImageSize())
  {
    throw FileError(
      path, "cannot be written: this format holds the image's width and height, and the camera file did not say them");
  }
}

std::string openCVText(const Path& path, const CameraFile& file, const CameraFileExtras& extras)
{
  requireImageSize(path, file.camera);
  Storage storage(path.extension() == ".xml");
  storage.comment(Convention);
  storage.scalar("image_width", std::to_string(file.camera.width()));
  storage.scalar("image_height", std::to_string(file.camera.height()));
  storage.matrix("camera_matrix", file.camera.cameraMatrix());
  storage.matrix("distortion_coefficients", coefficientsOf(file.camera));
  if (extras.reprojectionErrorPx)
  {
    storage.scalar("avg_reprojection_error", formatDouble(*extras.reprojectionErrorPx));
  }
  if (file.markerToCamera)
  {
    storage.matrix("MarkerToSensor", file.markerToCamera->matrix());
  }
  return storage.text();
}

std::string pinholeText(
  const Path& path, const CameraFile& file, std::vector<std::string>& warnings, const CameraFileExtras& extras)
{
  if (!file.markerToCamera)
  {
    throw FileError(path, "cannot be written: SlicerPinholeCameras files hold the marker's place, and the camera file has none");
  }
  Storage storage(true);
  storage.comment("MarkerToSensor is markerToCamera: " + std::string(Convention));
  storage.comment("SlicerPinholeCameras' own reader overwrites DistortionCoefficients with CameraPlaneOffset: "
                  "check the coefficients after loading");
  storage.matrix("IntrinsicMatrix", file.camera.cameraMatrix());
  storage.matrix("DistortionCoefficients", coefficientsOf(file.camera));
  storage.matrix("CameraPlaneOffset", Matrix::Zero(3, 1));
  storage.matrix("MarkerToSensor", file.markerToCamera->matrix());
  if (extras.reprojectionErrorPx)
  {
    storage.scalar("ReprojectionError", formatDouble(*extras.reprojectionErrorPx));
  }
  if (extras.registrationErrorMm)
  {
    storage.scalar("RegistrationError", formatDouble(*extras.registrationErrorMm));
  }
  warnings.push_back(
    "SlicerPinholeCameras' own reader overwrites the distortion coefficients with CameraPlaneOffset (zeros): enter the "
    "coefficients again after loading, or the lens is taken as free of distortion");
  return storage.text();
}

std::string vasstText(const CameraFile& file)
{
  Storage storage(true);
  storage.comment(Convention);
  storage.matrix("Intrinsics", file.camera.cameraMatrix());
  storage.matrix("Distortion_Parameters", coefficientsOf(file.camera));
  return storage.text();
}

std::string rosMatrix(const std::string& key, const Matrix& matrix)
{
  return key + ":\n  rows: " + std::to_string(matrix.rows()) + "\n  cols: " + std::to_string(matrix.cols()) + "\n  data: [" +
    numbersOf(matrix, ", ") + "]\n";
}

/// plumb_bob has 5 coefficients, rational_polynomial 8; what is not there is zero.
std::string rosText(const Path& path, const CameraFile& file)
{
  requireImageSize(path, file.camera);
  const std::size_t count = file.camera.distortionCoefficients().size();
  if (count > 8)
  {
    throw FileError(
      path, "cannot be written: ROS' lens models have at most 8 coefficients, and this camera has " + std::to_string(count));
  }
  Matrix coefficients = Matrix::Zero(1, count > 5 ? 8 : 5);
  coefficients.leftCols(Eigen::Index(count)) = coefficientsOf(file.camera).transpose();
  Matrix projection = Matrix::Zero(3, 4);
  projection.leftCols(3) = file.camera.cameraMatrix();
  std::string text =
    "# sensor_msgs/CameraInfo of the raw, distorted image. camera_name is also the optical frame (x right, y down, z\n"
    "# forward). ROS is in metres: markerToCamera below has its translation in m, p_camera = M * p_marker.\n";
  if (file.markerToCamera)
  {
    Eigen::Isometry3d inMetres = *file.markerToCamera;
    inMetres.translation() /= 1000;
    text += "# marker_to_camera (m): " + numbersOf(inMetres.matrix(), " ") + "\n";
    const Eigen::Isometry3d pose = inMetres.inverse();
    const Eigen::Quaterniond q(pose.linear());
    text += "# ros2 run tf2_ros static_transform_publisher --frame-id marker --child-frame-id camera";
    const std::pair<const char*, double> parts[] = { { "x", pose.translation().x() }, { "y", pose.translation().y() },
      { "z", pose.translation().z() }, { "qx", q.x() }, { "qy", q.y() }, { "qz", q.z() }, { "qw", q.w() } };
    for (const auto& [key, value] : parts)
    {
      text += std::string(" --") + key + " " + formatDouble(value);
    }
    text += "\n";
  }
  text += "image_width: " + std::to_string(file.camera.width()) + "\nimage_height: " + std::to_string(file.camera.height()) +
    "\ncamera_name: camera\n" + rosMatrix("camera_matrix", file.camera.cameraMatrix()) +
    "distortion_model: " + (count > 5 ? "rational_polynomial" : "plumb_bob") + "\n" +
    rosMatrix("distortion_coefficients", coefficients) + rosMatrix("rectification_matrix", Matrix::Identity(3, 3)) +
    rosMatrix("projection_matrix", projection);
  return text;
}

std::string rowsOf(const Matrix& matrix)
{
  std::string text;
  for (Eigen::Index row = 0; row < matrix.rows(); ++row)
  {
    text += numbersOf(matrix.row(row), " ") + "\n";
  }
  return text;
}

std::vector<Path> writeSurgeryText(const Path& path, const CameraFile& file)
{
  writeFileAtomically(path, rowsOf(file.camera.cameraMatrix()) + rowsOf(coefficientsOf(file.camera).transpose()));
  if (!file.markerToCamera)
  {
    return { path };
  }
  std::string name = path.filename().string();
  for (const char* ending : { ".txt", ".intrinsics" })
  {
    const std::string end = ending;
    if (name.size() > end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0)
    {
      name.resize(name.size() - end.size());
    }
  }
  const Path second = path.parent_path() / (name + ".handeye.txt");
  writeFileAtomically(second, rowsOf(file.markerToCamera->matrix()));
  return { path, second };
}

nlohmann::json rowsJson(const Matrix& matrix)
{
  nlohmann::json rows = nlohmann::json::array();
  for (Eigen::Index row = 0; row < matrix.rows(); ++row)
  {
    rows.push_back(std::vector<double>(matrix.row(row).begin(), matrix.row(row).end()));
  }
  return rows;
}

std::string jsonText(const CameraFile& file, const CameraFileExtras& extras)
{
  nlohmann::json object = { { "schema", "handeye-camera/1" }, { "status", "ok" }, { "convention", Convention },
    { "camera",
      { { "width", file.camera.width() }, { "height", file.camera.height() },
        { "cameraMatrix", rowsJson(file.camera.cameraMatrix()) },
        { "distortionCoefficients", file.camera.distortionCoefficients() } } } };
  if (file.markerToCamera)
  {
    object["markerToCamera"] = rowsJson(file.markerToCamera->matrix());
  }
  if (extras.reprojectionErrorPx)
  {
    object["reprojectionRmsPx"] = *extras.reprojectionErrorPx;
  }
  return object.dump(2) + "\n";
}

}  // namespace

std::vector<Path> writeCameraFile(
  const Path& path, const CameraFile& file, CameraFormat format, std::vector<std::string>& warnings, const CameraFileExtras& extras)
{
  if (file.markerToCamera && format == CameraFormat::Vasst)
  {
    warnings.push_back("the format has no place for markerToCamera, which is not written");
  }
  switch (format)
  {
    case CameraFormat::OpenCV:
      writeFileAtomically(path, openCVText(path, file, extras));
      break;
    case CameraFormat::PinholeXml:
      writeFileAtomically(path, pinholeText(path, file, warnings, extras));
      break;
    case CameraFormat::Vasst:
      writeFileAtomically(path, vasstText(file));
      break;
    case CameraFormat::Ros:
      writeFileAtomically(path, rosText(path, file));
      break;
    case CameraFormat::SurgeryText:
      return writeSurgeryText(path, file);
    case CameraFormat::Json:
      writeFileAtomically(path, jsonText(file, extras));
      break;
  }
  return { path };
}

}  // namespace handeye::io
