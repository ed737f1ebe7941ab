#pragma once
/// The rules of a Cinema database, specification D, as its reference validator and viewer check
/// them (cinemascience/cinema_lib, cinema_components).

#include <charconv>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace neve::test {

using CsvRow = std::vector<std::string>;

/// RFC 4180.
inline std::vector<CsvRow> parse_csv(const std::string& text) {
  std::vector<CsvRow> rows;
  CsvRow row(1);
  bool is_quoted = false;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const char c = text[k];
    if (is_quoted && c == '"' && k + 1 < text.size() && text[k + 1] == '"') {
      row.back() += text[++k];
    } else if (c == '"') {
      is_quoted = !is_quoted;
    } else if (!is_quoted && c == ',') {
      row.emplace_back();
    } else if (!is_quoted && c == '\n') {
      rows.push_back(row);
      row.assign(1, "");
    } else {
      row.back() += c;
    }
  }
  return rows;
}

/// integer, float, string, or "" for a missing value.
inline std::string cinema_type(const std::string& value) {
  if (value.empty()) return "";
  std::string lower;
  for (const char c : value) lower += static_cast<char>(std::tolower(c));
  if (lower == "nan") return "float";
  const char* end = value.data() + value.size();
  long long whole = 0;
  if (auto r = std::from_chars(value.data(), end, whole); r.ec == std::errc{} && r.ptr == end)
    return "integer";
  double x = 0;
  if (auto r = std::from_chars(value.data(), end, x); r.ec == std::errc{} && r.ptr == end)
    return "float";
  return "string";
}

/// Fault of the database in a folder; "" for none.
inline std::string cinema_problem(const std::string& csv, const std::filesystem::path& folder) {
  const std::vector<CsvRow> rows = parse_csv(csv);
  if (rows.size() < 2) return "no rows";
  const CsvRow& head = rows[0];
  if (head.size() < 2) return "fewer than two columns";
  std::set<std::string> names;
  std::size_t first_file = head.size();
  for (std::size_t c = 0; c < head.size(); ++c) {
    const std::string& name = head[c];
    if (name.empty() || name.front() == ' ' || name.back() == ' ') return "bad name " + name;
    if (!names.insert(name).second) return "two columns " + name;
    if (name.starts_with("FILE") && first_file == head.size()) first_file = c;
    if (!name.starts_with("FILE") && c > first_file) return "FILE columns are not the last";
  }
  for (std::size_t c = 0; c < head.size(); ++c) {
    std::string type;
    for (std::size_t r = 1; r < rows.size(); ++r) {
      if (rows[r].size() != head.size()) return "row " + std::to_string(r) + " has another length";
      const std::string& value = rows[r][c];
      const std::string found = cinema_type(value);
      if (found.empty()) continue;
      if (type.empty()) type = found;
      if (type != found) return head[c] + " is " + type + " and " + found + ": " + value;
      if (c < first_file) continue;
      if (value.starts_with("/")) return "absolute path " + value;
      if (!std::filesystem::exists(folder / value)) return "no file " + value;
    }
    if (type.empty() && c < first_file) return "nothing in column " + head[c];
  }
  return "";
}

}  // namespace neve::test
