#include "render/gl/context.h"

#include <algorithm>

#include "render/gl/context_backends.h"

namespace neve::render::gl {
namespace {

struct Backend {
  const char* name;
  Opened (*open)();
};

constexpr Backend backends[] = {
    {"egl_device", open_egl_device},
    {"egl_surfaceless", open_egl_surfaceless},
    {"osmesa", open_osmesa},
    {"window", open_window},
};

std::vector<Backend> chosen_backends(const std::string& choice) {
  if (choice == "auto") return {backends[0], backends[1], backends[2]};
  if (choice == "egl") return {backends[0], backends[1]};
  for (const Backend& backend : backends) {
    if (choice == backend.name) return {backend};
  }
  std::string valid;
  for (const std::string& name : backend_names()) valid += (valid.empty() ? "" : ", ") + name;
  throw std::invalid_argument("unknown backend \"" + choice + "\"; expected one of " + valid);
}

/// Keeps the description of a backend; the context itself stays with the caller.
Attempt attempt_of(const Backend& backend, const Opened& opened) {
  Attempt attempt;
  attempt.backend = backend.name;
  attempt.available = opened.context != nullptr;
  attempt.reason = opened.reason;
  attempt.install = opened.install;
  if (opened.context) {
    attempt.version = opened.context->version;
    attempt.renderer = opened.context->renderer;
    attempt.is_software = opened.context->is_software;
  }
  return attempt;
}

std::string explain(const std::vector<Attempt>& attempts) {
  std::string message = "no OpenGL context: ";
  std::vector<std::string> installs;
  for (std::size_t i = 0; i < attempts.size(); ++i) {
    message += (i ? "; " : "") + attempts[i].backend + ": " + attempts[i].reason;
    const std::string& install = attempts[i].install;
    if (!install.empty() && std::find(installs.begin(), installs.end(), install) == installs.end())
      installs.push_back(install);
  }
  message += ". ";
  for (std::size_t i = 0; i < installs.size(); ++i)
    message += (i ? ", or " : "Install ") + installs[i];
  return message + (installs.empty() ? "See neve doctor" : ", or see neve doctor");
}

}  // namespace

const std::vector<std::string>& backend_names() {
  static const std::vector<std::string> names = {"auto",   "egl",   "egl_device", "egl_surfaceless",
                                                 "osmesa", "window"};
  return names;
}

std::unique_ptr<Context> open_context(const std::string& choice) {
  std::vector<Attempt> attempts;
  std::unique_ptr<Context> software;
  for (const Backend& backend : chosen_backends(choice)) {
    // OSMesa is always software: no reason to open it once something works.
    if (software && backend.open == open_osmesa) break;
    Opened opened = backend.open();
    attempts.push_back(attempt_of(backend, opened));
    if (!opened.context) continue;
    if (!opened.context->is_software) {
      software.reset();
      opened.context->make_current();
      return std::move(opened.context);
    }
    if (!software) software = std::move(opened.context);
  }
  if (!software) throw ContextError(explain(attempts), attempts);
  software->make_current();
  return software;
}

std::vector<Attempt> try_all_backends() {
  std::vector<Attempt> attempts;
  for (const Backend& backend : backends) attempts.push_back(attempt_of(backend, backend.open()));
  return attempts;
}

}  // namespace neve::render::gl
