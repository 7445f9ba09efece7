// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoardDescription.h"

#include <filesystem>
#include <string>

namespace handeye::io
{

struct BoardPrintOptions
{
  double dotsPerInch = 300;  ///< of a PNG; a PDF is made of lines
  /// The name of a paper size (A4, A3, A2, A1, A0, Letter, Tabloid), "fit" for a page as large as the board with its margin, or
  /// nothing for the smallest of A4 to A0 that holds it.
  std::string paper;
};

/// What was printed.
struct PrintedBoard
{
  double pageWidthMm = 0;
  double pageHeightMm = 0;
  std::string paper;  ///< "A4 landscape", "" for a page of no standard size
};

/// Writes a board at its true size, black on white, in the middle of a page: PDF or PNG by the name's ending. Below it stand the
/// board's text and a ruler, so that whoever prints it can measure whether the printer scaled it.
/// @throws FileError where the file cannot be written or its name ends otherwise; std::invalid_argument where the board does not
/// fit
///         the paper, the paper is unknown, or the picture would be larger than 200 million pixels
PrintedBoard printBoard(const std::filesystem::path& path, const BoardDescription& board, const BoardPrintOptions& options = {});

}  // namespace handeye::io
