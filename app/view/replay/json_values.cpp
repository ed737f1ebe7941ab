#include "app/view/replay/json_values.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "app/scene/toml/error.h"
#include "sim/base/byte_order_mark.h"

namespace neve::app::view::replay {

namespace {

using scene::toml::Array;
using scene::toml::Location;
using scene::toml::Table;
using scene::toml::Value;

constexpr std::size_t max_nested = 16, max_keys = 64;

bool is_between_tokens(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == ',' || c == ':';
}

/// The tokens of valid JSON, one after the other.
class Tokens {
 public:
  explicit Tokens(std::string_view text) : text_(text) { text_ = without_mark(text_); }

  /// @return where the next token begins
  Location next() {
    while (at_ < text_.size() && is_between_tokens(text_[at_])) step();
    const Location start = here_;
    if (at_ >= text_.size()) return start;
    const char first = text_[at_];
    step();
    if (first == '"') {
      skip_string();
    } else if (!is_bracket(first)) {
      while (at_ < text_.size() && !is_between_tokens(text_[at_]) && !is_bracket(text_[at_]))
        step();
    }
    return start;
  }

  /// @return the place of a byte of the text
  Location place_of(std::size_t byte) {
    while (at_ < std::min(byte, text_.size())) step();
    return here_;
  }

 private:
  static bool is_bracket(char c) { return c == '{' || c == '}' || c == '[' || c == ']'; }

  void skip_string() {
    while (at_ < text_.size() && text_[at_] != '"') {
      if (text_[at_] == '\\') step();
      if (at_ < text_.size()) step();
    }
    if (at_ < text_.size()) step();
  }

  void step() {
    if (text_[at_] == '\n') {
      here_ = {here_.line + 1, 1};
    } else if ((static_cast<unsigned char>(text_[at_]) & 0xc0) != 0x80) {
      ++here_.column;
    }
    ++at_;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  Location here_{1, 1};
};

/// Puts values together from the events of the JSON library; each of its calls is one token.
class Builder {
 public:
  Builder(std::string_view text, std::string file)
      : text_(text), tokens_(text), file_(std::move(file)) {}

  Value root;

  // The names are those that the library calls.
  bool null() { fail(tokens_.next(), "null is not a value here", "omit the key"); }
  bool boolean(bool value) { return add({value, tokens_.next()}); }
  bool number_integer(std::int64_t value) { return add({value, tokens_.next()}); }
  bool number_unsigned(std::uint64_t value) {
    const Location place = tokens_.next();
    if (value <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
      return add({static_cast<std::int64_t>(value), place});
    return add({static_cast<double>(value), place});
  }
  bool number_float(double value, const std::string&) { return add({value, tokens_.next()}); }
  bool string(std::string& value) { return add({value, tokens_.next()}); }
  bool binary(std::vector<std::uint8_t>&) { return false; }  // JSON text has none
  bool start_object(std::size_t) { return open({Table{}, tokens_.next()}); }
  bool start_array(std::size_t) { return open({Array{}, tokens_.next()}); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }

  bool key(std::string& name) {
    key_ = {name, tokens_.next(), {}};
    if (left_out_ > 0) return true;
    const Table& table = std::get<Table>(open_.back()->data);
    if (table.find(name)) fail(key_.where, scene::toml::toml_string(name) + " is given twice", "");
    if (table.entries.size() >= max_keys) fail(key_.where, "too many keys in one object", "");
    return true;
  }

  bool parse_error(std::size_t byte, const std::string&, const nlohmann::json::exception& error) {
    std::string message = error.what();
    // "[json.exception.parse_error.101] parse error at line 3, column 5: syntax error ..."
    if (const std::size_t colon = message.find(": "); colon != std::string::npos)
      message = message.substr(colon + 2);
    fail(Tokens(text_).place_of(byte > 0 ? byte - 1 : 0), "not valid JSON: " + message, "");
  }

 private:
  [[noreturn]] void fail(Location where, const std::string& message, const std::string& hint) {
    throw scene::toml::SceneError(file_, where.line, where.column, message, hint);
  }

  bool add(Value value) {
    if (left_out_ == 0) place(std::move(value));
    return true;
  }

  Value& place(Value value) {
    if (open_.empty()) return root = std::move(value);
    if (Array* list = std::get_if<Array>(&open_.back()->data))
      return list->emplace_back(std::move(value));
    key_.value = std::move(value);
    return std::get<Table>(open_.back()->data).entries.emplace_back(std::move(key_)).value;
  }

  bool open(Value value) {
    if (left_out_ > 0 || open_.size() >= max_nested)
      ++left_out_;
    else
      open_.push_back(&place(std::move(value)));
    return true;
  }

  bool close() {
    tokens_.next();
    if (left_out_ > 0)
      --left_out_;
    else
      open_.pop_back();
    return true;
  }

  std::string_view text_;
  Tokens tokens_;
  std::string file_;
  scene::toml::Entry key_;
  std::vector<Value*> open_;  ///< nothing is added beside one that is open: pointers stay valid
  std::size_t left_out_ = 0;  ///< open values that are too deep to keep
};

}  // namespace

Value parse_json_values(std::string_view text, const std::string& file) {
  Builder builder(text, file);
  nlohmann::json::sax_parse(text.begin(), text.end(), &builder);
  return std::move(builder.root);
}

}  // namespace neve::app::view::replay
