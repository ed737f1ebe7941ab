#pragma once
/// Parameter edits requested by panels.

#include <cstdint>
#include <string>

namespace neve::app::view::session {

struct Edit {
  enum class Kind { set, as_in_file, to_default, sweep, copy_address, refused };

  Kind kind = Kind::set;
  std::string address;
  /// TOML: the new value for set, the present one for sweep. For refused, the reason.
  std::string value;
  std::uint64_t gesture = 0;  ///< the same while one widget is held, another when it is held again
};

}  // namespace neve::app::view::session
