// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BoardDescription.h"

#include "BoardDictionary.h"
#include "NumberWords.h"

#include <cctype>
#include <charconv>

namespace handeye
{

namespace
{

constexpr int LargestCount = 200;
constexpr const char* Syntax = "expected is chessboard:COLSxROWS:SQUARE_MM, charuco:COLSxROWS:SQUARE_MM:MARKER_MM:DICTIONARY, "
                               "circles:COLSxROWS:SPACING_MM or acircles:COLSxROWS:SPACING_MM";

[[noreturn]] void fail(const std::string& text, const std::string& what)
{
  throw std::invalid_argument("board '" + text + "': " + what);
}

std::vector<std::string> split(const std::string& text, char separator)
{
  std::vector<std::string> parts{ "" };
  for (const char letter : text)
  {
    if (letter == separator)
    {
      parts.emplace_back();
    }
    else
    {
      parts.back() += letter;
    }
  }
  return parts;
}

int readCount(const std::string& text, const std::string& part, const char* what)
{
  int value = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
  if (error != std::errc() || end != part.data() + part.size())
  {
    fail(text, "'" + part + "' is no number of " + what + ", a whole number is expected");
  }
  return value;
}

double readLength(const std::string& text, const std::string& part, const char* what)
{
  double value = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
  if (error != std::errc() || end != part.data() + part.size() || !(value > 0) || !std::isfinite(value))
  {
    fail(text, "'" + part + "' is no " + what + ", a positive number of mm is expected");
  }
  return value;
}

std::string kindWord(BoardDescription::Kind kind)
{
  switch (kind)
  {
    case BoardDescription::Kind::Chessboard:
      return "chessboard";
    case BoardDescription::Kind::Charuco:
      return "charuco";
    case BoardDescription::Kind::Circles:
      return "circles";
    case BoardDescription::Kind::AsymmetricCircles:
      return "acircles";
  }
  throw std::invalid_argument("this is not a kind of board");
}

/// A number as short as it can be read back.
std::string shortest(double value)
{
  char text[64];
  const auto end = std::to_chars(text, text + sizeof(text), value).ptr;
  return { text, end };
}

std::string withoutPrefix(std::string name)
{
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char letter) { return char(std::toupper(letter)); });
  return name.rfind("DICT_", 0) == 0 ? name.substr(5) : name;
}

/// Markers sit in the white squares, and the first square is black.
int markerCountOf(const BoardDescription& board)
{
  return board.columns * board.rows / 2;
}

void checkCharuco(const BoardDescription& board, const std::string& text)
{
  if (!(board.markerMm > 0) || !(board.markerMm < board.spacingMm))
  {
    fail(text, "the markers (" + shortest(board.markerMm) + " mm) are expected to be smaller than the squares");
  }
  const std::optional<int> id = findDictionary(board.dictionary);
  if (!id)
  {
    std::string names;
    for (const std::string& name : arucoDictionaryNames())
    {
      names += " " + name;
    }
    fail(text, "'" + board.dictionary + "' is no ArUco dictionary; there are" + names);
  }
  const int there = dictionarySize(*id);
  if (markerCountOf(board) > there)
  {
    fail(text,
      "the board has " + std::to_string(markerCountOf(board)) + " markers, the dictionary " + board.dictionary + " only " +
        std::to_string(there));
  }
}

}  // namespace

void BoardDescription::check() const
{
  const std::string text = kindWord(kind) + ":" + std::to_string(columns) + "x" + std::to_string(rows);
  const int fewest = kind == Kind::Charuco ? 3 : 2;
  if (columns < fewest || rows < fewest || columns > LargestCount || rows > LargestCount)
  {
    fail(text, "between " + std::to_string(fewest) + " and " + std::to_string(LargestCount) + " columns and rows are expected");
  }
  if (kind == Kind::Chessboard && std::min(columns, rows) < 3)
  {
    fail(text, "a chessboard has at least 3 x 3 inner corners (its squares are one more each way)");
  }
  if (!(spacingMm > 0) || !std::isfinite(spacingMm))
  {
    fail(text, "the squares or spacings are expected to have a positive size in mm");
  }
  if (kind == Kind::Charuco)
  {
    checkCharuco(*this, text);
  }
}

bool BoardDescription::looksTheSameTurned() const
{
  switch (kind)
  {
    case Kind::Chessboard:
      return (columns + rows) % 2 == 0;
    case Kind::Circles:
      return true;
    case Kind::AsymmetricCircles:
      return rows % 2 == 0;
    case Kind::Charuco:
      break;
  }
  return false;
}

Eigen::Vector3d boardPoint(const BoardDescription& board, int id)
{
  if (id < 0 || id >= board.pointCount())
  {
    throw std::out_of_range("a board with " + std::to_string(board.pointCount()) + " points has no point " + std::to_string(id));
  }
  const int column = id % board.pointColumns(), row = id / board.pointColumns();
  const int steps = board.kind == BoardDescription::Kind::AsymmetricCircles ? 2 * column + row % 2 : column;
  return { steps * board.spacingMm, row * board.spacingMm, 0 };
}

std::vector<Eigen::Vector3d> boardPoints(const BoardDescription& board)
{
  std::vector<Eigen::Vector3d> points;
  for (int id = 0; id < board.pointCount(); ++id)
  {
    points.push_back(boardPoint(board, id));
  }
  return points;
}

Eigen::Vector3d boardCenter(const BoardDescription& board)
{
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& point_Board : boardPoints(board))
  {
    box.extend(point_Board);
  }
  return box.center();
}

BoardDescription parseBoard(const std::string& text)
{
  using Kind = BoardDescription::Kind;
  const std::vector<std::string> parts = split(text, ':');
  BoardDescription board;
  const auto kinds = { Kind::Chessboard, Kind::Charuco, Kind::Circles, Kind::AsymmetricCircles };
  const auto kind = std::find_if(kinds.begin(), kinds.end(), [&](Kind known) { return kindWord(known) == parts[0]; });
  if (kind == kinds.end())
  {
    fail(text, "'" + parts[0] + "' is no kind of board; " + Syntax);
  }
  board.kind = *kind;
  const std::size_t expected = board.kind == Kind::Charuco ? 5 : 3;
  if (parts.size() != expected)
  {
    fail(text, "it has " + std::to_string(parts.size()) + " parts between colons, not " + std::to_string(expected) + "; " + Syntax);
  }
  const std::vector<std::string> counts = split(parts[1], 'x');
  if (counts.size() != 2)
  {
    fail(text, "'" + parts[1] + "' is no size; COLSxROWS is expected, such as 9x6");
  }
  board.columns = readCount(text, counts[0], "columns");
  board.rows = readCount(text, counts[1], "rows");
  board.spacingMm =
    readLength(text, parts[2], board.kind == Kind::Chessboard || board.kind == Kind::Charuco ? "square" : "spacing");
  if (board.kind == Kind::Charuco)
  {
    board.markerMm = readLength(text, parts[3], "marker");
    board.dictionary = withoutPrefix(parts[4]);
  }
  board.check();
  return board;
}

std::string toString(const BoardDescription& board)
{
  std::string text =
    kindWord(board.kind) + ":" + std::to_string(board.columns) + "x" + std::to_string(board.rows) + ":" + shortest(board.spacingMm);
  return board.kind == BoardDescription::Kind::Charuco ? text + ":" + shortest(board.markerMm) + ":DICT_" + board.dictionary : text;
}

}  // namespace handeye
