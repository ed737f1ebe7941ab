#pragma once
/// Every parameter as a table: for `neve params`, and to resolve addresses.

#include <optional>
#include <string>
#include <vector>

#include "app/scene/toml/value.h"
#include "app/scene/valid.h"

namespace neve::app::scene {

struct ParamInfo {
  std::string address;  ///< "material.NAME.hardening"
  std::string
      type;  ///< boolean, number, integer, string, vector, choice, list of choices, size or range
  std::string unit;
  Valid valid;
  std::vector<std::string> choices;  ///< the values of a choice
  /// Absent if the parameter has no value; the help says what follows. Only an example if required.
  std::optional<toml::Value> default_value;
  bool is_live = false;  ///< may change while a simulation runs
  std::string help;
};

/// Returns all parameters in the order of describe.h. The list is made once.
const std::vector<ParamInfo>& params();

/// The parameter that an address such as "material.snow.hardening" means, with any names in it.
std::optional<ParamInfo> param_at(const std::string& address);

/// Text in aligned columns.
std::string params_table(const std::vector<ParamInfo>& list = params());
/// A list of objects: address, type, unit, min, max, default, live, help; and choices where there
/// are some, required where a scene has to give it, min_open or max_open where the bound itself is
/// not allowed.
std::string params_json(const std::vector<ParamInfo>& list = params());

}  // namespace neve::app::scene
