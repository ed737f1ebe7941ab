#pragma once
/// `--set ADDRESS=VALUE`: changes to a scene before it is checked.

#include <string>
#include <string_view>
#include <vector>

#include "app/scene/toml/value.h"

namespace neve::app::scene {

struct Override {
  std::string address;         ///< "material.snow.hardening", "body.1.velocity"
  std::string value;           ///< in TOML; a bare word is a string; "none" takes away what may be
                               ///< absent: an optional parameter, or a table
  std::string flag = "--set";  ///< that gave it on the command line
  std::string file = {};       ///< or the sweep file that did
  toml::Location key = {};     ///< of the address in that file
  toml::Location place = {};   ///< of the value in that file

  /// Throws a SceneError located in the file, or a UsageError that shows the flag.
  [[noreturn]] void fail(toml::Location where, const std::string& message,
                         const std::string& hint = {}) const;
};

/// Splits at the first '='.
/// @throws UsageError
Override parse_override(std::string_view argument);
std::vector<Override> parse_overrides(const std::vector<std::string>& arguments);

/// Returns the addresses that they set: of a table, its own and those of the values in it.
/// @throws UsageError, SceneError where a table is no TOML
std::vector<std::string> addresses_of(const std::vector<Override>& changes);
/// True if one of them has this address.
bool sets(const std::vector<Override>& changes, std::string_view address);
/// "ADDRESS=VALUE" of each, as parse_overrides() reads them.
std::vector<std::string> texts_of(const std::vector<Override>& changes);

/// Puts the value into the document, creating tables on the way. Later ones win. A preset takes the
/// place of the numbers that the document has beside it, so presets come first.
/// @param index  of this override, kept as the location of the values it sets
/// @throws UsageError when nothing has this address (with the nearest that has) or the value is
///         no TOML
void apply_override(toml::Table& root, const Override& change, int index);

/// True for the address of a whole object, "body.ball": a table adds it to its list, in the place
/// of one with this name; "none" removes it.
bool is_object_address(const std::string& address);
/// The object that an address is of or in, "body.ball" for "body.ball.velocity"; "" for others.
std::string object_of(const std::string& address);

/// The value of a change, for a parameter of this type: see ParamInfo, or "table".
/// @throws UsageError, SceneError
toml::Value value_of(const Override& change, const std::string& type);

/// True if the change removes an optional setting.
bool takes_away(const Override& change);
/// True for "none" at the address of a whole object, curve, view, mosaic or export.
bool takes_item_away(const Override& change);

/// "material", "snow", "hardening" for "material.snow.hardening".
std::vector<std::string> words_of(const std::string& address);

/// Value of a document at an address; null if it has none.
const toml::Value* value_at(const toml::Table& root, const std::string& address);

/// Names of the entries of a list or table of tables; numbers from 1 for entries without a valid
/// name.
std::vector<std::string> item_names(const toml::Value& items);
/// The place among them of a name; their number for one that is not there.
std::size_t item_place(const toml::Value& items, const std::string& name);

}  // namespace neve::app::scene
