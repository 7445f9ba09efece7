// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ImageFile.h"

#include "AtomicFile.h"
#include "FileError.h"
#include "TextFile.h"

#include <opencv2/imgcodecs.hpp>

#include <stdexcept>

namespace handeye::io
{

namespace
{

constexpr std::size_t LargestImageFile = std::size_t(1) << 30;
constexpr std::size_t LongestTrailer = 1 << 16;  ///< some cameras put notes after the image

/// The decoders fill what is missing with grey and say nothing: look for the end of the picture.
bool isCutShort(std::string_view bytes)
{
  const bool isJpeg = bytes.substr(0, 2) == "\xFF\xD8";
  const bool isPng = bytes.substr(0, 4) == "\x89PNG";
  const std::string_view tail = bytes.substr(bytes.size() - std::min(bytes.size(), LongestTrailer));
  return (isJpeg && tail.rfind("\xFF\xD9") == std::string_view::npos) || (isPng && tail.rfind("IEND") == std::string_view::npos);
}

}  // namespace

cv::Mat readImage(const std::filesystem::path& path)
{
  const std::string bytes = readWholeFile(path, LargestImageFile);
  if (isCutShort(bytes))
  {
    throw FileError(path, "the image is cut short");
  }
  cv::Mat image;
  try
  {
    const cv::Mat encoded(1, static_cast<int>(bytes.size()), CV_8U, const_cast<char*>(bytes.data()));
    image =
      bytes.empty() ? cv::Mat() : cv::imdecode(encoded, cv::IMREAD_ANYCOLOR | cv::IMREAD_ANYDEPTH | cv::IMREAD_IGNORE_ORIENTATION);
  }
  catch (const cv::Exception& exception)
  {
    throw FileError(path, "not a readable image (" + exception.err + ")");
  }
  if (image.empty())
  {
    throw FileError(path, "not a readable image; expected jpeg, png, bmp or tiff");
  }
  if (image.depth() != CV_8U && image.depth() != CV_16U)
  {
    throw FileError(path, "the image's numbers are neither 8 nor 16 bits");
  }
  return image;
}

void writePng(const std::filesystem::path& path, const cv::Mat& image)
{
  const bool isKnownDepth = image.depth() == CV_8U || image.depth() == CV_16U;
  if (image.empty() || !isKnownDepth || (image.channels() != 1 && image.channels() != 3 && image.channels() != 4))
  {
    throw std::invalid_argument("writePng: an image of 8 or 16 bits with 1, 3 or 4 channels was expected");
  }
  std::vector<uchar> bytes;
  try
  {
    cv::imencode(".png", image, bytes);
  }
  catch (const cv::Exception& exception)
  {
    throw FileError(path, "cannot be encoded as PNG (" + exception.err + ")");
  }
  writeFileAtomically(path, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

}  // namespace handeye::io
