// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CalibratedEye.h"
#include "CameraFile.h"
#include "FileError.h"
#include "HandEyePrediction.h"
#include "JsonWords.h"
#include "ResultFiles.h"
#include "RigidTransform.h"

#include <Eigen/Eigenvalues>

#include <cmath>
#include <fstream>
#include <optional>

namespace handeye
{

namespace
{

using nlohmann::json;
using Path = std::filesystem::path;

double readNumber(const Path& path, const json& value, const std::string& key)
{
  if (!value.is_number() || !std::isfinite(value.get<double>()))
  {
    throw io::FileError(path, "\"" + key + "\": a finite number is expected");
  }
  return value.get<double>();
}

Eigen::Vector3d readVector(const Path& path, const json& object, const char* key)
{
  const json value = object.value(key, json());
  if (!value.is_array() || value.size() != 3)
  {
    throw io::FileError(path, std::string("\"") + key + "\": three numbers are expected");
  }
  Eigen::Vector3d vector;
  for (int i = 0; i < 3; ++i)
  {
    vector(i) = readNumber(path, value[std::size_t(i)], key);
  }
  return vector;
}

Eigen::Isometry3d readTransform(const Path& path, const json& object, const char* key)
{
  const json value = object.value(key, json());
  Eigen::Matrix4d matrix;
  bool isMatrix = value.is_array() && value.size() == 4;
  for (std::size_t row = 0; isMatrix && row < 4; ++row)
  {
    isMatrix = value[row].is_array() && value[row].size() == 4;
    for (std::size_t column = 0; isMatrix && column < 4; ++column)
    {
      matrix(Eigen::Index(row), Eigen::Index(column)) = readNumber(path, value[row][column], key);
    }
  }
  const std::optional<Eigen::Isometry3d> rigid = isMatrix ? toRigid(matrix) : std::nullopt;
  if (!rigid)
  {
    throw io::FileError(
      path, std::string("\"") + key + "\": four rows of four numbers that are a rotation and a translation are expected");
  }
  return *rigid;
}

/// Rows of numbers that are symmetric and have no negative eigenvalue.
template<int size> Eigen::Matrix<double, size, size> readCovariance(const Path& path, const json& value, const char* key)
{
  Eigen::Matrix<double, size, size> covariance = Eigen::Matrix<double, size, size>::Zero();
  bool isMatrix = value.is_array() && value.size() == size;
  for (std::size_t row = 0; isMatrix && row < size; ++row)
  {
    isMatrix = value[row].is_array() && value[row].size() == size;
    for (std::size_t column = 0; isMatrix && column < size; ++column)
    {
      covariance(Eigen::Index(row), Eigen::Index(column)) = readNumber(path, value[row][column], key);
    }
  }
  const bool isSymmetric = (covariance - covariance.transpose()).norm() <= 1e-6 * covariance.norm();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, size, size>> spectrum(covariance, Eigen::EigenvaluesOnly);
  if (!isMatrix || !isSymmetric || spectrum.eigenvalues()(0) < -1e-9 * covariance.norm())
  {
    const std::string number = size == 3 ? "three" : "six";
    throw io::FileError(
      path, std::string("\"") + key + "\": a covariance, " + number + " rows of " + number + " numbers, is expected");
  }
  return covariance;
}

}  // namespace

json readResult(const Path& path, const char* key)
{
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path))
  {
    throw io::FileError(path, "the file cannot be opened");
  }
  json object;
  try
  {
    object = json::parse(file);
  }
  catch (const json::exception& error)
  {
    throw io::FileError(path, "this is " + io::jsonProblem(error) + "; expected a file with \"" + key + "\", as handeye writes it");
  }
  if (!object.is_object())
  {
    throw io::FileError(path, "a JSON object is expected");
  }
  const json status = object.value("status", json("ok"));
  if (status != "ok")
  {
    const json message = object.value("message", json(""));
    throw io::FileError(path,
      "the file holds no usable result, its status is " + status.dump() +
        (message.is_string() && !message.get<std::string>().empty() ? " (" + message.get<std::string>() + ")" : ""));
  }
  if (!object.contains(key))
  {
    const json schema = object.value("schema", json());
    throw io::FileError(path,
      std::string("the key \"") + key + "\" is missing" +
        (schema.is_string() ? ", this is a file of the kind " + schema.dump() : std::string()));
  }
  return object;
}

Eigen::Vector3d readStylusTip(const Path& path)
{
  return readVector(path, readResult(path, "tip_Stylus_Mm"), "tip_Stylus_Mm");
}

Eigen::Matrix3d readStylusTipCovariance(const Path& path)
{
  const char* key = "tipCovariance_Mm2";
  const json value = readResult(path, "tip_Stylus_Mm").value(key, json());
  return value.is_null() ? Eigen::Matrix3d(Eigen::Matrix3d::Zero()) : readCovariance<3>(path, value, key);
}

std::optional<Eigen::Matrix<double, 6, 6>> readCalibrationCovariance(const Path& path)
{
  const char* key = "covariance";
  const json value = readResult(path, "markerToCamera").value(key, json());
  return value.is_null() ? std::nullopt : std::optional(readCovariance<6>(path, value, key));
}

std::optional<Eigen::Matrix<double, 6, 6>> readRightCalibrationCovariance(const Path& path)
{
  const json object = readResult(path, "markerToRightCamera");
  if (const json own = object.value("right", json()); own.is_object())
  {
    const json value = own.value("covariance", json());
    return value.is_null() ? std::nullopt : std::optional(readCovariance<6>(path, value, "right.covariance"));
  }
  const std::optional<Eigen::Matrix<double, 6, 6>> covariance = readCalibrationCovariance(path);
  if (!covariance)
  {
    return std::nullopt;
  }
  const Eigen::Isometry3d markerToRightCamera = readTransform(path, object, "markerToRightCamera");
  const Eigen::Isometry3d leftToRight = markerToRightCamera * readTransform(path, object, "markerToCamera").inverse();
  return poseCovarianceIn(leftToRight, *covariance);
}

std::optional<Eigen::Isometry3d> readStylusTipFrame(const Path& path)
{
  const json object = readResult(path, "tip_Stylus_Mm");
  return object.contains("stylusTipToStylus") ? std::optional(readTransform(path, object, "stylusTipToStylus")) : std::nullopt;
}

std::optional<Eigen::Isometry3d> readMarkerToRightCamera(const Path& path)
{
  const json object = readResult(path, "markerToCamera");
  return object.contains("markerToRightCamera") ? std::optional(readTransform(path, object, "markerToRightCamera")) : std::nullopt;
}

std::optional<CalibratedEye> readRightEye(const Path& path)
{
  const std::optional<Eigen::Isometry3d> markerToRightCamera = readMarkerToRightCamera(path);
  const std::optional<CameraModel> camera = io::readCameraFile(path).rightCamera;
  if (!markerToRightCamera || !camera)
  {
    return std::nullopt;
  }
  return CalibratedEye{ *camera, *markerToRightCamera, readRightCalibrationCovariance(path) };
}

json readStylus(const Path& path)
{
  return readResult(path, "tip_Stylus_Mm");
}

StoredCalibration readCalibration(const Path& path)
{
  const json object = readResult(path, "markerToCamera");
  StoredCalibration stored{ readTransform(path, object, "markerToCamera"), io::readCameraFile(path).camera, {}, 0, {} };
  stored.tip_Stylus = readVector(path, object, "tip_Stylus_Mm");
  stored.ballRadiusMm = readNumber(path, object.value("ballRadiusMm", json()), "ballRadiusMm");
  if (!(stored.ballRadiusMm > 0))
  {
    throw io::FileError(path, "\"ballRadiusMm\": a positive number is expected");
  }
  const auto name = [&](const char* key, const std::string& otherwise)
  {
    const json value = object.value(key, json(otherwise));
    return value.is_string() ? value.get<std::string>() : otherwise;
  };
  stored.tools.stylusToTracker = name("stylusTransform", stored.tools.stylusToTracker);
  stored.tools.markerToTracker = name("markerTransform", stored.tools.markerToTracker);
  stored.tools.latencySec = readNumber(path, object.value("latencySec", json(0.0)), "latencySec");
  return stored;
}

Eigen::Isometry3d readPhantomRegistration(const Path& path)
{
  return readTransform(path, readResult(path, "modelToPhantom"), "modelToPhantom");
}

}  // namespace handeye
