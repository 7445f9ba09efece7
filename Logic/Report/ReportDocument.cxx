// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ReportDocument.h"

#include "AtomicFile.h"
#include "FileError.h"

#include <ctime>
#include <stdexcept>

namespace handeye::report
{

namespace
{

void check(const Figure& figure)
{
  if (figure.picture.empty() || figure.picture.type() != CV_8UC3)
  {
    throw std::invalid_argument("the picture '" + figure.caption + "' is empty or not of 8 bits and three colours");
  }
}

struct Checker
{
  void operator()(const Heading&) const {}
  void operator()(const Paragraph&) const {}
  void operator()(const Table& table) const
  {
    for (std::size_t row = 0; row < table.rows.size(); ++row)
    {
      if (table.rows[row].size() != table.headings.size())
      {
        throw std::invalid_argument("row " + std::to_string(row) + " of the table '" + table.caption + "' has " +
          std::to_string(table.rows[row].size()) + " cells, " + std::to_string(table.headings.size()) + " are expected");
      }
    }
  }
  void operator()(const Figure& figure) const { check(figure); }
  void operator()(const Gallery& gallery) const
  {
    for (const Figure& figure : gallery.figures)
    {
      check(figure);
    }
  }
};

std::string programAndDate()
{
  const std::time_t now = std::time(nullptr);
  std::tm local = {};
  localtime_r(&now, &local);
  char date[40];
  std::strftime(date, sizeof(date), "%Y-%m-%d %H:%M", &local);
  return std::string("HandEyeCalibration " HANDEYE_VERSION ", ") + date;
}

}  // namespace

std::string escapeHtml(const std::string& text)
{
  std::string escaped;
  for (const char letter : text)
  {
    switch (letter)
    {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += letter;
    }
  }
  return escaped;
}

void writeReport(const std::filesystem::path& folder, const ReportDocument& document)
{
  for (const Block& block : document.blocks)
  {
    std::visit(Checker(), block);
  }
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
  {
    throw io::FileError(folder, "the folder cannot be made: " + error.message());
  }
  ReportDocument dated = document;
  dated.madeBy = document.madeBy.empty() ? programAndDate() : document.madeBy;
  for (const DataFile& file : document.data)
  {
    io::writeFileAtomically(folder / file.name, file.bytes);
  }
  io::writeFileAtomically(folder / "report.html", toHtml(dated));
  io::writeFileAtomically(folder / "report.pdf", toPdf(dated));
}

}  // namespace handeye::report
