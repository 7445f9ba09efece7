// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CameraFile.h"

#include "CameraFileFormats.h"
#include "CameraTree.h"
#include "FileError.h"
#include "JsonWords.h"
#include "NumberText.h"
#include "TextFile.h"

namespace handeye::io
{

namespace
{

constexpr std::size_t LargestCameraFile = std::size_t(64) << 20;  ///< a calibration.json carries its samples
constexpr std::string_view ByteOrderMark = "\xEF\xBB\xBF";

/// "12.5", "-3e2": how a line of a text table may begin
bool beginsWithNumber(std::string_view text)
{
  const std::vector<std::string_view> words = splitWords(text.substr(0, text.find('\n')), " \t\r,;");
  return !words.empty() && parseDouble(words[0]).has_value();
}

/// From the first line on that is neither empty nor a comment.
std::string_view withoutComments(std::string_view text)
{
  text = trimmed(text);
  while (!text.empty() && text[0] == '#')
  {
    const std::size_t end = text.find('\n');
    text = end == std::string_view::npos ? std::string_view() : trimmed(text.substr(end));
  }
  return text;
}

nlohmann::json parseJson(const std::filesystem::path& path, const std::string& text)
{
  try
  {
    return nlohmann::json::parse(text, nullptr, true, true);  // with comments, which OpenCV writes
  }
  catch (const nlohmann::json::exception& exception)
  {
    throw FileError(path, "this is " + jsonProblem(exception));
  }
}

}  // namespace

CameraFile readCameraFile(const std::filesystem::path& path)
{
  std::string text = readWholeFile(path, LargestCameraFile);
  if (text.compare(0, ByteOrderMark.size(), ByteOrderMark) == 0)
  {
    text.erase(0, ByteOrderMark.size());
  }
  const std::string_view content = withoutComments(text);
  if (content.empty())
  {
    throw FileError(path, "the file is empty; a camera file was expected");
  }
  if (text.find('\0') != std::string::npos)
  {
    throw FileError(path, "this is not text; a camera file was expected (YAML, XML, JSON or rows of numbers)");
  }
  if (content[0] == '{')
  {
    const nlohmann::json root = parseJson(path, text);
    const bool isCalibration = root.contains("camera") && root["camera"].is_object();
    return isCalibration ? readCalibrationCamera(path, root) : readOpenCVCamera(path, root);
  }
  if (content[0] == '<')
  {
    return readOpenCVCamera(path, parseXmlTree(path, text));
  }
  if (beginsWithNumber(content))
  {
    return readTextCamera(path, text);
  }
  if (content[0] == '%' || content.find(':') != std::string_view::npos)
  {
    return readOpenCVCamera(path, parseYamlTree(path, text));
  }
  throw FileError(path,
    "begins with " + inQuotes(content.substr(0, content.find('\n'))) +
      "; a camera file was expected (YAML, XML, JSON or rows of numbers)");
}

}  // namespace handeye::io
