#pragma once
/// From a look to a number: wishes about snow in everyday words, the parameters that grant them and
/// in which direction. docs/looks.md shows each with pictures; docs/looks/make makes them from
/// here.

#include <span>
#include <string>
#include <vector>

namespace neve::app::scene {

/// A parameter that serves a wish.
struct LookChange {
  const char* address;      ///< "material.NAME.hardening", as neve params lists it
  const char *less, *more;  ///< values on both sides of the usual one, as --set takes them
  bool is_more;             ///< the wish asks for more of it
  const char* effect;       ///< a clause: what more of it does
};

struct Look {
  const char* wish;                 ///< "stickier"
  const char* words;                ///< others for it, apart by spaces
  std::vector<LookChange> changes;  ///< the first does most
};

const std::vector<Look>& looks();

/// Words that no address has, for parameters that they mean.
struct EverydayName {
  const char* words;  ///< apart by commas: "time step, step size"
  std::vector<const char*> addresses;
};
const std::vector<EverydayName>& everyday_names();

/// Looks and names in which a text is found: "sticky" finds stickier.
std::vector<const Look*> looks_for(const std::string& text);

std::string looks_table(const std::vector<const Look*>& looks);
/// A Markdown table, with the pictures of docs/looks beside it.
std::string looks_markdown(const std::vector<const Look*>& looks);
/// A list of objects: wish, words, changes.
std::string looks_json(const std::vector<const Look*>& looks);

}  // namespace neve::app::scene
