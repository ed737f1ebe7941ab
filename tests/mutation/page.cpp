#include "tests/mutation/page.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "sim/checks/self_test.h"
#include "sim/checks/watch.h"

namespace neve::test {

namespace {

constexpr const char* introduction = R"(# Classic mistakes and the checks that notice them

A test builds each classic mistake of a snow solver into a copy of the sources and runs it: first the
self-tests of `neve doctor`, then two scenes with `neve render --validate`, a snowball thrown on a sticky
floor and an elastic box that spins in free flight. The table lists the checks that notice each mistake;
"stopped" is a rule that ends any run, with or without `--validate`. In correct code no check fires. Some
mistakes show in no run: they make snow too soft, or affect rotations where little rotates, and all
energies and momenta add up. Only a state with a known answer reveals them. Other mistakes look right in
a straight drop and explode in a rotation. `./neve test --all` (label `mutation`) builds all mistakes
again and compares this page with the result. The test also fails if a mistake goes unnoticed, or if a
check notices no mistake.

)";

constexpr const char* about_self_tests = R"(
## The self-tests

`neve doctor` runs them with every kernel, transfer and precision through the kernels of the instruction
set in use. It prints the worst value and the tolerance. The self-tests take a third of a second. A
failure gives exit code 9.

| self-test | claim | mistakes noticed |
| --- | --- | --- |
)";

constexpr const char* about_watch = R"(
## The checks of --validate

`neve render --validate` measures the first steps, then fewer and fewer, down to every 256th. It takes a
step of a copy, so the run keeps its bits; on one thread this costs as much as 25 steps. The first value
out of bounds gives a warning with step, value, meaning and remedy. All are counted in run.json
(`validation`; in a resumed run, those after the resume). A value beyond the error level ends the run
with exit code 9; its pictures are kept. In adaptive steps, the first two checks warn above the limits of
the scene.

| check | quantity and meaning | warning | error | mistakes noticed |
| --- | --- | --- | --- | --- |
)";

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "–" : text;
}

std::string number(double x) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out << x;
  return out.str();
}

/// Returns the text as the cell of a table.
std::string cell(const std::string& text) {
  std::string escaped;
  for (const char c : text) escaped += c == '|' ? "\\|" : std::string(1, c);
  return escaped;
}

/// Number of mistakes that a check notices.
std::size_t count(const std::vector<Finding>& findings, const std::string& check,
                  bool is_self_test) {
  const auto has = [&](const std::vector<std::string>& names) {
    return std::find(names.begin(), names.end(), check) != names.end();
  };
  return static_cast<std::size_t>(
      std::count_if(findings.begin(), findings.end(), [&](const Finding& finding) {
        return is_self_test ? has(finding.self_tests) : has(finding.drop) || has(finding.spin);
      }));
}

/// Run on nothing: names and what they test.
std::vector<sim::checks::SelfTestResult> list_of_self_tests() {
  return sim::checks::self_tests({});
}

std::string limits(double in_double, double in_float) {
  if (std::isinf(in_double)) return "–";
  return number(in_double) + (in_float == in_double ? "" : " (float " + number(in_float) + ")");
}

std::vector<sim::checks::WatchRecord> records(sim::Precision precision) {
  sim::SolverSettings settings;
  settings.precision = precision;
  settings.time_step = sim::TimeStep::fixed;
  return sim::checks::Watch(settings, {sim::Material{}}).records();
}

std::string watch_table(const std::vector<Finding>& findings) {
  const auto in_double = records(sim::Precision::real64),
             in_float = records(sim::Precision::single);
  std::string text = about_watch;
  for (std::size_t k = 0; k < in_double.size(); ++k) {
    const sim::checks::WatchRecord& d = in_double[k];
    const std::string name = sim::checks::name(d.check), side = d.is_below ? "< " : "> ";
    text += "| " + name + " | " + cell(sim::checks::quantity(d.check)) + ": " +
            sim::checks::meaning(d.check) + " | " + side +
            limits(d.threshold, in_float[k].threshold) + " | " + (std::isinf(d.error) ? "" : side) +
            limits(d.error, in_float[k].error) + " | " +
            std::to_string(count(findings, name, false)) + " |\n";
  }
  return text;
}

}  // namespace

std::string row(const Mistake& mistake, const Finding& finding) {
  return "| " + cell(mistake.title) + " | " + joined(finding.self_tests) + " | " +
         joined(finding.drop) + " | " + joined(finding.spin) + " |";
}

std::string page(const std::vector<Mistake>& mistakes, const std::vector<Finding>& findings) {
  std::string text = introduction;
  text +=
      "| mistake | self-tests that fail | snowball | spinning box |\n| --- | --- | --- | --- |\n";
  for (std::size_t k = 0; k < mistakes.size(); ++k) text += row(mistakes[k], findings[k]) + "\n";
  text += "\nDifferences from the classic form:\n\n";
  for (const Mistake& mistake : mistakes)
    if (!mistake.note.empty()) text += "- " + mistake.title + ": " + mistake.note + ".\n";
  text += about_self_tests;
  for (const auto& test : list_of_self_tests())
    text += "| " + test.name + " | " + test.what + " | " +
            std::to_string(count(findings, test.name, true)) + " |\n";
  return text + watch_table(findings);
}

std::vector<std::string> idle_checks(const std::vector<Finding>& findings) {
  std::vector<std::string> idle;
  for (const auto& test : list_of_self_tests())
    if (count(findings, test.name, true) == 0) idle.push_back(test.name);
  for (const sim::checks::WatchRecord& record : records(sim::Precision::real64))
    if (const std::string name = sim::checks::name(record.check); count(findings, name, false) == 0)
      idle.push_back(name);
  return idle;
}

}  // namespace neve::test
