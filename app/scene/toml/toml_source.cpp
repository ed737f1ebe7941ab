#include "app/scene/toml/toml_source.h"

#include <algorithm>
#include <charconv>

#include "app/scene/toml/error.h"
#include "app/scene/toml/toml_text.h"

// The only file that sees toml++. Its assertions abort on input such as "[\"; without them it
// reports an error. NDEBUG would turn them into promises to the optimiser, so it goes as well.
// Header-only: a compiled library would bring its own assertions.
#undef NDEBUG
#define TOML_HEADER_ONLY 1
#define TOML_ASSERT(x) ((void)0)
#define TOML_ENABLE_FORMATTERS 0
#include <toml++/toml.h>

namespace neve::app::scene::toml {
namespace {

class Converter {
 public:
  explicit Converter(const AsciiToml& source) : source_(source) {}

  Table table(const ::toml::table& from) const {
    Table to;
    for (const auto& [key, node] : from) {
      to.entries.push_back({std::string(key.str()), where(key.source()), value(node)});
    }
    // toml++ sorts by key; errors should come in the order of the file.
    std::stable_sort(to.entries.begin(), to.entries.end(), [](const Entry& a, const Entry& b) {
      return a.where.line != b.where.line ? a.where.line < b.where.line
                                          : a.where.column < b.where.column;
    });
    return to;
  }

  Location where(const ::toml::source_region& region) const {
    return source_.original(static_cast<int>(region.begin.line),
                            static_cast<int>(region.begin.column));
  }

 private:
  Value value(const ::toml::node& node) const { return {data(node), where(node.source())}; }

  decltype(Value::data) data(const ::toml::node& node) const {
    if (const auto* t = node.as_table()) return table(*t);
    if (const auto* a = node.as_array()) return array(*a);
    if (const auto* s = node.as_string()) return s->get();
    if (const auto* b = node.as_boolean()) return b->get();
    if (const auto* i = node.as_integer()) return i->get();
    if (const auto* f = node.as_floating_point()) return f->get();
    return Date{};
  }

  Array array(const ::toml::array& from) const {
    Array to;
    for (const ::toml::node& node : from) to.push_back(value(node));
    return to;
  }

  const AsciiToml& source_;
};

/// The parser's own words, without saying error twice.
std::string message_of(const ::toml::parse_error& error) {
  const std::string text(error.description());
  const std::string prefix = "Error while parsing ";
  // It shows pieces of the escapes that the text was given to it with.
  if (text.find("redefine existing") != text.npos && text.find("'\"") != text.npos)
    return "this key is given twice";
  return text.starts_with(prefix) ? "cannot parse " + text.substr(prefix.size()) : text;
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

/// "1/25"
bool has_quotient(std::string_view value) {
  const std::size_t slash = value.find('/');
  return slash != value.npos && slash > 0 && slash + 1 < value.size() &&
         is_digit(value[slash - 1]) && is_digit(value[slash + 1]) &&
         value.find_first_not_of("+-.0123456789/ ") == value.npos;
}

/// "0,04"
bool has_decimal_comma(std::string_view value) {
  const std::size_t comma = value.find(',');
  return comma != value.npos && comma > 0 && comma + 1 < value.size() &&
         value.substr(0, comma).find_first_not_of("+-0123456789") == value.npos &&
         is_digit(value[comma - 1]) && is_digit(value[comma + 1]);
}

/// "1e400"
bool is_beyond_doubles(std::string_view value) {
  double number = 0;
  if (value.starts_with('+')) value.remove_prefix(1);
  return std::from_chars(value.data(), value.data() + value.size(), number).ec ==
         std::errc::result_out_of_range;
}

/// "0.04 m", "4cm"
bool has_unit(std::string_view value) {
  const std::size_t end = value.find_first_not_of("+-.0123456789 ");
  return !value.empty() && is_digit(value[0]) && end != value.npos && is_letter(value[end]);
}

/// ".12"
bool has_bare_point(std::string_view value) {
  for (std::size_t k = 0; k + 1 < value.size(); ++k) {
    const bool is_after_digit = k > 0 && (is_digit(value[k - 1]) || is_letter(value[k - 1]));
    if (value[k] == '.' && is_digit(value[k + 1]) && !is_after_digit) return true;
  }
  return false;
}

/// "[snow]": a list of words without quotes, as shells leave it.
bool has_bare_words(std::string_view value) {
  if (value.empty() || value[0] != '[') return false;
  const std::size_t first = value.find_first_not_of("[ ");
  if (first == value.npos || !is_letter(value[first])) return false;
  const std::string_view rest = value.substr(first);
  for (const char* word : {"true", "false", "inf", "nan"})
    if (rest.starts_with(word)) return false;
  return true;
}

/// Advice on the line where the parser gave up.
std::string advice_on(std::string_view text, int line) {
  for (int k = 1; k < line && text.find('\n') != text.npos; ++k)
    text.remove_prefix(text.find('\n') + 1);
  text = text.substr(0, text.find('\n'));
  const std::size_t begin = text.find_first_not_of(" \t");
  if (begin == text.npos) return {};
  if (text.substr(begin).starts_with("//")) return "comments begin with #";
  const std::size_t equals = text.find('='), colon = text.find(':');
  if (equals == text.npos)
    return colon == text.npos ? "" : "keys and values have = between them, as in frames = 4";
  const std::size_t first = std::min(text.find_first_not_of(" \t", equals + 1), text.size());
  const std::string_view value = text.substr(first);
  if (value.empty() || value[0] == '#') return "a value follows the =";
  if (has_quotient(value)) return "nothing is computed in a value: write the number, as in 0.04";
  if (has_decimal_comma(value)) return "decimals have a point, as in 0.04";
  if (is_beyond_doubles(value))
    return "the number is too large: those of double precision end at 1.8e308";
  if (has_unit(value)) return "numbers have no unit: they are in metres, kilograms and seconds";
  if (value.find('\\') != value.npos) return "in paths write / between folders, or \\\\";
  if (value.back() == ';') return "lines end without ;";
  if (has_bare_point(value)) return "a digit comes before the point, as in 0.12";
  if (value.find(',') == value.npos && std::count(value.begin(), value.end(), '[') == 1 &&
      value.find(' ') != value.npos)
    return "vectors have commas, as in [0, 0, 0]";
  if (value[0] == '(') return "vectors have square brackets, as in [0, 0, 0]";
  if (has_bare_words(value))
    return "words have quotes, which a shell takes away: write 'ADDRESS=[\"snow\"]' with single "
           "quotes around";
  if (is_letter(value[0])) return "words have quotes, as in \"snow\"";
  return {};
}

}  // namespace

Table parse_toml(std::string_view text, const std::string& file) {
  const AsciiToml source = to_ascii_toml(text, file);
  const Converter convert(source);
  try {
    return convert.table(::toml::parse(source.text));
  } catch (const ::toml::parse_error& error) {
    const Location at = convert.where(error.source());
    throw SceneError(file, at.line, at.column, message_of(error), advice_on(text, at.line));
  }
}

std::string unquoted(const std::string& value) {
  if (value.size() < 2 || value.front() != value.back() ||
      (value.front() != '"' && value.front() != '\''))
    return value;
  try {
    const Table table = parse_toml("value = " + value, "");
    if (const auto* text = std::get_if<std::string>(&table.entries.at(0).value.data)) return *text;
  } catch (const SceneError&) {
  }
  return value;
}

}  // namespace neve::app::scene::toml
