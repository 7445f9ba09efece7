// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CameraTree.h"

#include "FileError.h"
#include "NumberText.h"

#include <pugixml.hpp>

#include <algorithm>
#include <string>

namespace handeye::io
{

namespace
{

using Json = nlohmann::json;

/// Of pugixml's tree, made of exactly this text.
class XmlReader
{
public:
  XmlReader(const std::filesystem::path& path, std::string_view text)
    : path_(path)
    , text_(text)
  {
  }

  Json read() const
  {
    // A fragment keeps what stands beside the root element, to be refused; UTF-8 keeps pugixml's offsets those of the text.
    // Escapes are left alone: no number has them, and behind "&#0;" pugixml would lose the rest of a list without a word.
    constexpr unsigned options = pugi::parse_cdata | pugi::parse_eol | pugi::parse_doctype | pugi::parse_fragment;
    pugi::xml_document document;
    const pugi::xml_parse_result result = document.load_buffer(text_.data(), text_.size(), options, pugi::encoding_utf8);
    if (!result)
    {
      const std::size_t begin = textAt(result.offset);
      fail(begin, "is cut short or damaged before " + inQuotes(text_.substr(begin, 20)) + " (" + result.description() + ")");
    }
    for (const pugi::xml_node& node : document.children())
    {
      if (node != document.document_element())
      {
        const std::string found =
          node.type() == pugi::node_doctype ? "<!DOCTYPE" : node.name() + std::string(trimmed(node.value()));
        fail(textAt(node.offset_debug()), "has " + inQuotes(found) + " beside its root element; expected that element alone");
      }
    }
    return valueOf(document.document_element(), 1);
  }

private:
  /// Where the first text from one of pugixml's offsets on begins; the end if there is none.
  std::size_t textAt(std::ptrdiff_t offset) const
  {
    return std::min(
      text_.find_first_not_of(" \t\r\n", static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0))), text_.size());
  }

  [[noreturn]] void fail(std::size_t position, const std::string& what) const
  {
    const std::string_view before = text_.substr(0, position);
    throw FileError(path_, 1 + std::count(before.begin(), before.end(), '\n'), "the XML " + what);
  }

  Json valueOf(const pugi::xml_node& node, int depth) const
  {
    if (depth > DeepestNesting)
    {
      fail(textAt(node.offset_debug()), "is nested more than " + std::to_string(DeepestNesting) + " levels deep");
    }
    Json children;
    std::string words;
    for (const pugi::xml_node& child : node.children())
    {
      if (child.type() == pugi::node_element)
      {
        addChild(children, child, depth);
      }
      words += child.value();
    }
    return children.is_null() ? valueFromWords(words) : children;
  }

  void addChild(Json& children, const pugi::xml_node& child, int depth) const
  {
    const std::string name = child.name();
    const bool isItem = name == "_";
    if (children.is_null())
    {
      children = isItem ? Json::array() : Json::object();
    }
    if (isItem != children.is_array())
    {
      fail(textAt(child.offset_debug()), "mixes list items '_' with named elements at " + inQuotes(name));
    }
    if (isItem)
    {
      children.push_back(valueOf(child, depth + 1));
    }
    else if (!children.emplace(name, valueOf(child, depth + 1)).second)
    {
      fail(textAt(child.offset_debug()), "has the element " + inQuotes(name) + " twice");
    }
  }

  /// Nothing, one value, or the words of a list. Words in quotation marks are one string.
  static Json valueFromWords(std::string_view text)
  {
    text = trimmed(text);
    const std::vector<std::string_view> words = splitWords(text);
    if (words.empty())
    {
      return Json();
    }
    if (words.size() == 1 || text[0] == '"')
    {
      return scalarFromText(text);
    }
    Json list = Json::array();
    for (std::string_view word : words)
    {
      list.push_back(scalarFromText(word));
    }
    return list;
  }

  const std::filesystem::path& path_;
  std::string_view text_;
};

}  // namespace

Json parseXmlTree(const std::filesystem::path& path, std::string_view text)
{
  return XmlReader(path, text).read();
}

}  // namespace handeye::io
