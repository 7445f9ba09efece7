// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BoardOptions.h"
#include "BoardPrint.h"
#include "CommandOutput.h"
#include "Commands.h"

#include <memory>

namespace handeye::cli
{

namespace
{

struct BoardArguments
{
  std::string board;
  io::BoardPrintOptions print;
  CommandOutput output;
};

int runBoard(const BoardArguments& arguments)
{
  const BoardDescription board = parseBoard(arguments.board);
  const io::PrintedBoard printed = io::printBoard(arguments.output.file, board, arguments.print);
  const std::string page = format("%.0f x %.0f mm", printed.pageWidthMm, printed.pageHeightMm);
  arguments.output.say("board                " + toString(board) + ", " + std::to_string(board.pointCount()) + " points");
  arguments.output.say("page                 " + page + (printed.paper.empty() ? "" : ", " + printed.paper));
  arguments.output.say("print it at 100 %, glue it onto something flat, and measure the ruler below it");
  if (board.looksTheSameTurned())
  {
    arguments.output.say(
      "note                 this board looks the same upside down: good for a lens, less so for a hand-eye calibration");
  }
  const nlohmann::json result = { { "status", "ok" }, { "message", "printed" }, { "board", toString(board) },
    { "points", board.pointCount() }, { "pageWidthMm", printed.pageWidthMm }, { "pageHeightMm", printed.pageHeightMm },
    { "paper", printed.paper } };
  return arguments.output.finish(result, [](const std::string&) {});  // it is written already
}

}  // namespace

void addCameraBoardCommand(CLI::App& app, int& exitCode)
{
  auto arguments = std::make_shared<BoardArguments>();
  CLI::App* command = cameraGroup(app)->add_subcommand("board", "Write a calibration board to print, at its true size");
  addBoardArgument(*command, arguments->board);
  command
    ->add_option("--paper", arguments->print.paper,
      "A4, A3, A2, A1, A0, Letter, Tabloid, or fit for a page of the board's size; "
      "otherwise the smallest of A4 to A0 that holds it")
    ->type_name("PAPER");
  command->add_option("--dpi", arguments->print.dotsPerInch, "Of a PNG, dots per inch")
    ->check(CLI::Range(36.0, 2400.0))
    ->capture_default_str();
  arguments->output.addTo(*command);
  const auto isPicture = [](const std::string& path)
  {
    const std::string ending = std::filesystem::path(path).extension().string();
    return ending == ".pdf" || ending == ".png" ? std::string() : "'" + path + "': a name that ends in .pdf or .png is expected";
  };
  command->get_option("--output")->required()->check(CLI::Validator(isPicture, std::string()));
  command->callback([arguments, &exitCode] { exitCode = runBoard(*arguments); });
}

}  // namespace handeye::cli
