#include "app/scene/toml/toml_layout.h"

#include <algorithm>
#include <utility>

#include "sim/base/byte_order_mark.h"

namespace neve::app::scene::toml {

namespace {

using Kind = TomlNode::Kind;

class LayoutReader {
 public:
  explicit LayoutReader(std::string_view text) : text_(text) {}

  TomlLayout run() {
    out_.root.section = 0;
    out_.sections.emplace_back().begin = text_.size() - without_mark(text_).size();
    at_ = out_.sections[0].begin;
    table_ = &out_.root;
    for (skip_blank(); at_ < text_.size(); skip_blank()) {
      const std::size_t before = at_;
      if (text_[at_] == '[')
        header();
      else
        line();
      if (at_ == before) ++at_;  // not TOML: skip it
    }
    return std::move(out_);
  }

 private:
  bool is_at(char c) const { return at_ < text_.size() && text_[at_] == c; }

  void skip_spaces() {
    while (is_at(' ') || is_at('\t')) ++at_;
  }

  /// Skips blanks, comments and line ends.
  void skip_blank() {
    for (;;) {
      while (is_at(' ') || is_at('\t') || is_at('\r') || is_at('\n')) ++at_;
      if (!is_at('#')) return;
      at_ = std::min(text_.find('\n', at_), text_.size());
    }
  }

  void skip_string() {
    const char quote = text_[at_];
    const std::string block(3, quote);
    const bool is_block = text_.substr(at_, 3) == block;
    at_ += is_block ? 3 : 1;
    while (at_ < text_.size()) {
      if (quote == '"' && text_[at_] == '\\') {
        at_ = std::min(at_ + 2, text_.size());
      } else if (is_block ? text_.substr(at_, 3) == block : text_[at_] == quote) {
        at_ += is_block ? 3 : 1;
        // Up to two quotes before the closing three belong to the string.
        for (int k = 0; is_block && k < 2 && is_at(quote); ++k) ++at_;
        return;
      } else {
        ++at_;
      }
    }
  }

  std::string word() {
    const std::size_t begin = at_;
    if (is_at('"') || is_at('\'')) {
      skip_string();
      return std::string(text_.substr(begin + 1, std::max<std::size_t>(at_ - begin, 2) - 2));
    }
    while (at_ < text_.size() &&
           std::string_view(" \t\r\n.=[]{},#\"'").find(text_[at_]) == std::string_view::npos)
      ++at_;
    return std::string(text_.substr(begin, at_ - begin));
  }

  std::vector<std::string> dotted_key() {
    std::vector<std::string> words;
    for (;;) {
      skip_spaces();
      words.push_back(word());
      const std::size_t end = at_;
      skip_spaces();
      if (!is_at('.')) {
        at_ = end;
        return words;
      }
      ++at_;
    }
  }

  /// A table in a table; that of the last item where it is a list.
  TomlNode* enter(TomlNode* table, const std::string& key) {
    for (const auto& member : table->members) {
      if (member->key != key) continue;
      return member->kind == Kind::list && !member->items.empty() ? member->items.back().get()
                                                                  : member.get();
    }
    return add(table->members, key);
  }

  static TomlNode* add(std::vector<std::unique_ptr<TomlNode>>& nodes, const std::string& key) {
    nodes.push_back(std::make_unique<TomlNode>());
    nodes.back()->key = key;
    return nodes.back().get();
  }

  void header() {
    const std::size_t begin = at_;
    const bool is_list = text_.substr(at_, 2) == "[[";
    at_ += is_list ? 2 : 1;
    std::vector<std::string> words = dotted_key();
    const std::string last = words.back();
    words.pop_back();
    table_ = &out_.root;
    for (const std::string& key : words) table_ = enter(table_, key);
    if (is_list) {
      const auto found = std::find_if(table_->members.begin(), table_->members.end(),
                                      [&](const auto& member) { return member->key == last; });
      TomlNode* list = found == table_->members.end() ? add(table_->members, last) : found->get();
      list->kind = Kind::list;
      table_ = add(list->items, "");
    } else {
      table_ = enter(table_, last);
    }
    table_->header = line_around(text_, begin);
    table_->section = static_cast<int>(out_.sections.size());
    out_.sections.emplace_back().begin = table_->header.end;
    at_ = table_->header.end;
  }

  /// "key = value" below the present header.
  void line() {
    const std::size_t begin = at_;
    const std::vector<std::string> words = dotted_key();
    TomlNode* table = table_;
    std::string prefix;
    for (std::size_t k = 0; k + 1 < words.size(); ++k) {
      table = enter(table, words[k]);
      prefix += words[k] + ".";
      if (table->section < 0) {
        table->section = table_->section;
        table->prefix = prefix;
      }
    }
    skip_spaces();
    const std::size_t equals = at_;
    if (!is_at('=')) return;
    ++at_;
    TomlNode* node = add(table->members, words.back());
    value(*node, 0);
    node->entry = {begin, at_};
    TomlSection& section = out_.sections[static_cast<std::size_t>(table_->section)];
    section.last_line = {line_around(text_, begin).begin, line_around(text_, at_).end};
    section.last_key = begin;
    section.aligned = section.column == equals - begin ? section.aligned + 1 : 1;
    section.column = equals - begin;
    // A comment after the value holds no keys.
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    at_ = end;
  }

  void value(TomlNode& node, int depth) {
    skip_spaces();
    const std::size_t begin = at_;
    node.kind = Kind::value;
    if (is_at('"') || is_at('\'')) {
      skip_string();
    } else if (is_at('[') && depth < max_depth) {
      array(node, depth);
    } else if (is_at('{') && depth < max_depth) {
      inline_table(node, depth);
    } else {
      while (at_ < text_.size() &&
             std::string_view(" \t\r\n,]}#").find(text_[at_]) == std::string_view::npos)
        ++at_;
    }
    node.written = {begin, at_};
  }

  void array(TomlNode& node, int depth) {
    node.kind = Kind::array;
    ++at_;
    for (skip_blank(); at_ < text_.size() && !is_at(']'); skip_blank()) {
      const std::size_t before = at_;
      value(*add(node.items, ""), depth + 1);
      node.items.back()->entry = node.items.back()->written;
      skip_blank();
      if (is_at(',')) ++at_;
      if (at_ == before) ++at_;
    }
    at_ = std::min(at_ + 1, text_.size());
  }

  void inline_table(TomlNode& node, int depth) {
    node.kind = Kind::inline_table;
    ++at_;
    for (skip_blank(); at_ < text_.size() && !is_at('}'); skip_blank()) {
      const std::size_t before = at_;
      const std::vector<std::string> words = dotted_key();
      TomlNode* table = &node;
      for (std::size_t k = 0; k + 1 < words.size(); ++k) table = enter(table, words[k]);
      skip_spaces();
      if (is_at('=')) {
        ++at_;
        TomlNode* member = add(table->members, words.back());
        value(*member, depth + 1);
        member->entry = {before, at_};
      }
      skip_blank();
      if (is_at(',')) ++at_;
      if (at_ == before) ++at_;
    }
    at_ = std::min(at_ + 1, text_.size());
  }

  static constexpr int max_depth = 64;

  std::string_view text_;
  std::size_t at_ = 0;
  TomlLayout out_;
  TomlNode* table_ = nullptr;  ///< that keys go into
};

}  // namespace

const TomlNode* TomlNode::find(std::string_view name) const {
  for (const auto& member : members)
    if (member->key == name) return member.get();
  return nullptr;
}

Span line_around(std::string_view text, std::size_t at) {
  const std::size_t before = at == 0 ? std::string_view::npos : text.rfind('\n', at - 1);
  const std::size_t end = text.find('\n', at);
  return {before == std::string_view::npos ? 0 : before + 1,
          end == std::string_view::npos ? text.size() : end + 1};
}

TomlLayout toml_layout(std::string_view text) {
  return LayoutReader(text).run();
}

}  // namespace neve::app::scene::toml
