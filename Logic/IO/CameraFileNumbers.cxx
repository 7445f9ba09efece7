// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CameraFileFormats.h"

#include "FileError.h"
#include "NumberText.h"
#include "RigidTransform.h"

#include <cmath>
#include <stdexcept>

namespace handeye::io
{

namespace
{

using Json = nlohmann::json;

constexpr int MostNumbers = 1000;

std::string shapeOf(const NumberTable& table)
{
  return std::to_string(table.rows) + "x" + std::to_string(table.columns);
}

void checkFinite(const std::filesystem::path& path, const NumberTable& table)
{
  for (double value : table.values)
  {
    if (!std::isfinite(value))
    {
      throw FileError(path, "'" + table.key + "' has a number that is not finite");
    }
  }
}

bool isKnownCount(std::size_t count)
{
  return count == 0 || count == 4 || count == 5 || count == 8 || count == 12 || count == 14;
}

void appendNumbers(const std::filesystem::path& path, const std::string& key, const Json& node, std::vector<double>& values)
{
  if (node.is_number())
  {
    values.push_back(node.get<double>());
    return;
  }
  if (!node.is_array() || node.size() + values.size() > MostNumbers)
  {
    throw FileError(
      path, "'" + key + "' has an entry that is not a number" + (node.is_string() ? ": " + inQuotes(node.get<std::string>()) : ""));
  }
  for (const Json& entry : node)
  {
    appendNumbers(path, key, entry, values);
  }
}

/// {rows, cols, data}; OpenCV's dt says what one entry is.
NumberTable readShapedTable(const std::filesystem::path& path, const std::string& key, const Json& node)
{
  const auto member = [&](const char* name) { return node.contains(name) ? node[name] : Json(); };
  NumberTable table{ key, 0, 0, {} };
  table.rows = readCount(path, key + ".rows", member("rows"), 0, MostNumbers);
  table.columns = readCount(path, key + ".cols", member("cols"), 0, MostNumbers);
  const std::string type = member("dt").is_string() ? member("dt").get<std::string>() : "d";
  if (type.size() != 1)
  {
    throw FileError(path, "'" + key + ".dt' is " + inQuotes(type) + "; expected 'd', one number an entry");
  }
  if (!member("data").is_null())
  {
    appendNumbers(path, key + ".data", member("data"), table.values);
  }
  if (table.values.size() != static_cast<std::size_t>(table.rows) * table.columns)
  {
    throw FileError(path,
      "'" + key + ".data' has " + std::to_string(table.values.size()) +
        " numbers; expected rows * cols = " + std::to_string(table.rows) + " * " + std::to_string(table.columns));
  }
  return table;
}

}  // namespace

int readCount(const std::filesystem::path& path, const std::string& key, const Json& node, int smallest, int largest)
{
  const double value = node.is_number() ? node.get<double>() : -1;
  if (!(value >= smallest && value <= largest) || value != std::floor(value))
  {
    throw FileError(path,
      "'" + key + "' is " + (node.is_null() ? "missing" : inQuotes(node.dump(-1, ' ', true, Json::error_handler_t::replace))) +
        "; expected a whole number between " + std::to_string(smallest) + " and " + std::to_string(largest));
  }
  return static_cast<int>(value);
}

NumberTable readTable(const std::filesystem::path& path, const std::string& key, const Json& node)
{
  if (node.is_object())
  {
    return readShapedTable(path, key, node);
  }
  if (!node.is_array())
  {
    throw FileError(path,
      node.is_null() ? "there is no '" + key + "'; expected a matrix of this name"
                     : "'" + key + "' is a single value; expected a matrix");
  }
  NumberTable table{ key, 1, 0, {} };
  appendNumbers(path, key, node, table.values);
  const bool isNested = !node.empty() && node.front().is_array();
  table.rows = isNested ? static_cast<int>(node.size()) : table.values.size() == 9 ? 3 : 1;
  table.columns = static_cast<int>(table.values.size()) / table.rows;
  for (const Json& row : node)
  {
    if (row.is_array() != isNested || (isNested && row.size() != static_cast<std::size_t>(table.columns)))
    {
      throw FileError(path, "'" + key + "' has rows of different lengths");
    }
  }
  return table;
}

CameraModel makeCamera(const std::filesystem::path& path, const CameraNumbers& numbers)
{
  const NumberTable& intrinsics = numbers.cameraMatrix;
  if (intrinsics.rows != 3 || intrinsics.columns != 3)
  {
    throw FileError(
      path, "'" + intrinsics.key + "' is " + shapeOf(intrinsics) + "; expected the 3x3 matrix [fx 0 cx; 0 fy cy; 0 0 1]");
  }
  const NumberTable& coefficients = numbers.coefficients;
  const bool isRowOrColumn = coefficients.values.empty() || coefficients.rows == 1 || coefficients.columns == 1;
  if (!isRowOrColumn || !isKnownCount(coefficients.values.size()))
  {
    throw FileError(path,
      "'" + coefficients.key + "' is " + shapeOf(coefficients) +
        "; expected a row or column of 0, 4, 5, 8, 12 or 14 numbers (k1 k2 p1 p2 k3 ...)");
  }
  checkFinite(path, intrinsics);
  checkFinite(path, coefficients);
  const Eigen::Matrix3d cameraMatrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>::Map(intrinsics.values.data());
  try
  {
    return CameraModel(numbers.width, numbers.height, cameraMatrix, coefficients.values);
  }
  catch (const std::invalid_argument& exception)
  {
    throw FileError(path, "'" + intrinsics.key + "' and '" + coefficients.key + "' do not make a camera: " + exception.what());
  }
}

Eigen::Isometry3d makeRigid(const std::filesystem::path& path, const NumberTable& table)
{
  const bool isSquare = table.rows == 4 && table.columns == 4;
  const std::optional<Eigen::Isometry3d> rigid =
    isSquare ? toRigid(Eigen::Matrix<double, 4, 4, Eigen::RowMajor>::Map(table.values.data())) : std::nullopt;
  if (!rigid)
  {
    const std::string found = isSquare ? "not a rigid motion" : shapeOf(table);
    throw FileError(path, "'" + table.key + "' is " + found + "; expected a rigid 4x4 matrix with the translation in mm");
  }
  return *rigid;
}

}  // namespace handeye::io
