#include "app/support/room.h"

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "app/support/errors.h"
#include "app/support/machine.h"
#include "app/support/text.h"

namespace neve::app {

double memory_room() {
  const char* text = std::getenv(memory_cap_name);
  const std::optional<double> bytes = text ? bytes_of(text) : std::nullopt;
  const std::optional<double> number = text ? finite_number(text) : std::nullopt;
  const double cap = bytes ? *bytes : number ? *number : std::numeric_limits<double>::infinity();
  return std::min(cap, static_cast<double>(usable_memory()));
}

void require_room(double bytes, const std::string& what, const std::string& place,
                  const std::string& advice) {
  const double room = memory_room();
  if (bytes <= room) return;
  const std::string needed = bytes_text(static_cast<std::uint64_t>(std::min(bytes, 1e18)));
  const std::string hint = advice.empty() ? "allow more with --max-memory or NEVE_MAX_MEMORY, if "
                                            "this machine has it"
                                          : advice;
  throw LimitError(
      error_sentence(place,
                     "refused: " + what + " needs about " + needed + " of memory, and " +
                         bytes_text(static_cast<std::uint64_t>(room)) + " may be used",
                     hint),
      place, hint);
}

}  // namespace neve::app
