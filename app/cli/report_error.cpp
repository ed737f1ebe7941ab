#include "app/cli/command_line.h"

#include <poll.h>
#include <unistd.h>

#include <filesystem>
#include <iostream>
#include <new>
#include <utility>
#include <vector>

#include "app/options/common.h"
#include "app/scene/toml/error.h"
#include "app/support/errors.h"
#include "app/support/interrupt.h"
#include "app/support/progress.h"
#include "app/support/text.h"
#include "render/gl/context.h"
#include "render/image/image.h"
#include "render/renderer.h"
#include "sim/kernels/simd.h"
#include "sim/seeding/seeding.h"

namespace neve::app::cli {

namespace {

struct Report {
  int code = exit_internal;
  std::string line;  ///< as printed
  std::string message, where, hint;
  std::string file{};                   ///< with the place of the mistake; empty: not in a file
  int row = 0, column = 0;              ///< from 1; 0: not known
  std::vector<std::string> warnings{};  ///< before the error
};

Report plain_report(int code, const std::string& message, const std::string& where = {},
                    const std::string& hint = {}) {
  return {code, "neve: error: " + message, message, where, hint};
}

Report of_error(const Error& error) {
  Report report = plain_report(error.code, error.what(), error.where, error.hint);
  report.warnings = error.warnings;
  const bool is_said = report.message.find(error.hint) != std::string::npos;
  if (dynamic_cast<const IoError*>(&error) && !is_said) report.line += "; " + error.hint;
  // Errors in files start with the file already.
  const std::string start = error.where + ": error: ";
  if (error.where.empty() || !report.message.starts_with(start)) return report;
  report.line.erase(0, std::string("neve: error: ").size());
  report.message.erase(0, start.size());
  return report;
}

Report out_of_memory() {
  const std::string message =
      "out of memory: this machine, or a limit on the process, gave no more";
  const std::string hint =
      "end other programs, raise the limit (ulimit -v), or make solver.cell_size larger; "
      "neve render --dry-run says how much a scene takes";
  Report report = plain_report(exit_refused, message, {}, hint);
  report.line += "; " + hint;
  return report;
}

Report describe_current_error() {
  try {
    throw;
  } catch (const scene::toml::SceneError& error) {
    const std::string place =
        error.line > 0 ? ":" + std::to_string(error.line) + ":" + std::to_string(error.column) : "";
    return {exit_invalid_scene, error.what(), error.message, error.file + place,
            error.hint,         error.file,   error.line,    error.column};
  } catch (const UsageError& error) {
    const std::string hint = error.hint.empty() ? "" : "; " + error.hint;
    const std::string where = error.where.empty() ? "" : error.where + ": ";
    Report report = plain_report(exit_usage, where + error.message + hint, error.where, error.hint);
    report.message = error.message;
    return report;
  } catch (const Error& error) {
    return of_error(error);
  } catch (const sim::ShapeError& error) {
    return plain_report(exit_invalid_scene, error.what());
  } catch (const sim::kernels::SimdError& error) {
    return plain_report(exit_usage, error.what(), "NEVE_SIMD", "unset NEVE_SIMD to use the widest");
  } catch (const render::ParticlePathError& error) {
    return plain_report(exit_usage, error.what(), "NEVE_PARTICLES",
                        "unset NEVE_PARTICLES to choose");
  } catch (const render::gl::ContextError& error) {
    return plain_report(exit_no_backend, error.what(), {}, "neve doctor explains each backend");
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  } catch (const std::filesystem::filesystem_error& error) {
    const std::string file = error.path1().string();
    return plain_report(exit_io, file + ": " + error.code().message(), file);
  } catch (const nlohmann::json::exception& error) {
    return plain_report(exit_invalid_scene,
                        std::string("a JSON file is not as neve wrote it: ") + error.what());
  } catch (const render::ImageError& error) {
    return plain_report(exit_invalid_scene, std::string("a picture is damaged: ") + error.what());
  } catch (const std::exception& error) {
    return plain_report(exit_internal, error.what());
  } catch (...) {
    return plain_report(exit_internal, "unknown exception");
  }
}

Json to_json(const Report& report) {
  Json json;
  json["error"] = report.message;
  json["exit_code"] = report.code;
  json["where"] = report.where;
  if (!report.file.empty()) json["file"] = report.file;
  if (report.row > 0) json["line"] = report.row;
  if (report.row > 0) json["column"] = report.column;
  json["hint"] = report.hint;
  json["warnings"] = report.warnings;
  return json;
}

/// The line on stderr.
std::string words_of(const Report& report, const ErrorOutput& output) {
  if (!output.is_progress_json) return printable_text(report.line);
  Json event{{"event", "error"}};
  event.update(to_json(report));
  return to_text(event, -1);
}

/// The answer of the command that runs; null: none.
Json& kept_answer() {
  static Json answer;
  return answer;
}

/// Returns what the command has answered, and that it failed.
Json with_answer(Json error) {
  Json json = std::exchange(kept_answer(), {});
  if (!json.is_object()) return error;
  if (error["warnings"].empty()) error.erase("warnings");
  json.update(error);
  if (!json.contains("warnings")) json["warnings"] = Json::array();
  return json;
}

}  // namespace

void set_answer(Json answer) {
  kept_answer() = std::move(answer);
}

void prepare_interrupt(const ErrorOutput& output) {
  const Report report = plain_report(exit_interrupted, "interrupted before anything was made");
  set_last_words(words_of(report, output) + "\n",
                 output.is_json ? to_text(to_json(report)) + "\n" : "");
}

int report_current_error(const ErrorOutput& output) {
  const Report report = describe_current_error();
  std::cerr << words_of(report, output) << std::endl;
  if (!output.log.empty() && options::is_log_name(output.log))
    append_line(output.log, time_text() + "  " + report.line);
  if (output.is_json) std::cout << to_text(with_answer(to_json(report))) << std::endl;
  return report.code;
}

void finish_output() {
  if (const Json answer = std::exchange(kept_answer(), {}); !answer.is_null())
    std::cout << to_text(answer) << "\n";
  if (std::cout.flush()) return;
  pollfd out{STDOUT_FILENO, 0, 0};
  const bool is_reader_gone = ::poll(&out, 1, 0) == 1 && (out.revents & POLLERR) != 0;
  if (!is_reader_gone) throw IoError("cannot write to standard output", "stdout");
}

}  // namespace neve::app::cli
