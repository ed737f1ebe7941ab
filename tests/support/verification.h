#pragma once
/// Checks whose numbers end up in docs/verification.md. If NEVE_VERIFICATION_DIR names a folder,
/// every check leaves a line in <suite>.<test>.tsv there, and curves leave <name>.dat for plots;
/// docs/verification/make turns both into the page. Elsewhere these are plain expectations.

#include <gtest/gtest.h>

#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <locale>
#include <sstream>
#include <string>
#include <vector>

namespace neve::test {

/// Subject of a comparison: a table of the page, and a line in it.
struct Quantity {
  std::string table;  ///< names the table of the page
  std::string line;   ///< case and parameters
  std::string name;   ///< with its unit
};

/// Folder for the results, empty if nobody wants them.
inline std::filesystem::path verification_folder() {
  const char* folder = std::getenv("NEVE_VERIFICATION_DIR");
  if (!folder || !*folder) return {};
  std::filesystem::create_directories(folder);
  return folder;
}

inline std::string in_digits(double x, int digits = 9) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(digits);
  text << x;
  return text.str();
}

/// Appends a line to the results of the running test; the first line of a process replaces earlier
/// ones.
inline void keep_row(const std::vector<std::string>& fields) {
  const std::filesystem::path folder = verification_folder();
  if (folder.empty()) return;
  static std::string open_for;
  const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
  const std::string test = std::string(info->test_suite_name()) + "." + info->name();
  const auto mode = open_for == test ? std::ios::app : std::ios::trunc;
  open_for = test;
  std::ofstream out(folder / (test + ".tsv"), std::ios::out | mode);
  for (std::size_t f = 0; f < fields.size(); ++f) out << (f ? "\t" : "") << fields[f];
  out << '\n';
}

/// Returns a number for people: six digits, two of what is nearly nothing.
inline std::string in_short(double x) {
  return in_digits(x, std::abs(x) < 1e-6 ? 2 : 6);
}

inline void keep_check(const Quantity& q, const std::string& expected, double measured,
                       const std::string& tolerance, bool holds) {
  keep_row(
      {q.table, q.line, q.name, expected, in_short(measured), tolerance, holds ? "yes" : "**no**"});
}

/// |measured - expected| <= tolerance, all in the quantity's unit.
inline void verify_near(const Quantity& q, double expected, double measured, double tolerance) {
  const bool holds = std::abs(measured - expected) <= tolerance;
  EXPECT_TRUE(holds) << q.table << ", " << q.line << ": " << q.name << " = " << measured
                     << ", expected " << expected << " within " << tolerance;
  keep_check(q, in_short(expected), measured, "± " + in_digits(tolerance, 2), holds);
}

/// measured / expected within 1 +- tolerance.
inline void verify_ratio(const Quantity& q, double expected, double measured, double tolerance) {
  const bool holds = std::abs(measured / expected - 1) <= tolerance;
  EXPECT_TRUE(holds) << q.table << ", " << q.line << ": " << q.name << " = " << measured
                     << ", expected " << expected << " within " << 100 * tolerance << " %";
  keep_check(q, in_short(expected), measured, "± " + in_digits(100 * tolerance, 2) + " %", holds);
}

inline void verify_at_least(const Quantity& q, double bound, double measured) {
  EXPECT_GE(measured, bound) << q.table << ", " << q.line << ": " << q.name;
  keep_check(q, "at least " + in_digits(bound), measured, "", measured >= bound);
}

inline void verify_at_most(const Quantity& q, double bound, double measured) {
  EXPECT_LE(measured, bound) << q.table << ", " << q.line << ": " << q.name;
  keep_check(q, "at most " + in_digits(bound), measured, "", measured <= bound);
}

/// A number for the page that nothing is demanded of.
inline void keep_number(const Quantity& q, double measured) {
  keep_row({q.table, q.line, q.name, "", in_short(measured), "", ""});
}

/// "FLIP 0.95, cubic" -> "flip_0.95_cubic".
inline std::string file_name(const std::string& label) {
  std::string out;
  for (const char c : label) {
    if (c == ',') continue;
    out += c == ' ' ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return out;
}

/// Columns of numbers for a plot.
class Curve {
 public:
  /// @param columns their names and units, for the reader of the file
  Curve(const std::string& name, const std::string& columns) {
    const std::filesystem::path folder = verification_folder();
    if (folder.empty()) return;
    out_.open(folder / (name + ".dat"));
    out_ << "# " << columns << '\n';
  }
  void add(const std::vector<double>& numbers) {
    if (!out_.is_open()) return;
    for (std::size_t n = 0; n < numbers.size(); ++n)
      out_ << (n ? " " : "") << in_digits(numbers[n]);
    out_ << '\n';
  }

 private:
  std::ofstream out_;
};

}  // namespace neve::test
