// An own reader rather than libcsv (Debian): that hands over every field of every column by
// call-back, knows no line numbers, and finding the columns and reading numbers would remain.
#include <algorithm>

#include "sim/files/file_axes.h"
#include "sim/files/input_file.h"
#include "sim/files/point_table.h"

namespace neve::sim::files {
namespace {

/// Blanks, any number of them.
constexpr char blanks = ' ';

/// The length of a field, up to its separator or the end of the line. Separators between quotes are
/// part of it; two quotes there are one.
std::size_t field_length(std::string_view line, char separator) {
  std::size_t at = 0;
  while (at < line.size() && is_blank(line[at]) && line[at] != separator) ++at;
  if (!line.substr(at).starts_with('"')) return std::min(line.find(separator, at), line.size());
  at = line.find('"', at + 1);
  while (at != std::string_view::npos && line.substr(at + 1).starts_with('"'))
    at = line.find('"', at + 2);
  return std::min(line.find(separator, at), line.size());
}

/// Words between blanks.
void split_words(std::string_view line, std::size_t most, std::vector<std::string_view>& fields) {
  for (line = trimmed(line); !line.empty() && fields.size() <= most; line = trimmed(line)) {
    const auto end = std::find_if(line.begin(), line.end(), is_blank);
    fields.push_back(line.substr(0, static_cast<std::size_t>(end - line.begin())));
    line.remove_prefix(fields.back().size());
  }
}

/// The fields of a line; those beyond `most` are counted only up to one more.
void split_fields(std::string_view line, char separator, std::size_t most,
                  std::vector<std::string_view>& fields) {
  fields.clear();
  if (separator == blanks) return split_words(line, most, fields);
  while (fields.size() <= most) {
    const std::size_t length = field_length(line, separator);
    std::string_view field = trimmed(line.substr(0, length));
    if (field.size() >= 2 && field.front() == '"' && field.back() == '"')
      field = field.substr(1, field.size() - 2);
    fields.push_back(field);
    if (length == line.size()) break;
    line.remove_prefix(length + 1);
  }
}

bool says_nothing(std::string_view line) {
  line = trimmed(line);
  return line.empty() || line.front() == '#';
}

/// The most frequent; a comma where there are as many of others. Blanks where there is none.
char separator_of(std::string_view header) {
  header = trimmed(header);
  const auto count = [&](char c) { return std::count(header.begin(), header.end(), c); };
  char found = ',';
  for (const char c : {';', '\t'})
    if (count(c) > count(found)) found = c;
  return count(found) == 0 && count(' ') > 0 ? blanks : found;
}

/// A number with a decimal comma, which fields that commas do not separate may have.
std::optional<double> number_with_comma(std::string_view field) {
  if (std::count(field.begin(), field.end(), ',') != 1 || field.find('.') != std::string_view::npos)
    return std::nullopt;
  std::string number(field.substr(0, 400));
  std::replace(number.begin(), number.end(), ',', '.');
  return number_in(number);
}

class PointCsv {
 public:
  PointCsv(std::string_view text, const std::string& name) : lines_(text), name_(name) {}

  PointCloud read(const std::vector<std::string>& further) {
    PointTable points = read_header();
    points.carry(further, columns_, {}, here());
    std::vector<double> row(columns_.size());
    while (!lines_.at_end()) {
      const std::string_view line = lines_.next();
      if (says_nothing(line)) continue;
      read_row(line, points, row);
      use_axes(row, points);
      points.add(row, [&] { return here(); });
    }
    return points.take(name_);
  }

  std::vector<std::string> further() {
    read_header();
    std::vector<std::string> names = unknown_columns(columns_);
    std::erase_if(names, [](const std::string& name) { return says_axes(name); });
    return names;
  }

 private:
  std::string here() const { return name_ + ":" + std::to_string(lines_.number()); }

  /// The first line that is no comment; where it has numbers, as files of numpy's savetxt, the
  /// comment before it.
  PointTable read_header() {
    std::string_view header, comment;
    TableLines before = lines_;
    while (!lines_.at_end() && says_nothing(header)) {
      if (!trimmed(header).empty()) comment = header;
      before = lines_;
      header = lines_.next();
    }
    if (!trimmed(header).empty() && says_nothing(header)) comment = header;
    if (says_nothing(header)) refuse_input(name_, "it has no header line; expected x, y, z");
    split_header(header);
    comment.remove_prefix(std::min(comment.find_first_not_of("# \t"), comment.size()));
    if (number_in(fields_.front()) && !comment.empty()) {
      split_header(comment);
      lines_ = before;
    }
    if (number_in(fields_.front()))
      refuse_input(here(), "the first line has numbers; expected names of columns, as in x,y,z");
    columns_.assign(fields_.begin(), fields_.end());
    const auto found = std::find_if(columns_.begin(), columns_.end(), says_axes);
    if (found != columns_.end()) axes_column_ = static_cast<std::size_t>(found - columns_.begin());
    return PointTable(columns_, here());
  }

  static bool says_axes(std::string_view name) {
    return name == y_up_column || name == z_up_column;
  }

  /// Uses the axes of a row: rows of several files put together are each turned as they say.
  void use_axes(const std::vector<double>& row, PointTable& points) const {
    if (!axes_column_) return;
    if (const auto axes = axes_of_column(columns_[*axes_column_], row[*axes_column_], here()))
      points.use(*axes);
  }

  void split_header(std::string_view header) {
    separator_ = separator_of(header);
    split_fields(header, separator_, max_columns, fields_);
    if (fields_.size() > max_columns) refuse_input(here(), "more than 256 columns");
    if (fields_.empty()) fields_.push_back(header);
  }

  void read_row(std::string_view line, const PointTable& points, std::vector<double>& row) {
    split_fields(line, separator_, columns_.size(), fields_);
    if (fields_.size() > columns_.size())
      refuse_input(here(), "more fields than the header's " + std::to_string(columns_.size()));
    if (fields_.size() < columns_.size())
      refuse_input(here(), std::to_string(fields_.size()) + " fields; the header has " +
                               std::to_string(columns_.size()));
    for (std::size_t k = 0; k < fields_.size(); ++k) {
      if (!points.uses(k) && k != axes_column_) continue;
      std::optional<double> value = number_in(fields_[k]);
      if (!value && separator_ != ',') value = number_with_comma(fields_[k]);
      if (!value)
        refuse_input(here(), quoted_input(fields_[k]) + " is not a number, in column " +
                                 quoted_input(columns_[k]));
      row[k] = *value;
    }
  }

  TableLines lines_;
  const std::string& name_;
  char separator_ = ',';
  std::vector<std::string> columns_;
  std::optional<std::size_t> axes_column_;
  std::vector<std::string_view> fields_;  ///< of the present line
};

}  // namespace

PointCloud parse_csv_points(std::string_view text, const std::string& name,
                            const std::vector<std::string>& further) {
  return PointCsv(plain_text(text, name), name).read(further);
}

std::vector<std::string> further_csv_columns(std::string_view text, const std::string& name) {
  return PointCsv(plain_text(text, name), name).further();
}

}  // namespace neve::sim::files
