#include <algorithm>
#include <iostream>

#include "app/cli/commands.h"
#include "app/support/errors.h"
#include "app/support/json.h"
#include "render/gl/context.h"
#include "render/self_test.h"
#include "sim/checks/self_test.h"

namespace neve::app::cli {

namespace {

/// Tests one backend: it opens and draws correctly.
struct Examination {
  render::gl::Attempt attempt;
  std::string picture_fault;  ///< empty: the test picture is right, or none could be drawn
};

Examination examine(const render::gl::Attempt& attempt) {
  Examination result{attempt, {}};
  if (!attempt.available) return result;
  try {
    const auto context = render::gl::open_context(attempt.backend);
    result.picture_fault = render::self_test(*context);
  } catch (const std::exception& error) {
    result.picture_fault = error.what();
  }
  return result;
}

Json examination_json(const Examination& examination) {
  const render::gl::Attempt& attempt = examination.attempt;
  const bool is_right = attempt.available && examination.picture_fault.empty();
  Json json;
  json["name"] = attempt.backend;
  json["available"] = attempt.available;
  json["version"] = attempt.version;
  json["renderer"] = attempt.renderer;
  json["software"] = attempt.is_software;
  json["reason"] = attempt.available ? examination.picture_fault : attempt.reason;
  json["install"] = attempt.install;
  json["picture"] = attempt.available ? Json(is_right) : Json();
  return json;
}

void print_line(const Examination& examination) {
  const render::gl::Attempt& attempt = examination.attempt;
  std::cout << attempt.backend
            << std::string(18 - std::min<std::size_t>(17, attempt.backend.size()), ' ');
  if (attempt.available) {
    std::cout << "works     OpenGL " << attempt.version << "; " << attempt.renderer
              << (attempt.is_software ? " (software)" : "") << "; test picture "
              << (examination.picture_fault.empty() ? "right"
                                                    : "WRONG: " + examination.picture_fault)
              << "\n";
    return;
  }
  std::cout << "fails     " << attempt.reason << "\n";
  if (!attempt.install.empty()) std::cout << std::string(28, ' ') << attempt.install << "\n";
}

Json self_test_json(const sim::checks::SelfTestResult& result) {
  return {{"check", result.name}, {"passed", result.passed}, {"detail", result.detail}};
}

void print_line(const sim::checks::SelfTestResult& result) {
  const std::string label = "physics: " + result.name;
  std::cout << label << std::string(28 - std::min<std::size_t>(27, label.size()), ' ')
            << (result.passed ? "right     " : "WRONG     ") << result.detail << "\n";
}

}  // namespace

int run_doctor(const PlainOptions& options) {
  std::vector<Examination> examinations;
  for (const render::gl::Attempt& attempt : render::gl::try_all_backends())
    examinations.push_back(examine(attempt));
  const std::vector<sim::checks::SelfTestResult> physics =
      sim::checks::self_tests(sim::checks::all_self_test_cases());

  if (options.is_json) {
    Json json;
    json["backends"] = Json::array();
    for (const Examination& examination : examinations)
      json["backends"].push_back(examination_json(examination));
    json["physics"] = Json::array();
    for (const sim::checks::SelfTestResult& result : physics)
      json["physics"].push_back(self_test_json(result));
    std::cout << to_text(json) << "\n";
  } else {
    for (const Examination& examination : examinations) print_line(examination);
    for (const sim::checks::SelfTestResult& result : physics) print_line(result);
  }
  const bool is_right = std::ranges::all_of(physics, &sim::checks::SelfTestResult::passed) &&
                        std::ranges::all_of(examinations, [](const Examination& e) {
                          return e.picture_fault.empty();
                        });
  if (!is_right) return exit_check_failed;
  const bool is_any_there =
      std::ranges::any_of(examinations, [](const Examination& e) { return e.attempt.available; });
  return is_any_there ? exit_ok : exit_no_backend;
}

}  // namespace neve::app::cli
