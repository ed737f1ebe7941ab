#pragma once
/// A scene as a list of addresses with values: for panels, and for the differences of two scenes.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/scene/params.h"
#include "app/scene/scene.h"

namespace neve::app::scene {

/// A parameter of one scene. Besides those of params() with names filled in there is an entry of
/// type "table" for a thing that exists or has a kind as a whole, before its members: shapes, and
/// cameras and clip planes that a scene may have or not. Keyframes are one entry, of type "tables".
struct FlatParam {
  std::string address;  ///< "material.snow.hardening", as --set takes it
  std::string type;     ///< see ParamInfo, or table, tables
  const char* unit = "";
  Valid valid;
  std::vector<std::string> choices;  ///< the values of a choice
  bool is_live = false;              ///< may change while a simulation runs
  const char* help = "";             ///< one sentence
  std::optional<toml::Value> value;  ///< absent: no value; the help says what follows
  std::optional<toml::Value>
      default_value;  ///< of a new item; absent like value, or if there is none

  /// The value as --set takes it; "none" where it is absent.
  std::string text() const;
  bool is_default() const;
};

/// Lists the parameters in the order of describe.h, and lists one item after the other.
std::vector<FlatParam> flatten(const Scene& scene);

/// True if the parameter, or the whole table, at this address may change during a run. False for
/// unknown addresses. Whole colliders may come and go.
bool is_live(std::string_view address);

/// Part of the program that depends on a parameter.
enum class Concern {
  simulation,  ///< every number of it
  run,         ///< its length, and whether it may: no number
  pictures     ///< drawing only
};
Concern concern_of(std::string_view address);

inline bool concerns_simulation(std::string_view address) {
  return concern_of(address) == Concern::simulation;
}

/// Values at an address in two scenes; absent if a scene has none.
struct Difference {
  std::string address;  ///< of a parameter; of a table that only one has or that is of another kind
  std::optional<toml::Value> before, after;
  bool is_live = false;
};

/// Everything in which two scenes differ, in the order of describe.h: setting each address of
/// `after` (without a value: to "none") makes the first scene the second one, except for items that
/// only one of them has.
std::vector<Difference> differences(const Scene& before, const Scene& after);

struct SplitDifferences {
  std::vector<Difference> live, restart;
};
/// The same, split into live differences and those that need a restart.
SplitDifferences split_live(const Scene& before, const Scene& after);

/// True for the same type and content; -0 is not 0.
bool same_value(const std::optional<toml::Value>& a, const std::optional<toml::Value>& b);

/// True if ratios of such a parameter matter: its bounds are many times apart, or it is allowed
/// over many times less and more than it usually is. Sliders are logarithmic then, and values
/// around one have equal ratios.
bool spans_decades(const Valid& valid, const std::optional<double>& usual);

}  // namespace neve::app::scene
