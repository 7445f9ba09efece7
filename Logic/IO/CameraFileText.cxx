// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CameraFileFormats.h"

#include "FileError.h"
#include "TableRows.h"

#include <algorithm>

namespace handeye::io
{

/// Three rows of three numbers, then the coefficients: all in one row, or one a row.
CameraFile readTextCamera(const std::filesystem::path& path, const std::string& text)
{
  const std::vector<TableRow> rows = parseTable(path, text);
  const std::string expected = "expected three rows of three numbers [fx 0 cx; 0 fy cy; 0 0 1], then the distortion coefficients";
  if (rows.size() < 3)
  {
    throw FileError(path, std::to_string(rows.size()) + " rows of numbers; " + expected);
  }
  CameraNumbers numbers;
  numbers.cameraMatrix = { "rows 1 to 3", 3, 3, {} };
  for (int row = 0; row < 3; ++row)
  {
    if (rows[row].values.size() != 3)
    {
      throw FileError(path, rows[row].line, std::to_string(rows[row].values.size()) + " numbers; " + expected);
    }
    numbers.cameraMatrix.values.insert(numbers.cameraMatrix.values.end(), rows[row].values.begin(), rows[row].values.end());
  }

  const bool isRow = rows.size() == 4;
  numbers.coefficients = { "the coefficients", 1, 0, {} };
  for (std::size_t row = 3; row < rows.size(); ++row)
  {
    if (!isRow && rows[row].values.size() != 1)
    {
      throw FileError(path, rows[row].line, "more numbers than the coefficients' row or column; " + expected);
    }
    numbers.coefficients.values.insert(numbers.coefficients.values.end(), rows[row].values.begin(), rows[row].values.end());
  }
  numbers.coefficients.columns = static_cast<int>(numbers.coefficients.values.size());

  CameraFile file{ makeCamera(path, numbers), std::nullopt, "text", {} };
  if (rows.size() == 3)
  {
    file.warnings.push_back("the file has no distortion coefficients; the lens is taken as free of distortion");
  }
  return file;
}

}  // namespace handeye::io
