// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BoardDictionary.h"

#include <map>

namespace handeye
{

namespace
{

const std::map<std::string, int>& dictionaries()
{
  static const std::map<std::string, int> all = { { "4X4_50", cv::aruco::DICT_4X4_50 }, { "4X4_100", cv::aruco::DICT_4X4_100 },
    { "4X4_250", cv::aruco::DICT_4X4_250 }, { "4X4_1000", cv::aruco::DICT_4X4_1000 }, { "5X5_50", cv::aruco::DICT_5X5_50 },
    { "5X5_100", cv::aruco::DICT_5X5_100 }, { "5X5_250", cv::aruco::DICT_5X5_250 }, { "5X5_1000", cv::aruco::DICT_5X5_1000 },
    { "6X6_50", cv::aruco::DICT_6X6_50 }, { "6X6_100", cv::aruco::DICT_6X6_100 }, { "6X6_250", cv::aruco::DICT_6X6_250 },
    { "6X6_1000", cv::aruco::DICT_6X6_1000 }, { "7X7_50", cv::aruco::DICT_7X7_50 }, { "7X7_100", cv::aruco::DICT_7X7_100 },
    { "7X7_250", cv::aruco::DICT_7X7_250 }, { "7X7_1000", cv::aruco::DICT_7X7_1000 },
    { "ARUCO_ORIGINAL", cv::aruco::DICT_ARUCO_ORIGINAL }, { "APRILTAG_16H5", cv::aruco::DICT_APRILTAG_16h5 },
    { "APRILTAG_25H9", cv::aruco::DICT_APRILTAG_25h9 }, { "APRILTAG_36H10", cv::aruco::DICT_APRILTAG_36h10 },
    { "APRILTAG_36H11", cv::aruco::DICT_APRILTAG_36h11 } };
  return all;
}

cv::Ptr<cv::aruco::Dictionary> open(int dictionary)
{
  return cv::aruco::getPredefinedDictionary(dictionary);
}

}  // namespace

std::vector<std::string> arucoDictionaryNames()
{
  std::vector<std::string> names;
  for (const auto& dictionary : dictionaries())
  {
    names.push_back("DICT_" + dictionary.first);
  }
  return names;
}

std::optional<int> findDictionary(const std::string& name)
{
  const auto found = dictionaries().find(name);
  return found == dictionaries().end() ? std::nullopt : std::optional(found->second);
}

int dictionarySize(int dictionary)
{
  return open(dictionary)->bytesList.rows;
}

cv::Mat markerModules(const std::string& dictionary, int marker)
{
  const cv::Ptr<cv::aruco::Dictionary> opened = open(findDictionary(dictionary).value());
  cv::Mat modules;
  cv::aruco::drawMarker(opened, marker, opened->markerSize + 2, modules, 1);
  return modules;
}

cv::Ptr<cv::aruco::CharucoBoard> makeCharucoBoard(const BoardDescription& board)
{
  return cv::aruco::CharucoBoard::create(
    board.columns, board.rows, float(board.spacingMm), float(board.markerMm), open(findDictionary(board.dictionary).value()));
}

}  // namespace handeye
