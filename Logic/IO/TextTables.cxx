// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "TextTables.h"

#include "FileError.h"
#include "NumberText.h"
#include "RigidTransform.h"
#include "TableRows.h"
#include "TextFile.h"

#include <cmath>

namespace handeye::io
{

namespace
{

constexpr std::size_t LargestTableBytes = std::size_t(256) << 20;

/// The rows of a file, each with this many numbers; at least one row.
std::vector<TableRow> readTable(const std::filesystem::path& path, std::size_t columns, const std::string& expected)
{
  std::vector<TableRow> rows = parseTable(path, readWholeFile(path, LargestTableBytes));
  for (const TableRow& row : rows)
  {
    if (row.values.size() != columns)
    {
      throw FileError(path, row.line, std::to_string(row.values.size()) + " numbers; expected " + expected);
    }
  }
  if (rows.empty())
  {
    throw FileError(path, "no numbers; expected " + expected + " a line");
  }
  return rows;
}

}  // namespace

std::vector<TableRow> parseTable(const std::filesystem::path& path, std::string_view text)
{
  constexpr std::string_view byteOrderMark = "\xEF\xBB\xBF";
  if (text.substr(0, byteOrderMark.size()) == byteOrderMark)
  {
    text.remove_prefix(byteOrderMark.size());
  }
  std::vector<TableRow> rows;
  for (long long line = 1; !text.empty(); ++line)
  {
    const std::size_t end = text.find('\n');
    std::string_view content = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    content = content.substr(0, content.find('#'));
    TableRow row{ line, {} };
    for (std::string_view word : splitWords(content, " \t\r\v\f,;"))
    {
      const std::optional<double> value = parseDouble(word);
      if (!value || !std::isfinite(*value))
      {
        throw FileError(path, line, inQuotes(word) + (value ? " is not a finite number" : " is not a number"));
      }
      row.values.push_back(*value);
    }
    if (!row.values.empty())
    {
      rows.push_back(std::move(row));
    }
  }
  return rows;
}

Eigen::Isometry3d readMatrix4x4(const std::filesystem::path& path)
{
  const std::vector<TableRow> rows = readTable(path, 4, "4 (a matrix of four rows)");
  if (rows.size() != 4)
  {
    throw FileError(path, std::to_string(rows.size()) + " rows of numbers; expected the 4 rows of a rigid 4x4 matrix");
  }
  Eigen::Matrix4d matrix;
  for (int row = 0; row < 4; ++row)
  {
    matrix.row(row) = Eigen::RowVector4d::Map(rows[row].values.data());
  }
  const std::optional<Eigen::Isometry3d> rigid = toRigid(matrix);
  if (!rigid)
  {
    throw FileError(
      path, rows[0].line, "this matrix is not a rigid motion; expected a rotation, a translation in mm and the last row 0 0 0 1");
  }
  return *rigid;
}

std::vector<Eigen::Vector3d> readPoints(const std::filesystem::path& path)
{
  std::vector<Eigen::Vector3d> points;
  for (const TableRow& row : readTable(path, 3, "3 (x y z)"))
  {
    points.emplace_back(row.values[0], row.values[1], row.values[2]);
  }
  return points;
}

std::vector<PointAndLine> readPointsAndLines(const std::filesystem::path& path)
{
  std::vector<PointAndLine> result;
  for (const TableRow& row : readTable(path, 9, "9 (point x y z, line origin x y z, line direction x y z)"))
  {
    const double* values = row.values.data();
    const Eigen::Vector3d direction = Eigen::Vector3d::Map(values + 6);
    const double length = direction.stableNorm();
    if (!(length > 0) || !std::isfinite(length))
    {
      throw FileError(
        path, row.line, "the line's direction " + std::string(length > 0 ? "is too long" : "is 0 0 0; any other was expected"));
    }
    result.push_back({ Eigen::Vector3d::Map(values), Eigen::Vector3d::Map(values + 3), direction.stableNormalized() });
  }
  return result;
}

}  // namespace handeye::io
