#pragma once
/// A TOML document as plain data: every value knows where it was written. Keeps toml++ out of
/// every file but one.

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace neve::app::scene::toml {

/// Line and column from 1, or the index of the --set that gave the value.
struct Location {
  int line = 0, column = 0;
  int override_index = -1;
};

struct Value;
struct Entry;
struct Date {};  ///< TOML has dates and times; no parameter is one
using Array = std::vector<Value>;
struct Table {
  // Defined where Entry is complete; until then a vector of it can be neither copied nor destroyed.
  Table();
  Table(const Table& other);
  Table(Table&& other) noexcept;
  Table& operator=(const Table& other);
  Table& operator=(Table&& other) noexcept;
  ~Table();

  std::vector<Entry> entries;  ///< in the order written

  const Entry* find(std::string_view key) const;
  Entry* find(std::string_view key);
};

struct Value {
  std::variant<bool, std::int64_t, double, std::string, Date, Array, Table> data = false;
  Location where{};

  bool is_text(std::string_view text) const {
    const auto* own = std::get_if<std::string>(&data);
    return own && *own == text;
  }
};

struct Entry {
  std::string key;
  Location where{};
  Value value{};
};

/// Length at which messages cut long values.
inline constexpr std::size_t max_shown = 60;
/// The value as TOML on one line; long ones are cut to `limit` bytes (0: never).
std::string toml_literal(const Value& value, std::size_t limit = 0);

/// A whole document: keys first, then [table] and [[list]] sections; deeper tables are inline.
std::string toml_document(const Table& root);

/// "text" with quotes, backslashes and control bytes escaped: a TOML basic string.
std::string toml_string(std::string_view text);

/// Shortest text that reads back as the same double, in any locale; a TOML number.
std::string number_text(double x);

}  // namespace neve::app::scene::toml
