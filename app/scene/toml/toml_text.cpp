#include "app/scene/toml/toml_text.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <vector>

#include "app/scene/toml/error.h"
#include "sim/base/byte_order_mark.h"

namespace neve::app::scene::toml {
namespace {

constexpr int max_dots = 64;     // of a key and the keys it is in: they nest, and toml++ recurses
constexpr int max_nesting = 32;  // of brackets and braces

/// One code point: its bytes and value; length 0 when they are not valid UTF-8.
struct CodePoint {
  char32_t value;
  std::size_t length;
};

CodePoint decode(std::string_view s) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(s[k]); };
  const unsigned lead = byte(0);
  if (lead < 0x80) return {lead, 1};
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || s.size() < length) return {0, 0};
  char32_t value = lead & (0x7Fu >> length);
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte(k) & 0xC0u) != 0x80u) return {0, 0};
    value = (value << 6) | (byte(k) & 0x3Fu);
  }
  const char32_t least = length == 2 ? 0x80 : length == 3 ? 0x800 : 0x10000;
  const bool is_surrogate = value >= 0xD800 && value <= 0xDFFF;
  if (value < least || value > 0x10FFFF || is_surrogate) return {0, 0};
  return {value, length};
}

/// Advises on a file that is not UTF-8.
const char* encoding_advice(std::string_view text) {
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    return "the file is UTF-16; save it as UTF-8";
  if (text.substr(0, 512).find('\0') != std::string_view::npos)
    return "this is not a text file; name a scene, which is one";
  return "save the file as UTF-8 in your editor";
}

bool is_control(char32_t c) {
  return (c < 0x20 && c != '\t' && c != '\n' && c != '\r') || c == 0x7F;
}

enum class State { plain, comment, basic, basic_block, literal, literal_block };

/// Copies the text code point by code point and follows which kind of token it is in.
class Rewriter {
 public:
  Rewriter(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  AsciiToml run() {
    while (at_ < text_.size()) {
      const CodePoint c = decode(text_.substr(at_));
      if (c.length == 0) fail("invalid UTF-8", encoding_advice(text_));
      if (is_control(c.value)) fail("control character " + code_name(c.value));
      if (c.value == '\r' && !starts("\r\n")) fail("carriage return without line feed");
      if (c.value == '\n') {
        line_feed();
      } else if (c.value < 0x80) {
        ascii(static_cast<char>(c.value));
      } else {
        wide(c);
      }
    }
    if (state_ != State::plain && state_ != State::comment) fail_unclosed();
    return std::move(out_);
  }

 private:
  bool starts(std::string_view what) const { return text_.substr(at_).starts_with(what); }

  [[noreturn]] void fail(const std::string& message, const std::string& hint = {}) const {
    throw SceneError(file_, line_, column_, message, hint);
  }

  [[noreturn]] void fail_unclosed() const {
    throw SceneError(file_, opened_.line, opened_.column, "string is never closed");
  }

  static std::string code_name(char32_t c) {
    std::array<char, 16> name{};
    std::snprintf(name.data(), name.size(), "U+%04X", static_cast<unsigned>(c));
    return name.data();
  }

  /// Copies ASCII bytes as they are.
  void copy(std::size_t count) {
    out_.text += text_.substr(at_, count);
    at_ += count;
    column_ += static_cast<int>(count);
    out_column_ += static_cast<int>(count);
  }

  void line_feed() {
    if (state_ == State::basic || state_ == State::literal) fail_unclosed();
    if (state_ == State::comment) state_ = State::plain;
    copy(1);
    ++line_;
    column_ = out_column_ = 1;
    dots_ = dots_around();
    is_escaped_ = false;
  }

  void ascii(char c) {
    switch (state_) {
      case State::plain:
        return plain(c);
      case State::comment:
        return copy(1);
      case State::basic:
        return basic(c);
      case State::basic_block:
        return basic_block(c);
      case State::literal:
        return literal(c);
      case State::literal_block:
        return literal_block(c);
    }
  }

  void plain(char c) {
    if (c == '"' || c == '\'') return open(c);
    if (c == '#') state_ = State::comment;
    if (c == '.' && ++dots_ > max_dots) fail("more than 64 dots in one key");
    if (c == '[' || c == '{') open_bracket();
    if (c == ']' || c == '}') close_bracket();
    if (c == ',') dots_ = dots_around();
    copy(1);
  }

  int dots_around() const { return open_dots_.empty() ? 0 : open_dots_.back(); }

  /// Keys inside are below the key before.
  void open_bracket() {
    if (open_dots_.size() >= max_nesting) fail("nested more than 32 deep");
    open_dots_.push_back(dots_);
  }

  void close_bracket() {
    if (!open_dots_.empty()) open_dots_.pop_back();
    dots_ = dots_around();
  }

  void open(char quote) {
    const std::string block(3, quote);
    opened_ = {line_, column_};
    if (starts(block)) {
      state_ = quote == '"' ? State::basic_block : State::literal_block;
      return copy(3);
    }
    const bool is_empty = starts(std::string(2, quote));
    if (!is_empty) state_ = quote == '"' ? State::basic : State::literal;
    copy(is_empty ? 2 : 1);
  }

  void basic(char c) {
    if (c == '"' && !is_escaped_) state_ = State::plain;
    is_escaped_ = c == '\\' && !is_escaped_;
    copy(1);
  }

  void basic_block(char c) {
    if (c == '"' && !is_escaped_) return quotes(c);
    is_escaped_ = c == '\\' && !is_escaped_;
    copy(1);
  }

  void literal(char c) {
    if (c == '\'') state_ = State::plain;
    copy(1);
  }

  void literal_block(char c) {
    if (c == '\'') return quotes(c);
    copy(1);
  }

  /// A run of quotes in a block closes it from three on; up to two more before belong to it.
  void quotes(char quote) {
    std::size_t count = 1;
    while (count < 5 && at_ + count < text_.size() && text_[at_ + count] == quote) ++count;
    if (count >= 3) state_ = State::plain;
    copy(count);
  }

  void wide(const CodePoint& c) {
    if (state_ == State::comment) return replace(c, "?");
    if (state_ == State::basic || state_ == State::basic_block) {
      if (is_escaped_) fail("a backslash cannot escape " + code_name(c.value));
      return replace(c, escape(c.value));
    }
    const bool in_literal = state_ != State::plain;
    constexpr char32_t curly_from = 0x2018, curly_to = 0x201F;
    const bool is_curly = c.value >= curly_from && c.value <= curly_to;
    fail(code_name(c.value) + (in_literal ? " in a literal string" : " outside a string"),
         is_curly
             ? "quotes are straight, as in \"snow\""
             : "only comments and strings in \"double quotes\" may contain non-ASCII characters");
  }

  static std::string escape(char32_t c) {
    std::array<char, 16> text{};
    std::snprintf(text.data(), text.size(), c > 0xFFFF ? "\\U%08X" : "\\u%04X",
                  static_cast<unsigned>(c));
    return text.data();
  }

  void replace(const CodePoint& c, const std::string& ascii_text) {
    const int length = static_cast<int>(ascii_text.size());
    if (length > 1) {
      const bool is_first = out_.escapes.empty() || out_.escapes.back().line != line_;
      const int before = is_first ? 0 : out_.escapes.back().before + out_.escapes.back().length - 1;
      out_.escapes.push_back({line_, out_column_, length, before});
    }
    out_.text += ascii_text;
    out_column_ += length;
    at_ += c.length;
    ++column_;
  }

  std::string_view text_;
  const std::string& file_;
  AsciiToml out_;
  std::size_t at_ = 0;
  int line_ = 1, column_ = 1, out_column_ = 1;
  int dots_ = 0;                // since the last comma, and of the keys around
  std::vector<int> open_dots_;  // of the keys before each open bracket
  State state_ = State::plain;
  Location opened_{};        // where the string we are in began
  bool is_escaped_ = false;  // the previous character was a backslash that escapes
};

}  // namespace

Location AsciiToml::original(int line, int column) const {
  const auto is_before = [](const Escape& e, const Location& place) {
    return e.line < place.line || (e.line == place.line && e.column < place.column);
  };
  const Location place{line, column};
  const auto next = std::lower_bound(escapes.begin(), escapes.end(), place, is_before);
  if (next == escapes.begin() || std::prev(next)->line != line) return place;
  const Escape& last = *std::prev(next);
  // Inside an escape every column is the one code point.
  return {line, column - last.before - std::min(last.length - 1, column - last.column)};
}

AsciiToml to_ascii_toml(std::string_view text, const std::string& file) {
  if (text.size() > max_text_bytes) throw SceneError(file, 0, 0, "larger than 16 MiB");
  text = without_mark(text);
  return Rewriter(text, file).run();
}

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const CodePoint c = decode(text);
    if (c.length == 0) return false;
    text.remove_prefix(c.length);
  }
  return true;
}

bool is_clean_text(std::string_view text) {
  while (!text.empty()) {
    const CodePoint c = decode(text);
    if (c.length == 0 || is_control(c.value)) return false;
    text.remove_prefix(c.length);
  }
  return true;
}

}  // namespace neve::app::scene::toml
