// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CameraTree.h"

#include "FileError.h"
#include "NumberText.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace handeye::io
{

namespace
{

using Json = nlohmann::json;
using YAML::anchor_t;
using YAML::Mark;
using Style = YAML::EmitterStyle::value;

/// yaml-cpp may need some 240 bytes for one byte of opening brackets.
constexpr std::size_t LargestYamlText = std::size_t(8) << 20;

const std::string Expectation = "; expected 'key: value', indented alike, and every bracket closed";

std::string_view lineAt(std::string_view text, int line)
{
  for (; line > 0; --line)
  {
    text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
  }
  return trimmed(text.substr(0, text.find('\n')));
}

/// Builds the tree from yaml-cpp's events: before yaml-cpp descends, so that the nesting is limited, and without its aliases.
class TreeBuilder : public YAML::EventHandler
{
public:
  TreeBuilder(const std::filesystem::path& path, std::string_view text)
    : path_(path)
    , text_(text)
  {
  }

  Json& root() { return root_; }

  [[noreturn]] void fail(const Mark& mark, const std::string& what) const
  {
    throw FileError(path_, mark.line + 1, inQuotes(lineAt(text_, mark.line)) + " " + what);
  }

  void OnDocumentStart(const Mark& mark) override
  {
    const bool isStuck = mark.pos == std::exchange(start_, mark.pos);  // before what yaml-cpp neither reads nor refuses: "]"
    if (isStuck || !root_.is_null())
    {
      fail(mark, "stands outside of the values before" + Expectation);
    }
  }
  void OnDocumentEnd() override {}
  void OnNull(const Mark& mark, anchor_t) override { add(mark, Json()); }
  void OnAlias(const Mark& mark, anchor_t) override { fail(mark, "has an alias '*'; expected the values themselves"); }
  void OnScalar(const Mark& mark, const std::string& tag, anchor_t, const std::string& value) override
  {
    const bool isKey = !open_.empty() && open_.back().isBeforeKey;
    const bool isQuoted = tag == "!";
    add(mark, isKey || isQuoted ? Json(value) : scalarFromText(value));
  }
  void OnSequenceStart(const Mark& mark, const std::string&, anchor_t, Style) override { open(mark, Json::array()); }
  void OnMapStart(const Mark& mark, const std::string&, anchor_t, Style) override { open(mark, Json::object()); }
  void OnSequenceEnd() override { open_.pop_back(); }
  void OnMapEnd() override { open_.pop_back(); }

private:
  struct Level
  {
    Json& container;
    bool isBeforeKey;
    std::string key;
    int keyStart;
  };

  void open(const Mark& mark, Json container)
  {
    if (open_.size() == DeepestNesting)
    {
      fail(mark, "is nested more than " + std::to_string(DeepestNesting) + " levels deep");
    }
    Json& added = add(mark, std::move(container));
    open_.push_back({ added, added.is_object(), {}, 0 });
  }

  /// As the root, the next entry of a list, the next key of a map or its value.
  Json& add(const Mark& mark, Json value)
  {
    if (open_.empty())
    {
      return root_ = std::move(value);
    }
    Level& level = open_.back();
    if (level.container.is_array())
    {
      return level.container.emplace_back(std::move(value));
    }
    if (level.isBeforeKey)
    {
      const auto* key = value.get_ptr<const std::string*>();
      if (!key || level.container.contains(*key))
      {
        fail(mark, key ? "has the key " + inQuotes(*key) + ", which is there twice" : "has a key that is no word" + Expectation);
      }
      level.key = *key;
      level.keyStart = mark.pos;
      level.isBeforeKey = false;
      return level.container;
    }
    if (mark.pos <= level.keyStart)  // yaml-cpp makes up a value there
    {
      fail(mark, "has no colon" + Expectation);
    }
    level.isBeforeKey = true;
    return level.container[level.key] = std::move(value);
  }

  const std::filesystem::path& path_;
  std::string_view text_;
  Json root_;
  std::vector<Level> open_;
  int start_ = -1;  ///< of the document
};

/// Up to the line "---" or "..." that ends the first document with something in it.
std::string_view firstDocument(std::string_view text)
{
  bool hasContent = false;
  for (std::size_t begin = 0; begin < text.size();)
  {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = trimmed(text.substr(begin, end - begin));
    const bool isBoundary = line == "---" || line == "...";
    if (isBoundary && hasContent)
    {
      return text.substr(0, begin);
    }
    hasContent = hasContent || !(isBoundary || line.empty() || line[0] == '%' || line[0] == '#');
    begin = end + 1;
  }
  return text;
}

/// With a blank behind the colons in { }, where OpenCV leaves it out although YAML wants it: {x:1}.
std::string withFlowBlanks(std::string_view text)
{
  std::string result;
  int depth = 0;
  bool isKey = false;
  for (const char c : text)
  {
    result += c;
    depth = c == '{' ? depth + 1 : c == '}' ? std::max(depth - 1, 0) : depth;
    if (c == ':' && isKey && depth > 0)
    {
      result += ' ';
    }
    const bool isWord = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    isKey = c == '{' || c == ',' || (isKey && (isWord || c == ' ' || c == '\n'));
  }
  return result;
}

}  // namespace

Json scalarFromText(std::string_view text)
{
  text = trimmed(text);
  if (text.size() >= 2 && (text[0] == '"' || text[0] == '\'') && text.back() == text[0])
  {
    return std::string(text.substr(1, text.size() - 2));
  }
  if (const std::optional<long long> integer = parseInteger(text))
  {
    return *integer;
  }
  const bool hasDot = text.size() > 1 && (text[0] == '.' || text.substr(1, 1) == ".");
  std::string withoutDot(text);  // .inf, -.Inf, .NaN
  if (hasDot && text.find_first_of("iInN") != std::string_view::npos)
  {
    withoutDot.erase(withoutDot.find('.'), 1);
  }
  if (const std::optional<double> number = parseDouble(withoutDot))
  {
    return *number;
  }
  return std::string(text);
}

Json parseYamlTree(const std::filesystem::path& path, std::string_view text)
{
  if (text.size() > LargestYamlText)
  {
    throw FileError(path, "there are " + std::to_string(text.size()) + " bytes of YAML; expected a camera file of at most 8 MB");
  }
  const bool isOfOpenCV = text.substr(0, 6) == "%YAML:";
  std::istringstream document(isOfOpenCV ? withFlowBlanks(firstDocument(text)) : std::string(firstDocument(text)));
  TreeBuilder builder(path, text);
  try
  {
    YAML::Parser parser(document);
    while (parser.HandleNextDocument(builder))
    {
    }
  }
  catch (const YAML::Exception& exception)
  {
    builder.fail(exception.mark, "or the line before is no YAML (" + exception.msg + ")" + Expectation);
  }
  if (builder.root().is_null())
  {
    throw FileError(path, "there are no values in this file");
  }
  return std::move(builder.root());
}

}  // namespace handeye::io
