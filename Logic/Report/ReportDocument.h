// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

namespace handeye::report
{

/// What a report says, before it is a page. Texts are plain: whatever they hold is shown as it is written.

struct Heading
{
  std::string text;
};

struct Paragraph
{
  std::string text;
};

struct Table
{
  std::string caption;
  std::vector<std::string> headings;
  std::vector<std::vector<std::string>> rows;  ///< as many cells as headings
  /// Columns of text, from the left; the others are numbers. Long texts belong in the last column, which may be text as well.
  int textColumns = 1;
  bool endsWithText = false;
};

struct Figure
{
  std::string caption;        ///< also what somebody who cannot see it is told
  cv::Mat picture;            ///< BGR, 8 bits
  bool isPhotograph = false;  ///< stored as JPEG; otherwise exactly
};

/// Pictures side by side where there is room.
struct Gallery
{
  std::vector<Figure> figures;
};

using Block = std::variant<Heading, Paragraph, Table, Figure, Gallery>;

struct DataFile
{
  std::string name;         ///< "errors.csv"
  std::string description;  ///< what the columns are
  std::string bytes;
};

struct ReportDocument
{
  enum class Verdict
  {
    None,
    Good,
    Fair,
    Poor
  };

  std::string title;
  Verdict verdict = Verdict::None;
  std::string verdictText;  ///< first of all
  std::vector<Block> blocks;
  std::vector<DataFile> data;  ///< written beside the page
  std::string madeBy;          ///< program, date; filled in by writeReport() where it is empty
};

/// Writes `report.html` (one file: pictures are in it), `report.pdf` (the same content) and the data files.
///
/// @param folder made if it is not there
/// @throws io::FileError where something cannot be written; std::invalid_argument for a table whose rows are not as long as its
///         headings or an empty picture; std::logic_error where there is a QCoreApplication without windows
/// The PDF is laid out by Qt: where there is no QGuiApplication, one without a display is made, for good, in the thread that calls
/// first. Afterwards any thread may call.
void writeReport(const std::filesystem::path& folder, const ReportDocument& document);

/// The page and the PDF as bytes; writeReport() writes these.
[[nodiscard]] std::string toHtml(const ReportDocument& document);
[[nodiscard]] std::string toPdf(const ReportDocument& document);

/// A text as HTML shows it letter by letter. Internal.
[[nodiscard]] std::string escapeHtml(const std::string& text);

}  // namespace handeye::report
