#include "app/setup/caps.h"

#include <cstdlib>
#include <optional>

#include "app/advice/suggest.h"
#include "app/support/errors.h"
#include "app/support/room.h"
#include "app/support/text.h"

namespace neve::app::setup {

namespace {

constexpr const char *memory_name = memory_cap_name, *particle_name = "NEVE_MAX_PARTICLES";

std::string text_of(const char* name) {
  const char* text = std::getenv(name);
  return text ? text : "";
}

/// Returns a cap; none if the variable is missing or empty.
double cap_of(const char* name, double (*read)(const std::string&, const std::string&)) {
  const std::string text = text_of(name);
  return text.empty() ? std::numeric_limits<double>::infinity() : read(text, name);
}

}  // namespace

double memory_cap(const std::string& text, const std::string& where) {
  std::optional<double> bytes = bytes_of(text);
  if (!bytes) bytes = finite_number(text);
  // Nothing runs in less: 16 is 16GiB without its unit.
  constexpr double least = 1e6, max_gib = 1e5;
  if (bytes && *bytes > 0 && *bytes < least)
    throw UsageError(where, "\"" + text + "\" is less than a run needs",
                     finite_number(text) && *bytes < max_gib ? advice::did_you_mean(text + "GiB")
                                                             : "expected a size such as 8GiB");
  if (!bytes || !(*bytes >= 1))
    throw UsageError(where, "cannot use \"" + text + "\"",
                     "expected bytes, or a size such as 8GiB or 500MB");
  return *bytes;
}

double particle_cap(const std::string& text, const std::string& where) {
  const std::optional<double> count = finite_number(text);
  if (!count || !(*count >= 1))
    throw UsageError(where, "cannot use \"" + text + "\"",
                     "expected a number of particles, such as 2000000 or 2e6");
  return *count;
}

Caps caps() {
  return {cap_of(memory_name, memory_cap), cap_of(particle_name, particle_cap)};
}

CapTexts cap_texts() {
  return {text_of(memory_name), text_of(particle_name)};
}

void hold_caps(const CapTexts& texts) {
  const Caps before = caps();
  if (!texts.memory.empty() && memory_cap(texts.memory, "--max-memory") < before.memory)
    ::setenv(memory_name, texts.memory.c_str(), 1);
  if (!texts.particles.empty() &&
      particle_cap(texts.particles, "--max-particles") < before.particles)
    ::setenv(particle_name, texts.particles.c_str(), 1);
}

}  // namespace neve::app::setup
