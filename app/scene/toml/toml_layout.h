#pragma once
/// Positions of entries in the text of a valid TOML document, for changes in place. Values are not
/// interpreted.

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace neve::app::scene::toml {

/// Bytes [begin, end) of the text.
struct Span {
  std::size_t begin = 0, end = 0;
  std::size_t size() const { return end - begin; }
};

/// Consecutive keys: those of the document, or those after a [header].
struct TomlSection {
  std::size_t begin = 0;     ///< of the line after the header
  Span last_line{};          ///< of the last key, to the end of its line; empty: none
  std::size_t last_key = 0;  ///< where the last key begins
  std::size_t column = 0;    ///< of its '=', from there
  int aligned = 0;  ///< keys in a row, the last one too, that have their '=' in this column
};

struct TomlNode {
  /// value: a scalar, written in one place like inline tables and arrays; table: by headers or
  /// dotted keys; list: by [[headers]].
  enum class Kind { value, inline_table, array, table, list };

  Kind kind = Kind::table;
  std::string key;     ///< in the table around it
  Span written;        ///< of a value written in one place
  Span entry;          ///< the same with its key: "key = value"
  Span header;         ///< of a table or of an item of a list: the whole line; empty: none
  int section = -1;    ///< where its keys go; -1: it has no place for them yet
  std::string prefix;  ///< of those keys: "solver." for a table of dotted keys
  std::vector<std::unique_ptr<TomlNode>> members;  ///< of tables, in the order of the text
  std::vector<std::unique_ptr<TomlNode>> items;    ///< of arrays and lists

  bool is_in_one_place() const { return kind != Kind::table && kind != Kind::list; }
  bool is_table() const { return kind == Kind::table || kind == Kind::inline_table; }
  const TomlNode* find(std::string_view name) const;
};

struct TomlLayout {
  TomlNode root;
  std::vector<TomlSection> sections;  ///< the first is that of the document
};

/// @param text  parse_toml has accepted it; otherwise what is found means nothing, but nothing
///              worse happens
TomlLayout toml_layout(std::string_view text);

/// The line that holds this byte: from its beginning to after its line feed, or to the text's end.
Span line_around(std::string_view text, std::size_t at);

}  // namespace neve::app::scene::toml
