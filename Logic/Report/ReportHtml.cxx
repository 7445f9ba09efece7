// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ReportDocument.h"

#include <opencv2/imgcodecs.hpp>

#include <stdexcept>

namespace handeye::report
{

namespace
{

/// Readable on a wide screen, on a telephone and on paper; colours are never the only sign.
const char* const Style = R"(
:root { color-scheme: light dark; }
body { font: 16px/1.5 "DejaVu Sans", system-ui, sans-serif; color: #1b1b1b; background: #fff; }
body { max-width: 76em; margin: 0 auto; padding: 1em; }
h1 { font-size: 1.6em; line-height: 1.2; margin: .5em 0; }
h2 { font-size: 1.25em; margin: 2em 0 .5em; border-bottom: 1px solid #ccc; padding-bottom: .2em; }
.verdict { border-left: .5em solid #666; background: #f3f3f3; padding: .8em 1em; margin: 1em 0; font-size: 1.1em; }
.good { border-color: #17803d; background: #eaf6ee; } .fair { border-color: #b26a00; background: #fdf4e3; }
.poor { border-color: #b3261e; background: #fcebea; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: .9em; }
p, li { overflow-wrap: anywhere; }
.caption { color: #444; font-size: .9em; margin: 1em 0 .3em; }
th, td { padding: .25em .6em; border-bottom: 1px solid #ddd; text-align: right; vertical-align: top; white-space: nowrap; }
th { border-bottom: 2px solid #888; vertical-align: bottom; }
.text { text-align: left; } .long { text-align: left; white-space: normal; min-width: 15em; }
tbody tr:nth-child(even) { background: #f7f7f7; }
figure { margin: 1em 0; } img { max-width: 100%; height: auto; background: #fff; } figcaption { color: #444; font-size: .9em; }
.gallery { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(26em, 100%), 1fr)); gap: 1em; }
.gallery figure { margin: 0; }
footer { margin-top: 3em; color: #666; font-size: .85em; }
@media (max-width: 45em) {
  body { padding: .5em; }
  .plot img { max-width: none; width: 48em; }
  h1 { font-size: 1.3em; } .long { min-width: 13em; } th, td { padding: .2em .4em; }
}
@media screen and (prefers-color-scheme: dark) {
  body { color: #e6e6e6; background: #1d1f22; }
  h2 { border-color: #555; } th, td { border-color: #444; } th { border-bottom-color: #888; }
  tbody tr:nth-child(even) { background: #26282c; }
  .caption, figcaption, footer { color: #bbb; } a { color: #7fb5ff; }
  .verdict { background: #2b2d31; } .good { background: #1b3324; border-color: #5fd38a; }
  .fair { background: #3a2e16; border-color: #ffca5c; } .poor { background: #3d2220; border-color: #ff8f85; }
}
@media print { body { max-width: none; } figure, tr { break-inside: avoid; } }
)";

std::string base64(const std::vector<unsigned char>& bytes)
{
  static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3)
  {
    const std::size_t rest = bytes.size() - i;
    const unsigned group =
      unsigned(bytes[i]) << 16 | (rest > 1 ? unsigned(bytes[i + 1]) << 8 : 0U) | (rest > 2 ? unsigned(bytes[i + 2]) : 0U);
    text += digits[group >> 18];
    text += digits[group >> 12 & 63U];
    text += rest > 1 ? digits[group >> 6 & 63U] : '=';
    text += rest > 2 ? digits[group & 63U] : '=';
  }
  return text;
}

std::string dataUri(const Figure& figure)
{
  std::vector<unsigned char> bytes;
  const bool good = figure.isPhotograph ? cv::imencode(".jpg", figure.picture, bytes, { cv::IMWRITE_JPEG_QUALITY, 88 })
                                        : cv::imencode(".png", figure.picture, bytes);
  if (!good)
  {
    throw std::runtime_error("the picture '" + figure.caption + "' cannot be encoded");
  }
  return std::string("data:image/") + (figure.isPhotograph ? "jpeg" : "png") + ";base64," + base64(bytes);
}

const char* verdictClass(ReportDocument::Verdict verdict)
{
  switch (verdict)
  {
    case ReportDocument::Verdict::Good:
      return " good";
    case ReportDocument::Verdict::Fair:
      return " fair";
    case ReportDocument::Verdict::Poor:
      return " poor";
    case ReportDocument::Verdict::None:
      break;
  }
  return "";
}

/// The class of a column: numbers stand right, texts left, a last long text may have several lines.
const char* columnClass(const Table& table, std::size_t column)
{
  const bool isLast = column + 1 == table.headings.size();
  return isLast && table.endsWithText ? " class='long'" : int(column) < table.textColumns ? " class='text'" : "";
}

class Writer
{
public:
  void operator()(const Heading& heading) { html_ += "<h2>" + escapeHtml(heading.text) + "</h2>\n"; }
  void operator()(const Paragraph& paragraph) { html_ += "<p>" + escapeHtml(paragraph.text) + "</p>\n"; }
  void operator()(const Table& table)
  {
    html_ += table.caption.empty() ? "" : "<p class='caption'>" + escapeHtml(table.caption) + "</p>\n";
    html_ += "<div class='scroll'><table><thead>";
    addRow(table, table.headings, "th");
    html_ += "</thead><tbody>\n";
    for (const std::vector<std::string>& row : table.rows)
    {
      addRow(table, row, "td");
    }
    html_ += "</tbody></table></div>\n";
  }
  void operator()(const Figure& figure)
  {
    const std::string caption = escapeHtml(figure.caption);
    const std::string frame = figure.isPhotograph ? "" : "<div class='scroll plot'>",
                      frameEnd = figure.isPhotograph ? "" : "</div>";
    html_ += "<figure>" + frame + "<img src='" + dataUri(figure) + "' width='" + std::to_string(figure.picture.cols) +
      "' height='" + std::to_string(figure.picture.rows) + "' alt='" + caption + "'>" + frameEnd + "<figcaption>" + caption +
      "</figcaption></figure>\n";
  }
  void operator()(const Gallery& gallery)
  {
    html_ += "<div class='gallery'>\n";
    for (const Figure& figure : gallery.figures)
    {
      (*this)(figure);
    }
    html_ += "</div>\n";
  }
  const std::string& html() const { return html_; }

private:
  void addRow(const Table& table, const std::vector<std::string>& cells, const std::string& tag)
  {
    html_ += "<tr>";
    for (std::size_t i = 0; i < cells.size(); ++i)
    {
      html_ += "<" + tag + columnClass(table, i) + ">" + escapeHtml(cells[i]) + "</" + tag + ">";
    }
    html_ += "</tr>\n";
  }

  std::string html_;
};

}  // namespace

std::string toHtml(const ReportDocument& document)
{
  Writer writer;
  for (const Block& block : document.blocks)
  {
    std::visit(writer, block);
  }
  const std::string title = escapeHtml(document.title);
  std::string html = "<!DOCTYPE html>\n<html lang='en'><head><meta charset='utf-8'>\n"
                     "<meta name='viewport' content='width=device-width, initial-scale=1'>\n<title>" +
    title + "</title>\n<style>" + Style + "</style></head><body>\n<h1>" + title + "</h1>\n<p class='verdict" +
    verdictClass(document.verdict) + "'>" + escapeHtml(document.verdictText) + "</p>\n" + writer.html();
  if (!document.data.empty())
  {
    html += "<h2>Data</h2>\n<ul>\n";
    for (const DataFile& file : document.data)
    {
      const std::string name = escapeHtml(file.name);
      html += "<li><a href='" + name + "'>" + name + "</a>: " + escapeHtml(file.description) + "</li>\n";
    }
    html += "</ul>\n";
  }
  return html + "<footer>" + escapeHtml(document.madeBy) + "</footer>\n</body></html>\n";
}

}  // namespace handeye::report
