// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BoardOptions.h"

#include <stdexcept>

namespace handeye::cli
{

namespace
{

CLI::Option* asBoard(CLI::Option* option)
{
  const auto isBoard = [](const std::string& text)
  {
    try
    {
      (void)parseBoard(text);
      return std::string();
    }
    catch (const std::invalid_argument& error)
    {
      return std::string(error.what());
    }
  };
  return option->required()->check(CLI::Validator(isBoard, std::string()))->type_name("BOARD");
}

constexpr const char* What = "chessboard:COLSxROWS:SQUARE_MM (inner corners), charuco:COLSxROWS:SQUARE_MM:MARKER_MM:DICT_4X4_250 "
                             "(squares; any ArUco dictionary), circles:COLSxROWS:SPACING_MM, acircles:COLSxROWS:SPACING_MM";

}  // namespace

void addBoardOption(CLI::App& command, std::string& board)
{
  asBoard(command.add_option("--board", board, What));
}

void addBoardArgument(CLI::App& command, std::string& board)
{
  asBoard(command.add_option("board", board, What));
}

CLI::App* cameraGroup(CLI::App& app)
{
  const std::vector<CLI::App*> there = app.get_subcommands([](CLI::App* command) { return command->get_name() == "camera"; });
  CLI::App* camera = there.empty() ? app.add_subcommand("camera", "Camera files") : there.front();
  camera->description("Lenses: camera files, calibration from pictures of a board, boards to print");
  camera->require_subcommand(1);
  return camera;
}

}  // namespace handeye::cli
