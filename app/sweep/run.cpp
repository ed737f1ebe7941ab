#include "app/sweep/run.h"

namespace neve::app::sweep {

std::string Run::setting(const std::string& address) const {
  // A later setting of the same address wins.
  for (auto given = settings.rbegin(); given != settings.rend(); ++given)
    if (given->address == address) return given->value;
  return {};
}

std::string Run::value(const std::string& address) const {
  const std::string own = setting(address);
  for (const scene::Override& other : inherited)
    if (own.empty() && other.address == address) return other.value;
  return own;
}

}  // namespace neve::app::sweep
