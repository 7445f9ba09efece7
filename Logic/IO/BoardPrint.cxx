// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BoardPrint.h"

#include "AtomicFile.h"
#include "BoardPattern.h"
#include "FileError.h"

#include <cairo/cairo-pdf.h>
#include <opencv2/imgcodecs.hpp>
#include <zlib.h>

#include <cmath>
#include <memory>
#include <stdexcept>

namespace handeye::io
{

namespace
{

constexpr double MmPerInch = 25.4;
constexpr double PointsPerInch = 72;
constexpr double LeastMarginMm = 5;  ///< what printers leave free
constexpr double CaptionMm = 12;     ///< room for the text and the ruler
constexpr double MostPixels = 2e8;

struct Paper
{
  const char* name;
  double widthMm;
  double heightMm;
  bool isAutomatic;
};

constexpr Paper Papers[] = { { "A4", 210, 297, true }, { "A3", 297, 420, true }, { "A2", 420, 594, true }, { "A1", 594, 841, true },
  { "A0", 841, 1189, true }, { "Letter", 215.9, 279.4, false }, { "Tabloid", 279.4, 431.8, false } };

using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using Context = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

Eigen::Vector2d sizeOf(const BoardPattern::Rectangle& rectangle)
{
  return rectangle.upper_Board - rectangle.lower_Board;
}

/// The page, upright or on its side, that holds the pattern and the caption.
PrintedBoard choosePage(const BoardPattern& pattern, const std::string& wanted)
{
  const Eigen::Vector2d needed = sizeOf(pattern.pattern()) + Eigen::Vector2d(2 * LeastMarginMm, 2 * LeastMarginMm + CaptionMm);
  const Eigen::Vector2d sheet = sizeOf(pattern.sheet());
  const PrintedBoard fitting{ std::max(sheet.x(), needed.x()), std::max(sheet.y() + CaptionMm, needed.y()), "" };
  if (wanted == "fit")
  {
    return fitting;
  }
  bool isKnown = wanted.empty();
  for (const Paper& paper : Papers)
  {
    if (wanted.empty() ? !paper.isAutomatic : wanted != paper.name)
    {
      continue;
    }
    isKnown = true;
    if (needed.x() <= paper.widthMm && needed.y() <= paper.heightMm)
    {
      return { paper.widthMm, paper.heightMm, std::string(paper.name) + " portrait" };
    }
    if (needed.x() <= paper.heightMm && needed.y() <= paper.widthMm)
    {
      return { paper.heightMm, paper.widthMm, std::string(paper.name) + " landscape" };
    }
  }
  if (!isKnown)
  {
    throw std::invalid_argument("'" + wanted + "' is no paper size; there are A4, A3, A2, A1, A0, Letter, Tabloid and fit");
  }
  if (!wanted.empty())
  {
    throw std::invalid_argument("the board needs " + std::to_string(int(std::ceil(needed.x()))) + " x " +
      std::to_string(int(std::ceil(needed.y()))) + " mm with its margins and caption, which " + wanted + " does not hold");
  }
  return fitting;
}

/// A ruler as long as fits, in centimetres, and the board's text. User space is in mm.
void drawCaption(cairo_t* context, const BoardDescription& board, const PrintedBoard& page, double left, double right, double top)
{
  const double rulerMm = std::clamp(10 * std::floor((right - left) / 2 / 10), 10.0, 100.0);
  cairo_set_line_width(context, 0.2);
  const double y = top + 3;
  cairo_move_to(context, right - rulerMm, y);
  cairo_line_to(context, right, y);
  for (double x = 0; x <= rulerMm + 1e-9; x += 10)
  {
    const bool isEnd = x == 0 || std::abs(x - rulerMm) < 1e-9;
    cairo_move_to(context, right - rulerMm + x, y - (isEnd ? 2 : 1));
    cairo_line_to(context, right - rulerMm + x, y + (isEnd ? 2 : 1));
  }
  cairo_stroke(context);
  cairo_select_font_face(context, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  const auto write = [&](double x, double baseline, double heightMm, double widest, const std::string& text)
  {
    cairo_set_font_size(context, heightMm);
    cairo_text_extents_t extents;
    cairo_text_extents(context, text.c_str(), &extents);
    cairo_set_font_size(context, heightMm * std::min(1.0, widest / std::max(extents.x_advance, 1e-9)));
    cairo_move_to(context, x, baseline);
    cairo_show_text(context, text.c_str());
  };
  const double widest = right - rulerMm - left - 4;
  write(left, top + 2.5, 3, widest, toString(board));
  write(
    left, top + 6.5, 2.4, widest, "print at 100 %, do not fit to the page" + (page.paper.empty() ? "" : " (" + page.paper + ")"));
  write(right - rulerMm, top + 8, 2.4, rulerMm, std::to_string(int(rulerMm)) + " mm: measure it");
}

/// Everything, in a user space of mm. All black areas are one path: no hairlines where they touch.
void draw(cairo_t* context, const BoardDescription& board, const BoardPattern& pattern, const PrintedBoard& page)
{
  cairo_set_source_rgb(context, 1, 1, 1);
  cairo_paint(context);
  cairo_set_source_rgb(context, 0, 0, 0);
  const Eigen::Vector2d size = sizeOf(pattern.pattern());
  const double left = (page.pageWidthMm - size.x()) / 2, top = (page.pageHeightMm - CaptionMm - size.y()) / 2;
  cairo_save(context);
  cairo_translate(context, left - pattern.pattern().lower_Board.x(), top - pattern.pattern().lower_Board.y());
  for (const BoardPattern::Rectangle& black : pattern.blackRectangles())
  {
    const Eigen::Vector2d extent = sizeOf(black);
    cairo_rectangle(context, black.lower_Board.x(), black.lower_Board.y(), extent.x(), extent.y());
  }
  for (const BoardPattern::Circle& black : pattern.blackCircles())
  {
    cairo_new_sub_path(context);
    cairo_arc(context, black.center_Board.x(), black.center_Board.y(), black.radiusMm, 0, 2 * EIGEN_PI);
    cairo_close_path(context);
  }
  cairo_fill(context);
  cairo_restore(context);
  const double captionTop = top + size.y() + std::max(3.0, (page.pageHeightMm - CaptionMm - size.y()) / 2 - 3);
  const double center = page.pageWidthMm / 2, half = std::max(size.x(), std::min(90.0, page.pageWidthMm - 2 * LeastMarginMm)) / 2;
  drawCaption(context, board, page, center - half, center + half, captionTop);
}

void checkCairo(const std::filesystem::path& path, cairo_status_t status)
{
  if (status != CAIRO_STATUS_SUCCESS)
  {
    throw FileError(path, std::string("the board cannot be drawn: ") + cairo_status_to_string(status));
  }
}

cairo_status_t append(void* closure, const unsigned char* bytes, unsigned int count)
{
  static_cast<std::string*>(closure)->append(reinterpret_cast<const char*>(bytes), count);
  return CAIRO_STATUS_SUCCESS;
}

std::string toPdf(
  const std::filesystem::path& path, const BoardDescription& board, const BoardPattern& pattern, const PrintedBoard& page)
{
  std::string bytes;
  const double scale = PointsPerInch / MmPerInch;
  const Surface surface(cairo_pdf_surface_create_for_stream(&append, &bytes, page.pageWidthMm * scale, page.pageHeightMm * scale),
    &cairo_surface_destroy);
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_TITLE, toString(board).c_str());
  const Context context(cairo_create(surface.get()), &cairo_destroy);
  cairo_scale(context.get(), scale, scale);
  draw(context.get(), board, pattern, page);
  cairo_show_page(context.get());
  checkCairo(path, cairo_status(context.get()));
  cairo_surface_finish(surface.get());
  checkCairo(path, cairo_surface_status(surface.get()));
  return bytes;
}

std::string bigEndian(std::uint32_t value)
{
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8)
  {
    bytes += char((value >> shift) & 0xFF);
  }
  return bytes;
}

/// The size of a pixel in a PNG, which OpenCV does not write: a chunk pHYs after the header's.
std::string withPixelSize(const std::vector<uchar>& png, double dotsPerInch)
{
  constexpr std::size_t HeaderEnd = 33;  // signature 8, IHDR 4 + 4 + 13 + 4
  const std::uint32_t perMetre = std::uint32_t(std::lround(dotsPerInch / MmPerInch * 1000));
  const std::string body = "pHYs" + bigEndian(perMetre) + bigEndian(perMetre) + char(1);
  const auto checksum = crc32(0, reinterpret_cast<const Bytef*>(body.data()), uInt(body.size()));
  const std::string chunk = bigEndian(9) + body + bigEndian(std::uint32_t(checksum));
  std::string bytes(png.begin(), png.end());
  return bytes.insert(HeaderEnd, chunk);
}

std::string toPng(const std::filesystem::path& path, const BoardDescription& board, const BoardPattern& pattern,
  const PrintedBoard& page, double dotsPerInch)
{
  const double scale = dotsPerInch / MmPerInch;
  const double width = std::round(page.pageWidthMm * scale), height = std::round(page.pageHeightMm * scale);
  if (!(width * height <= MostPixels) || !(width >= 16) || !(height >= 16) || width > 32000 || height > 32000)
  {
    throw std::invalid_argument("a picture of " + std::to_string(int(page.pageWidthMm)) + " x " +
      std::to_string(int(page.pageHeightMm)) + " mm with these dots per inch would have no size that can be written; write a PDF");
  }
  const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, int(width), int(height)), &cairo_surface_destroy);
  checkCairo(path, cairo_surface_status(surface.get()));
  const Context context(cairo_create(surface.get()), &cairo_destroy);
  cairo_scale(context.get(), scale, scale);
  draw(context.get(), board, pattern, page);
  checkCairo(path, cairo_status(context.get()));
  cairo_surface_flush(surface.get());
  const cv::Mat pixels(int(height), int(width), CV_8UC4, cairo_image_surface_get_data(surface.get()),
    std::size_t(cairo_image_surface_get_stride(surface.get())));
  cv::Mat grey;
  cv::extractChannel(pixels, grey, 0);
  std::vector<uchar> png;
  cv::imencode(".png", grey, png);
  return withPixelSize(png, dotsPerInch);
}

}  // namespace

PrintedBoard printBoard(const std::filesystem::path& path, const BoardDescription& board, const BoardPrintOptions& options)
{
  if (!(options.dotsPerInch > 0) || !std::isfinite(options.dotsPerInch))
  {
    throw std::invalid_argument("printBoard: the dots per inch are expected to be positive");
  }
  const std::string ending = path.extension().string();
  if (ending != ".pdf" && ending != ".png")
  {
    throw FileError(path, "the name of a printed board is expected to end in .pdf or .png");
  }
  const BoardPattern pattern(board);
  const PrintedBoard page = choosePage(pattern, options.paper);
  writeFileAtomically(
    path, ending == ".pdf" ? toPdf(path, board, pattern, page) : toPng(path, board, pattern, page, options.dotsPerInch));
  return page;
}

}  // namespace handeye::io
