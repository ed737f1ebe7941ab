#include "app/scene/toml/value.h"

#include <array>
#include <charconv>
#include <cmath>

namespace neve::app::scene::toml {
namespace {

bool is_bare(std::string_view key) {
  for (const char c : key) {
    const bool word = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (!word && c != '_' && c != '-') return false;
  }
  return !key.empty();
}

std::string key_text(std::string_view key) {
  return is_bare(key) ? std::string(key) : toml_string(key);
}

std::string inline_table(const Table& table) {
  if (table.entries.empty()) return "{}";
  std::string text = "{ ";
  for (const Entry& entry : table.entries) {
    if (&entry != &table.entries.front()) text += ", ";
    text += key_text(entry.key) + " = " + toml_literal(entry.value);
  }
  return text + " }";
}

std::string array_text(const Array& array) {
  std::string text = "[";
  for (const Value& value : array) {
    if (&value != &array.front()) text += ", ";
    text += toml_literal(value);
  }
  return text + "]";
}

struct Literal {
  std::string operator()(bool b) const { return b ? "true" : "false"; }
  std::string operator()(std::int64_t i) const { return std::to_string(i); }
  std::string operator()(double x) const { return number_text(x); }
  std::string operator()(const std::string& s) const { return toml_string(s); }
  std::string operator()(Date) const { return "a date"; }
  std::string operator()(const Array& a) const { return array_text(a); }
  std::string operator()(const Table& t) const { return inline_table(t); }
};

bool is_list_of_tables(const Value& value) {
  const Array* array = std::get_if<Array>(&value.data);
  return array && !array->empty() && std::holds_alternative<Table>(array->front().data);
}

bool is_table_of_tables(const Table& table) {
  return !table.entries.empty() && std::holds_alternative<Table>(table.entries.front().value.data);
}

std::string lines(const Table& table) {
  std::string text;
  for (const Entry& entry : table.entries) {
    text += key_text(entry.key) + " = " + toml_literal(entry.value) + "\n";
  }
  return text;
}

std::string section(const Entry& entry) {
  const std::string key = key_text(entry.key);
  std::string text;
  if (const Array* list = std::get_if<Array>(&entry.value.data)) {
    for (const Value& item : *list) {
      text += "\n[[" + key + "]]\n" + lines(std::get<Table>(item.data));
    }
    return text;
  }
  const Table& table = std::get<Table>(entry.value.data);
  if (!is_table_of_tables(table)) return "\n[" + key + "]\n" + lines(table);
  for (const Entry& item : table.entries) {
    text +=
        "\n[" + key + "." + key_text(item.key) + "]\n" + lines(std::get<Table>(item.value.data));
  }
  return text;
}

}  // namespace

Table::Table() = default;
Table::Table(const Table& other) = default;
Table::Table(Table&& other) noexcept = default;
Table& Table::operator=(const Table& other) = default;
Table& Table::operator=(Table&& other) noexcept = default;
Table::~Table() = default;

const Entry* Table::find(std::string_view key) const {
  for (const Entry& entry : entries) {
    if (entry.key == key) return &entry;
  }
  return nullptr;
}

Entry* Table::find(std::string_view key) {
  return const_cast<Entry*>(static_cast<const Table*>(this)->find(key));
}

std::string toml_literal(const Value& value, std::size_t limit) {
  std::string text = std::visit(Literal{}, value.data);
  if (limit == 0 || text.size() <= limit) return text;
  // Never cut inside a UTF-8 sequence.
  while (limit > 0 && (static_cast<unsigned char>(text[limit]) & 0xC0u) == 0x80u) --limit;
  return text.substr(0, limit) + "...";
}

std::string toml_document(const Table& root) {
  std::string keys, sections;
  for (const Entry& entry : root.entries) {
    if (std::holds_alternative<Table>(entry.value.data) || is_list_of_tables(entry.value)) {
      sections += section(entry);
    } else {
      keys += key_text(entry.key) + " = " + toml_literal(entry.value) + "\n";
    }
  }
  return keys + sections;
}

std::string toml_string(std::string_view text) {
  constexpr std::string_view hex = "0123456789abcdef";
  std::string out = "\"";
  for (std::size_t k = 0; k < text.size(); ++k) {
    const char c = text[k];
    const auto byte = static_cast<unsigned char>(c);
    const auto next = k + 1 < text.size() ? static_cast<unsigned char>(text[k + 1]) : 0;
    if (byte == 0xC2 && next >= 0x80 && next < 0xA0) {  // a control that terminals obey
      out += "\\u00";
      out += hex[next >> 4];
      out += hex[next & 15];
      ++k;
    } else if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (c == '\n') {
      out += "\\n";
    } else if (c == '\t') {
      out += "\\t";
    } else if (byte < 0x20 || byte == 0x7F) {
      out += "\\u00";
      out += hex[byte >> 4];
      out += hex[byte & 15];
    } else {
      out += c;
    }
  }
  return out + '"';
}

std::string number_text(double x) {
  // TOML writes them so; no parameter may be one.
  if (std::isnan(x)) return "nan";
  if (std::isinf(x)) return x < 0 ? "-inf" : "inf";
  if (x == 0) return std::signbit(x) ? "-0.0" : "0";
  // Whole numbers without exponent: 100000, not 1e+05.
  if (std::abs(x) <= 0x1p53 && x == std::trunc(x)) {
    return std::to_string(static_cast<std::int64_t>(x));
  }
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), x).ptr;
  std::string text(buffer.data(), end);
  // 5e-4 and 1e30, as people write them, not 5e-04 and 1e+30.
  if (const auto e = text.find('e'); e != std::string::npos) {
    if (text[e + 1] == '+') text.erase(e + 1, 1);
    const auto digits = text.find_first_of("0123456789", e);
    if (text[digits] == '0') text.erase(digits, 1);
  }
  // Without a point or exponent TOML would take it for an integer, which may not fit 64 bits.
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

}  // namespace neve::app::scene::toml
