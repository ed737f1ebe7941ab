#pragma once
/// The texts that a reader of neve sees: string literals of sources, pages of the web and of the
/// documentation. Comments of sources are not among them.

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tests/structure/sources.h"

namespace neve::test {

struct Text {
  std::string file;
  int line = 0;  ///< from 1, of the first character
  std::string text;
};

/// The whole text of a file.
inline std::string text_of(const std::string& file) {
  std::string text;
  for (const SourceLine& line : lines_of(file)) text += line.text + "\n";
  return text;
}

/// Reads the string literals of C++ or JavaScript, each with its neighbours: "a " "b" is one text.
class LiteralReader {
 public:
  /// @param quotes  that begin a literal
  LiteralReader(std::string source, std::string quotes, std::string file)
      : source_(std::move(source)),
        quotes_(std::move(quotes)),
        file_(std::move(file)),
        is_of_cpp_(quotes_ == "\"") {}

  std::vector<Text> read() {
    while (at_ < source_.size()) read_one();
    return std::move(texts_);
  }

 private:
  static bool is_alphanumeric(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; }

  bool is_at(std::string_view word) const { return source_.compare(at_, word.size(), word) == 0; }

  void skip_past(std::string_view end) {
    const std::size_t found = source_.find(end, at_);
    at_ = found == std::string::npos ? source_.size() : found + end.size();
  }

  void read_one() {
    const char c = source_[at_];
    if (is_at("//")) return skip_past("\n");
    if (is_at("/*")) return skip_past("*/");
    if (is_at("#include")) return skip_past("\n");
    if (is_at("R\"") && is_of_cpp_) return read_raw();
    if (quotes_.find(c) != std::string::npos) return read_quoted(c);
    // A character of C++, not the separator of 100'000.
    const bool is_character = c == '\'' && (at_ == 0 || !is_alphanumeric(source_[at_ - 1]));
    if (is_character && is_of_cpp_) return skip_character();
    if (!std::isspace(static_cast<unsigned char>(c))) is_joined_ = false;
    ++at_;
  }

  void skip_character() {
    at_ += source_[at_ + 1] == '\\' ? 3 : 2;
    skip_past("'");
    is_joined_ = false;
  }

  void read_raw() {
    const std::size_t open = source_.find('(', at_);
    const std::string close = ")" + source_.substr(at_ + 2, open - at_ - 2) + "\"";
    const std::size_t begin = at_, end = std::min(source_.find(close, open), source_.size());
    add(begin, source_.substr(open + 1, end - open - 1));
    at_ = end + close.size();
  }

  void read_quoted(char quote) {
    const std::size_t begin = at_;
    std::string text;
    for (++at_; at_ < source_.size() && source_[at_] != quote; ++at_) {
      if (source_[at_] == '\n' && quote != '`')
        break;  // the quote was part of a regular expression
      if (source_[at_] != '\\') {
        text += source_[at_];
        continue;
      }
      ++at_;  // an escape is read as the character itself, a line end as a blank
      text += source_[at_] == 'n' ? ' ' : source_[at_];
    }
    ++at_;
    add(begin, text);
  }

  void add(std::size_t begin, const std::string& text) {
    if (is_joined_)
      texts_.back().text += text;
    else
      texts_.push_back(
          {file_,
           1 + static_cast<int>(std::count(source_.begin(), source_.begin() + long(begin), '\n')),
           text});
    is_joined_ = true;
  }

  std::string source_, quotes_, file_;
  bool is_of_cpp_;
  std::size_t at_ = 0;
  bool is_joined_ = false;  ///< only blanks and comments since the last literal
  std::vector<Text> texts_;
};

inline std::vector<Text> literals_of_cpp(const std::string& source, const std::string& file) {
  return LiteralReader(source, "\"", file).read();
}

/// Paragraphs of a page: lines without an empty one between them, joined by blanks.
inline std::vector<Text> paragraphs_of(const std::vector<SourceLine>& lines) {
  std::vector<Text> texts;
  bool is_new = true;
  for (const SourceLine& line : lines) {
    if (line.text.empty()) {
      is_new = true;
      continue;
    }
    if (is_new) texts.push_back({line.file, line.number, ""});
    texts.back().text += line.text + " ";
    is_new = false;
  }
  return texts;
}

/// The texts of a page of the web: what it shows, and the literals of its scripts.
inline std::vector<Text> texts_of_html(const std::string& source, const std::string& file) {
  std::vector<Text> texts;
  std::string shown;
  for (std::size_t at = 0; at < source.size();) {
    const std::size_t tag = std::min(source.find('<', at), source.size());
    shown += source.substr(at, tag - at) + " ";
    const bool is_script = source.compare(tag, 7, "<script") == 0;
    const bool is_style = source.compare(tag, 6, "<style") == 0;
    const std::size_t inside = source.find('>', tag);
    if (inside == std::string::npos) break;
    at = inside + 1;
    if (!is_script && !is_style) continue;
    const std::size_t end = source.find(is_script ? "</script>" : "</style>", at);
    if (is_script)
      for (Text& text : LiteralReader(source.substr(at, end - at), "\"'`", file).read())
        texts.push_back(std::move(text));
    at = end;
  }
  texts.push_back({file, 1, shown});
  return texts;
}

}  // namespace neve::test
