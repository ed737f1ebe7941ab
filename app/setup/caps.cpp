#include "app/setup/caps.h"

#include <cmath>
#include <cstdlib>
#include <optional>
#include <utility>

#include "app/scene/leaf.h"
#include "app/setup/argument_text.h"
#include "app/setup/command_text.h"
#include "app/support/errors.h"
#include "app/support/text.h"

namespace neve::app::setup {

namespace {

constexpr const char *memory_name = "NEVE_MAX_MEMORY", *particle_name = "NEVE_MAX_PARTICLES";

double memory_of(const std::string& text, const std::string& where) {
  std::optional<double> bytes = scene::bytes_of(text);
  if (!bytes) bytes = finite_number(text);
  // Nothing runs in less: 16 is 16GiB without its unit.
  constexpr double least = 1e6;
  if (bytes && *bytes > 0 && *bytes < least)
    throw UsageError(where, "\"" + text + "\" is less than a run needs: bytes",
                     "did you mean " + rough_text(*bytes) + "GiB?");
  if (!bytes || !(*bytes >= 1))
    throw UsageError(where, "cannot use \"" + text + "\"",
                     "expected bytes, or a size such as 8GiB or 500MB");
  return *bytes;
}

double particles_of(const std::string& text, const std::string& where) {
  const std::optional<double> count = finite_number(text);
  if (!count || !(*count >= 1))
    throw UsageError(where, "cannot use \"" + text + "\"",
                     "expected a number of particles, such as 2000000 or 2e6");
  return *count;
}

/// No cap where the variable is missing or empty.
double cap_of(const char* name, double (*read)(const std::string&, const std::string&)) {
  const char* text = std::getenv(name);
  return text && *text ? read(text, name) : std::numeric_limits<double>::infinity();
}

void lower(const char* name, double value, double before, const std::string& text) {
  if (value < before) ::setenv(name, text.c_str(), 1);
}

}  // namespace

Caps caps() {
  return {cap_of(memory_name, memory_of), cap_of(particle_name, particles_of)};
}

void set_memory_cap(const std::string& text) {
  lower(memory_name, memory_of(text, "--max-memory"), caps().memory, text);
}

void set_particle_cap(const std::string& text) {
  lower(particle_name, particles_of(text, "--max-particles"), caps().particles, text);
}

std::string cap_flags() {
  std::string flags;
  for (const auto& [name, flag] :
       {std::pair{memory_name, " --max-memory "}, std::pair{particle_name, " --max-particles "}})
    if (const char* text = std::getenv(name); text && *text) flags += flag + shell_word(text);
  return flags;
}

}  // namespace neve::app::setup
