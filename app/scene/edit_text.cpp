#include "app/scene/edit_text.h"

#include <algorithm>
#include <optional>
#include <string_view>

#include "app/scene/flat.h"
#include "app/scene/params.h"
#include "app/scene/presets.h"
#include "app/scene/read.h"
#include "app/scene/scene_file.h"
#include "app/scene/toml/error.h"
#include "app/scene/toml/toml_layout.h"
#include "app/scene/toml/toml_source.h"
#include "app/support/errors.h"
#include "app/support/text.h"

namespace neve::app::scene {

namespace {

using Kind = toml::TomlNode::Kind;
using Words = std::vector<std::string>;

std::string path_text(const Words& words, std::size_t first, std::size_t end) {
  std::string text;
  for (std::size_t k = first; k < end; ++k) text += (k == first ? "" : ".") + words[k];
  return text;
}

/// Text of the value in the file: numbers, arrays and tables as they were given.
std::string literal_of(const Override& change) {
  const std::optional<ParamInfo> info = param_at(change.address);
  const toml::Value value = value_of(change, info ? info->type : "table");
  const std::string text = trimmed(change.value);
  const auto* word = std::get_if<std::string>(&value.data);
  const bool is_quoted = text.starts_with('"') || text.starts_with('\'');
  return word && !is_quoted ? toml::toml_string(*word) : text;
}

/// "a = { b = VALUE }" for a, b.
std::string nested(const Words& words, std::size_t first, const std::string& literal) {
  std::string text = literal;
  for (std::size_t k = words.size(); k-- > first;)
    text = words[k] + " = " + (k + 1 == words.size() ? text : "{ " + text + " }");
  return text;
}

bool is_blank(std::string_view line) {
  return line.find_first_not_of(" \t\r\n") == std::string_view::npos;
}

bool is_comment(std::string_view line) {
  const auto first = line.find_first_not_of(" \t");
  return first != std::string_view::npos && line[first] == '#';
}

/// One change to a text. Every change searches again, so that changes can follow each other.
class Edit {
 public:
  Edit(std::string& text, const Override& change)
      : text_(text),
        change_(change),
        words_(words_of(change.address)),
        root_(toml::parse_toml(text, "")),
        layout_(toml::toml_layout(text)),
        line_end_(text.find("\r\n") == std::string::npos ? "\n" : "\r\n") {}

  void make() {
    if (is_object_address(change_.address) || takes_item_away(change_)) return make_object();
    walk();
    const bool is_there = depth_ == words_.size();
    if (takes_away(change_)) return take_away();
    const std::string literal = literal_of(change_);
    if (is_there && node_->is_in_one_place()) return replace(node_->written, literal);
    if (is_there) {
      // Sections and dotted keys give way to a table in one place.
      remove();
      return Edit(text_, change_).make();
    }
    add(literal);
  }

  /// Removes the assignment of the address in any of its forms.
  void make_absent() {
    walk();
    take_away();
  }

 private:
  void take_away() {
    if (depth_ == words_.size()) remove();
  }

  [[noreturn]] void fail(const std::string& why) const {
    change_.fail(change_.place, "cannot be written into the file: " + why,
                 "change the file by hand: " + change_.address + " = " + trimmed(change_.value));
  }

  void replace(toml::Span span, const std::string& with) {
    text_.replace(span.begin, span.size(), with);
  }
  void insert(std::size_t at, const std::string& what) { text_.insert(at, what); }

  /// Follows the address as far as the text has it.
  void walk() {
    node_ = &layout_.root;
    const toml::Table* table = &root_;
    const toml::Value* value = nullptr;
    for (; depth_ < words_.size(); ++depth_) {
      const std::string& word = words_[depth_];
      const toml::TomlNode* next = nullptr;
      if (const toml::Array* array = value ? std::get_if<toml::Array>(&value->data) : nullptr) {
        const std::size_t k = item_place(*value, word);
        if (k >= array->size() || k >= node_->items.size()) return;
        next = node_->items[k].get();
        value = &(*array)[k];
      } else {
        const toml::Entry* entry = table ? table->find(word) : nullptr;
        next = entry ? node_->find(word) : nullptr;
        if (!next) return;
        value = &entry->value;
        keys_.push_back(word);
      }
      table = std::get_if<toml::Table>(&value->data);
      parent_ = node_;
      node_ = next;
    }
  }

  // Whole objects.

  void make_object() {
    walk();
    if (depth_ == words_.size()) {
      if (!takes_away(change_)) return replace_object();
      if (name_next_object()) return Edit(text_, change_).make();
      remove_object();
    } else if (!takes_away(change_)) {
      add_object();
    }
  }

  /// The first unnamed one behind the object gets its number as a name, which it would lose.
  bool name_next_object() {
    const toml::Entry* list = root_.find(words_[0]);
    const auto& items = std::get<toml::Array>(list->value.data);
    const Words names = item_names(list->value);
    for (std::size_t k = item_place(list->value, words_[1]) + 1; k < names.size(); ++k) {
      const auto* table = std::get_if<toml::Table>(&items[k].data);
      if (!table || table->find("name")) continue;
      const Override name{words_[0] + "." + names[k] + ".name", toml::toml_string(names[k])};
      Edit(text_, name).make();
      return true;
    }
    return false;
  }

  void add_object() {
    if (node_->kind == Kind::array) fail("its list is one array");
    add_block(object_block());
  }

  std::string object_block() const {
    const toml::Value value = value_of(change_, "table");
    std::string lines = named(words_[1]);
    for (const toml::Entry& entry : std::get<toml::Table>(value.data).entries)
      if (entry.key != "name")
        lines += line_end_ + entry.key + " = " + toml::toml_literal(entry.value);
    return "[[" + words_[0] + "]]" + line_end_ + lines;
  }

  /// Replaces an object and its comments in its place: others keep theirs, and thus their numbers.
  void replace_object() {
    if (node_->is_in_one_place()) fail("its list is one array");
    std::vector<toml::Span> spans;
    collect_sections(*node_, spans);
    const std::size_t begin = std::ranges::min_element(spans, {}, &toml::Span::begin)->begin;
    erase(std::move(spans));
    const bool is_last = begin >= text_.size();
    insert(begin, object_block() + line_end_ + (is_last ? "" : line_end_));
  }

  /// Removes an object with its comments: an item of an array, or else the sections that it has.
  void remove_object() {
    std::vector<toml::Span> spans;
    if (node_->is_in_one_place())
      spans.push_back(with_comma(node_->entry));
    else
      collect_sections(*node_, spans);
    erase(std::move(spans));
    const std::string blank = line_end_ + line_end_;
    while (text_.ends_with(blank)) text_.erase(text_.size() - line_end_.size());
  }

  /// Collects each section, from the comment above it to the blank lines below its last key.
  void collect_sections(const toml::TomlNode& node, std::vector<toml::Span>& spans) const {
    if (node.header.size() > 0) {
      const toml::TomlSection& section = layout_.sections[static_cast<std::size_t>(node.section)];
      std::size_t end = std::max(section.begin, section.last_line.end);
      while (end < text_.size()) {
        const toml::Span line = toml::line_around(text_, end);
        if (!is_blank(std::string_view(text_).substr(line.begin, line.size()))) break;
        end = line.end;
      }
      spans.push_back({above_comment(node.header.begin), end});
    }
    for (const auto* nodes : {&node.members, &node.items})
      for (const auto& inner : *nodes) collect_sections(*inner, spans);
  }

  // Absent entries.

  void add(const std::string& literal) {
    if (node_->kind == Kind::inline_table) return add_inline(literal);
    const bool is_root = node_ == &layout_.root;
    if (words_[0] == "view" && (is_root || node_->kind == Kind::list)) return add_view();
    if (node_->kind != Kind::table) fail("its place holds something else");
    if (is_root && depth_ + 1 < words_.size())
      return add_section(path_text(words_, 0, words_.size() - 1), words_.back() + " = " + literal);
    if (is_root && literal.starts_with('{')) return add_table_section();
    if (node_->section >= 0) return add_line(literal);
    Words header = keys_;
    header.insert(header.end(), words_.begin() + static_cast<std::ptrdiff_t>(depth_),
                  words_.end() - 1);
    const std::string line = words_.back() + " = " + literal;
    add_section_before(first_header(*node_), path_text(header, 0, header.size()), line);
  }

  void add_inline(const std::string& literal) {
    const std::string what = nested(words_, depth_, literal);
    const std::size_t end = last_entry(*node_);
    if (end == 0)
      replace(node_->written, "{ " + what + " }");
    else
      insert(end, ", " + what);
  }

  /// End of the last "key = value" inside; 0: no such entry.
  static std::size_t last_entry(const toml::TomlNode& node) {
    std::size_t end = 0;
    for (const auto& member : node.members)
      end = std::max({end, member->entry.end, member->entry.size() ? 0 : last_entry(*member)});
    return end;
  }

  void add_line(const std::string& literal) {
    const toml::TomlSection& section = layout_.sections[static_cast<std::size_t>(node_->section)];
    const std::string line = node_->prefix + nested(words_, depth_, literal);
    if (section.last_line.size() == 0) return add_first_line(section, line);
    const std::string_view text = text_;
    const std::size_t indent = section.last_key - section.last_line.begin;
    const bool is_own_line = is_blank(text.substr(section.last_line.begin, indent));
    std::string padded = std::string(is_own_line ? text.substr(section.last_line.begin, indent)
                                                 : std::string_view()) +
                         line;
    // If the equals signs form a column, this one joins it.
    const std::size_t own = line.find(" = ") + 1;
    if (section.aligned > 1 && own < section.column)
      padded.insert(padded.size() - line.size() + own, section.column - own, ' ');
    insert_line(section.last_line.end, padded);
  }

  void add_first_line(const toml::TomlSection& section, const std::string& line) {
    if (node_ != &layout_.root) return insert_line(section.begin, line);
    // The line goes above the first header and the comment that belongs to it.
    const std::size_t header = first_header(layout_.root);
    if (header == text_.size()) return insert_line(header, line);
    insert(above_comment(header), line + line_end_ + line_end_);
  }

  void insert_line(std::size_t at, const std::string& line) {
    const bool is_cut = at > 0 && text_[at - 1] != '\n';
    insert(at, is_cut ? line_end_ + line : line + line_end_);
  }

  void add_section(const std::string& header, const std::string& lines) {
    add_block("[" + header + "]" + line_end_ + lines);
  }

  /// [header] with the members of a table below.
  void add_table_section() {
    const toml::Value value = value_of(change_, "table");
    std::string lines;
    for (const toml::Entry& entry : std::get<toml::Table>(value.data).entries)
      lines +=
          (lines.empty() ? "" : line_end_) + entry.key + " = " + toml::toml_literal(entry.value);
    add_section(words_[0], lines);
  }

  /// Adds a block at the end, after a blank line.
  void add_block(const std::string& block) {
    const bool ends_line = text_.empty() || text_.ends_with('\n');
    const bool is_first = is_blank(text_);
    if (!ends_line) text_ += line_end_;
    text_ += (is_first ? "" : line_end_) + block + (ends_line ? line_end_ : "");
  }

  void add_section_before(std::size_t at, const std::string& header, const std::string& line) {
    insert(above_comment(at), "[" + header + "]" + line_end_ + line + line_end_ + line_end_);
  }

  /// Views that every scene has are written down when something about them is.
  void add_view() {
    const bool has_views = root_.find("view") != nullptr;
    if (!has_views && words_[1] != first_view)
      add_block("[[view]]" + line_end_ + named(first_view));
    add_block("[[view]]" + line_end_ + named(words_[1]));
    if (root_.find("view") && node_->kind == Kind::array) fail("its views are one array");
    Edit(text_, change_).make();
  }

  static std::string named(const std::string& name) { return "name = " + toml::toml_string(name); }

  /// The first byte of the first header in or below a table; the end of the text without one.
  std::size_t first_header(const toml::TomlNode& node) const {
    std::size_t first = node.header.size() > 0 ? node.header.begin : text_.size();
    for (const auto* nodes : {&node.members, &node.items})
      for (const auto& inner : *nodes) first = std::min(first, first_header(*inner));
    return first;
  }

  /// Beginning of the comments directly above a line.
  std::size_t above_comment(std::size_t line) const {
    const std::size_t top = layout_.sections.front().begin;  // below a byte order mark
    while (line > top) {
      toml::Span before = toml::line_around(text_, line - 1);
      before.begin = std::max(before.begin, top);
      if (!is_comment(std::string_view(text_).substr(before.begin, before.size()))) break;
      line = before.begin;
    }
    return line;
  }

  // Removed entries.

  void remove() {
    std::vector<toml::Span> spans;
    collect(*node_, parent_, spans);
    erase(std::move(spans));
  }

  void erase(std::vector<toml::Span> spans) {
    std::sort(spans.begin(), spans.end(),
              [](const toml::Span& a, const toml::Span& b) { return a.begin > b.begin; });
    for (const toml::Span& span : spans) replace(span, "");
  }

  void collect(const toml::TomlNode& node, const toml::TomlNode* parent,
               std::vector<toml::Span>& spans) const {
    if (node.is_in_one_place()) {
      const bool is_inline = parent && (parent->kind == Kind::inline_table || parent->section < 0);
      spans.push_back(is_inline ? with_comma(node.entry) : with_line(node.entry));
      return;
    }
    if (node.header.size() > 0) spans.push_back(with_blank_before(node.header));
    for (const auto* nodes : {&node.members, &node.items})
      for (const auto& inner : *nodes) collect(*inner, &node, spans);
  }

  toml::Span with_line(toml::Span entry) const {
    return {toml::line_around(text_, entry.begin).begin, toml::line_around(text_, entry.end).end};
  }

  toml::Span with_comma(toml::Span entry) const {
    const std::size_t next = text_.find_first_not_of(" \t", entry.end);
    if (next != std::string::npos && text_[next] == ',')
      return {entry.begin, std::min(text_.find_first_not_of(" \t", next + 1), text_.size())};
    const std::size_t before =
        entry.begin == 0 ? std::string::npos : text_.find_last_not_of(" \t", entry.begin - 1);
    if (before != std::string::npos && text_[before] == ',') return {before, entry.end};
    return entry;
  }

  toml::Span with_blank_before(toml::Span line) const {
    if (line.begin == 0) return line;
    const toml::Span before = toml::line_around(text_, line.begin - 1);
    const bool is_empty = is_blank(std::string_view(text_).substr(before.begin, before.size()));
    return is_empty ? toml::Span{before.begin, line.end} : line;
  }

  std::string& text_;
  const Override& change_;
  const Words words_;
  const toml::Table root_;
  const toml::TomlLayout layout_;
  const std::string line_end_;
  const toml::TomlNode* node_ = nullptr;  ///< the deepest existing node
  const toml::TomlNode* parent_ = nullptr;
  std::size_t depth_ = 0;  ///< how many words lead to it
  Words keys_;             ///< of those the ones that are keys, not names in lists
};

/// A preset that is set takes the place of the file's numbers.
void give_way_to_preset(std::string& text, const Override& preset) {
  if (takes_away(preset)) return;
  for (const std::string& address : addresses_set_by(preset.address)) {
    const Override number{address, "none"};
    Edit(text, number).make_absent();
  }
}

}  // namespace

std::string edit_scene_text(const std::string& text, const std::vector<Override>& changes,
                            const std::string& name, const std::string& base_dir) {
  const std::string wanted = write_scene(read_scene_text(text, name, base_dir, changes));
  std::string edited = text;
  bool is_right = false;
  try {
    for (const Override& change : changes)
      if (is_preset_address(change.address)) give_way_to_preset(edited, change);
    for (const Override& change : changes) Edit(edited, change).make();
    is_right = write_scene(read_scene_text(edited, name, base_dir)) == wanted;
  } catch (const toml::SceneError&) {
    // A text that cannot be read is not returned, for any reason.
  }
  if (is_right) return edited;
  throw UsageError(name, "the changed values cannot be written into this file in its present form",
                   "save the scene under another name, or change the file by hand");
}

std::string changed_scene_text(const std::string& text, const std::vector<Override>& changes,
                               const std::string& file, const std::string& out) {
  const std::string from = base_dir_of(file);
  const Scene scene = read_scene_text(text, file, from, changes);
  const std::string whole = write_scene(scene);
  std::vector<Override> with_paths = changes;  // for a place from where its words find no files
  for (const FlatParam& param : flatten(scene))
    if (param.valid.is_path() && param.value)
      with_paths.push_back({param.address, toml::toml_literal(*param.value)});
  for (const std::vector<Override>& all : {changes, with_paths}) {
    try {
      std::string edited = edit_scene_text(text, all, file, from);
      if (write_scene(read_scene_text(edited, out, base_dir_of(out))) == whole) return edited;
    } catch (const toml::SceneError&) {
    } catch (const UsageError&) {  // the text cannot take the changes
    }
  }
  return whole;
}

std::string text_with_all_views(Scene scene) {
  scene.views.insert(scene.views.end(), scene.undrawn_views.begin(), scene.undrawn_views.end());
  scene.mosaics.insert(scene.mosaics.end(), scene.undrawn_mosaics.begin(),
                       scene.undrawn_mosaics.end());
  return write_scene(scene);
}

std::string with_header(const std::string& text, const std::string& header) {
  const std::size_t start = text.starts_with("#:schema") ? text.find('\n') + 1 : 0;
  return text.substr(0, start) + header + text.substr(start);
}

}  // namespace neve::app::scene
