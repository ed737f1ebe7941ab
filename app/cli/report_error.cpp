#include "app/cli/report_error.h"

#include <poll.h>
#include <unistd.h>

#include <iostream>
#include <new>

#include "app/scene/toml/error.h"
#include "app/support/errors.h"
#include "app/support/json.h"
#include "app/support/text.h"
#include "render/gl/context.h"
#include "render/renderer.h"
#include "sim/kernels/simd.h"
#include "sim/seeding/seeding.h"

namespace neve::app::cli {

namespace {

struct Report {
  int code = exit_internal;
  std::string line;  ///< as printed
  std::string message, where, hint;
};

Report plain_report(int code, const std::string& message, const std::string& where = {},
                    const std::string& hint = {}) {
  return {code, "neve: error: " + message, message, where, hint};
}

Report of_error(const Error& error) {
  Report report = plain_report(error.code, error.what(), error.where, error.hint);
  // Errors in files start with the file already.
  if (!error.where.empty() && report.message.starts_with(error.where + ": error: "))
    report.line = report.message;
  return report;
}

Report describe_current_error() {
  try {
    throw;
  } catch (const scene::toml::SceneError& error) {
    const std::string place =
        error.line > 0 ? ":" + std::to_string(error.line) + ":" + std::to_string(error.column) : "";
    return {exit_invalid_scene, error.what(), error.message, error.file + place, error.hint};
  } catch (const scene::toml::UsageError& error) {
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
    return plain_report(exit_refused, "out of memory", {}, "make solver.cell_size larger");
  } catch (const std::exception& error) {
    return plain_report(exit_internal, error.what());
  } catch (...) {
    return plain_report(exit_internal, "unknown exception");
  }
}

}  // namespace

int report_current_error(bool is_json) {
  const Report report = describe_current_error();
  std::cerr << printable_text(report.line) << std::endl;
  if (is_json) {
    Json json;
    json["error"] = report.message;
    json["where"] = report.where;
    json["hint"] = report.hint;
    std::cout << to_text(json) << std::endl;
  }
  return report.code;
}

void finish_output() {
  if (std::cout.flush()) return;
  pollfd out{STDOUT_FILENO, 0, 0};
  const bool is_reader_gone = ::poll(&out, 1, 0) == 1 && (out.revents & POLLERR) != 0;
  if (!is_reader_gone) throw IoError("cannot write to standard output", "stdout");
}

}  // namespace neve::app::cli
