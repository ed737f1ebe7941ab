#include "app/bench/bench_report.h"

#include <algorithm>

#include "app/support/machine.h"
#include "app/support/text.h"
#include "app/support/version.h"

namespace neve::app::bench {

namespace {

using Cells = std::vector<std::string>;

/// Three digits, as many as a measurement is worth.
std::string figure(double value) {
  if (value >= 100 || value == 0) return fixed_text(value, 0);
  return fixed_text(value, value >= 10 ? 1 : value >= 1 ? 2 : 3);
}

std::vector<Cells> figures(const std::vector<BenchRow>& rows) {
  std::vector<Cells> table{
      {"name", "threads", "particles", "SIMD", "median", "min", "max", "unit", "x naive"}};
  for (const BenchRow& row : rows)
    table.push_back({row.name, std::to_string(row.threads), std::to_string(row.particles), row.simd,
                     figure(row.value.median), figure(row.value.min), figure(row.value.max),
                     row.unit, row.ratio_to_naive ? fixed_text(*row.ratio_to_naive, 1) : ""});
  return table;
}

/// Returns the table of phases; empty when no row has any. Explicit steps have no solve.
std::vector<Cells> phase_figures(const std::vector<BenchRow>& rows) {
  std::vector<Phase> taken;
  for (const Phase& phase : phases)
    if (std::any_of(rows.begin(), rows.end(), [&](const BenchRow& row) {
          return row.phases && (*row.phases).*phase.seconds > 0;
        }))
      taken.push_back(phase);
  std::vector<Cells> table;
  for (const BenchRow& row : rows) {
    if (!row.phases) continue;
    if (table.empty()) {
      table.push_back({"ns per particle and step", "threads", "particles"});
      for (const Phase& phase : taken) table.front().push_back(phase.name);
      table.front().push_back("all");
    }
    Cells cells{row.name, std::to_string(row.threads), std::to_string(row.particles)};
    double all = 0;
    for (const Phase& phase : taken) {
      const double nanoseconds = 1e9 * (*row.phases).*phase.seconds;
      cells.push_back(fixed_text(nanoseconds, 1));
      all += nanoseconds;
    }
    cells.push_back(fixed_text(all, 1));
    table.push_back(cells);
  }
  return table;
}

bool is_number(const std::string& cell) {
  return !cell.empty() && cell.find_first_not_of("0123456789.") == std::string::npos;
}

void print_columns(std::ostream& out, const std::vector<Cells>& table) {
  if (table.empty()) return;
  std::vector<std::size_t> width(table.front().size());
  for (const Cells& cells : table)
    for (std::size_t c = 0; c < cells.size(); ++c) width[c] = std::max(width[c], cells[c].size());
  for (const Cells& cells : table) {
    std::string line;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const std::string space(width[c] - cells[c].size(), ' ');
      line += is_number(cells[c]) ? space + cells[c] : cells[c] + space;
      line += "  ";
    }
    line.erase(line.find_last_not_of(' ') + 1);
    out << line << "\n";
  }
}

void print_markdown_table(std::ostream& out, const std::vector<Cells>& table) {
  if (table.empty()) return;
  for (std::size_t r = 0; r < table.size(); ++r) {
    for (const std::string& cell : table[r]) out << "| " << cell << " ";
    out << "|\n";
    if (r > 0) continue;
    for (std::size_t c = 0; c < table[r].size(); ++c) out << "| --- ";
    out << "|\n";
  }
}

}  // namespace

const char* const throughput_unit = "M particle-steps/s";

Statistics statistics_of(std::vector<double> samples) {
  std::sort(samples.begin(), samples.end());
  const std::size_t half = samples.size() / 2;
  const double median =
      samples.size() % 2 ? samples[half] : 0.5 * (samples[half - 1] + samples[half]);
  return {median, samples.front(), samples.back()};
}

void RowSamples::add(const BenchRow& row, double sample) {
  auto found = std::ranges::find(rows_, row.name, [](const auto& r) { return r.first.name; });
  if (found == rows_.end()) found = rows_.insert(found, {row, {}});
  found->second.push_back(sample);
}

std::vector<BenchRow> RowSamples::rows() const {
  std::vector<BenchRow> rows;
  for (const auto& [row, samples] : rows_) {
    rows.push_back(row);
    rows.back().value = statistics_of(samples);
  }
  return rows;
}

Json to_json(const std::vector<BenchRow>& rows) {
  Json list = Json::array();
  for (const BenchRow& row : rows) {
    Json json;
    json["name"] = row.name;
    json["threads"] = row.threads;
    json["particles"] = row.particles;
    json["simd"] = row.simd;
    json["median"] = number_or_null(row.value.median);
    json["min"] = number_or_null(row.value.min);
    json["max"] = number_or_null(row.value.max);
    json["unit"] = row.unit;
    if (row.ratio_to_naive) json["ratio_to_naive"] = number_or_null(*row.ratio_to_naive);
    if (row.phases)
      for (const Phase& phase : phases)
        json["phases_ns"][phase.name] = number_or_null(1e9 * (*row.phases).*phase.seconds);
    list.push_back(json);
  }
  return list;
}

void print_tables(std::ostream& out, const std::vector<BenchRow>& rows, bool is_markdown) {
  if (is_markdown) out << machine_text() << "; neve " << version << "\n\n";
  const auto print = is_markdown ? print_markdown_table : print_columns;
  print(out, figures(rows));
  const std::vector<Cells> by_phase = phase_figures(rows);
  if (!by_phase.empty()) out << "\n";
  print(out, by_phase);
}

}  // namespace neve::app::bench
