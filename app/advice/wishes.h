#pragma once
/// "I want it stickier": wishes about snow in everyday words, the parameters that grant them and
/// in which direction. docs/wishes.md shows each with pictures; docs/wishes/make makes them from
/// here.

#include <span>
#include <string>
#include <vector>

namespace neve::app::advice {

/// A parameter that serves a wish.
struct WishChange {
  const char* address;      ///< "material.NAME.hardening", as neve params lists it
  const char *less, *more;  ///< values on both sides of the usual one, as --set takes them
  bool is_more;             ///< the wish asks for more of it
  const char* effect;       ///< a clause: what more of it does
};

struct Wish {
  const char* name;                 ///< "stickier"
  const char* words;                ///< others for it, apart by spaces
  std::vector<WishChange> changes;  ///< the first does most
};

const std::vector<Wish>& wishes();

/// Wishes in which a text is found: "sticky" finds stickier.
std::vector<const Wish*> wishes_for(const std::string& text);

std::string wishes_table(const std::vector<const Wish*>& wishes);
/// A Markdown table, with the pictures of docs/wishes beside it.
std::string wishes_markdown(const std::vector<const Wish*>& wishes);
/// A list of objects: wish, words, changes.
std::string wishes_json(const std::vector<const Wish*>& wishes);

}  // namespace neve::app::advice
