#include "app/advice/wishes.h"

#include <fmt/core.h>

#include "app/advice/suggest.h"
#include "app/support/json.h"

namespace neve::app::advice {

namespace {

std::vector<Wish> make_wishes() {
  return {
      {"stickier",
       "sticky stickiness cohesion cohesive clumps clumpy chunky together glue",
       {{"material.NAME.critical_stretch", "0.002", "0.025", true,
         "the paper's snow stretches further before it breaks, so it stays in chunks"},
        {"material.NAME.cohesion", "0.1", "1", true,
         "cam clay bears more tension before it breaks, so it stays in chunks"},
        {"material.NAME.youngs_modulus", "4e4", "6e5", true, "chunks hold their shape"},
        {"collider.NAME.contact", "separate", "sticky", true, "snow stays where it touches"}}},
      {"crumblier",
       "crumbly crumble crumbles brittle break breaks fragile shatter fracture cracks fall apart",
       {{"material.NAME.critical_stretch", "0.001", "0.0075", false,
         "the paper's snow stretches further before it breaks"},
        {"material.NAME.critical_compression", "0.005", "0.025", false,
         "the paper's snow is pressed further before it yields"},
        {"material.NAME.cohesion", "0.1", "0.8", false,
         "cam clay bears more tension before it breaks"},
        {"material.NAME.variation.thresholds", "0", "0.6", true,
         "weak and strong grains lie side by side, and snow breaks into uneven pieces"}}},
      {"heavier",
       "heavy weight weightier mass massive dense density light lighter",
       {{"material.NAME.density", "100", "800", true,
         "snow of the same stiffness is squeezed more by its own weight and impact"}}},
      {"softer",
       "soft softness muddy mushy squishy",
       {{"material.NAME.youngs_modulus", "3e4", "1e6", false, "snow yields less to the same force"},
        {"material.NAME.hardening", "2", "20", false,
         "packed snow of the paper stiffens and stops flowing"},
        {"material.NAME.consolidation_pressure", "1000", "20000", false,
         "Pa that cam clay bears before it packs"}}},
      {"powdery",
       "powder dry fluffy dust dusty spray fine loose",
       {{"material.NAME.preset", "paper", "powder", true,
         "the numbers of fresh dry snow: light, soft, with small thresholds"},
        {"material.NAME.critical_compression", "0.008", "0.025", false,
         "the paper's snow is pressed further before it yields"},
        {"material.NAME.critical_stretch", "0.001", "0.0075", false,
         "the paper's snow stretches further before it breaks"},
        {"material.NAME.consolidation_pressure", "500", "8000", false,
         "Pa that cam clay bears before it packs"}}},
      {"wet",
       "wetter wetness slush slushy damp moist melting packable",
       {{"material.NAME.preset", "paper", "wet", true,
         "the numbers of wet snow: heavy, with large thresholds and little hardening"},
        {"material.NAME.critical_compression", "0.01", "0.06", true,
         "the paper's snow is pressed further before it yields, like putty"},
        {"material.NAME.hardening", "3", "15", false,
         "packed snow of the paper stiffens and stops flowing"},
        {"material.NAME.cohesion", "0.2", "0.8", true,
         "cam clay bears more tension before it breaks"}}},
      {"icy",
       "ice icier frozen frost crust crusty glassy rigid hardness hard harder stiff stiffness "
       "stiffer firm",
       {{"material.NAME.preset", "paper", "icy", true,
         "the numbers of old snow: stiff, quick to harden, quick to break"},
        {"material.NAME.hardening", "5", "25", true, "packed snow of the paper turns hard at once"},
        {"material.NAME.consolidation_pressure", "4500", "30000", true,
         "Pa that cam clay bears before it packs"},
        {"material.NAME.youngs_modulus", "1.4e5", "1.4e6", true,
         "snow yields less; steps shorten"}}},
      {"slower",
       "slow slowly speed larger big bigger huge scale giant motion sluggish calm",
       {{"solver.gravity", "[0, -3, 0]", "[0, -9.81, 0]", false,
         "snow falls faster; with a third of gravity it seems three times as large"},
        {"body.NAME.velocity", "[0, -2, 0]", "[0, -8, 0]", false, "the body hits harder"},
        {"solver.flip_ratio", "0.5", "0.99", false, "grains keep more of their own motion"}}},
  };
}

/// "less of", "more of": what a wish asks of a parameter.
const char* direction(const WishChange& change) {
  return change.is_more ? "larger" : "smaller";
}

bool has_no_number(const WishChange& change) {
  return std::string_view(change.less).find_first_of("0123456789") == std::string_view::npos;
}

std::string advice(const WishChange& change) {
  return has_no_number(change) ? std::string(change.more) : std::string(direction(change));
}

/// The end of the scale that the wish asks for.
const char* wished(const WishChange& change) {
  return change.is_more ? change.more : change.less;
}

}  // namespace

const std::vector<Wish>& wishes() {
  static const std::vector<Wish> all = make_wishes();
  return all;
}

std::vector<const Wish*> wishes_for(const std::string& text) {
  const std::vector<std::string> wanted = words_in(text);
  std::vector<const Wish*> found;
  for (const Wish& wish : wishes()) {
    const std::vector<std::string> words = words_in(std::string(wish.name) + " " + wish.words);
    if (!wanted.empty() && has_all(words, wanted)) found.push_back(&wish);
  }
  return found;
}

std::string wishes_table(const std::vector<const Wish*>& wishes) {
  constexpr const char* row = "{:12}{:38}{:9}{:14}{}\n";
  std::string text =
      fmt::format(row, "I WANT IT", "PARAMETER", "MAKE IT", "AS IN", "MORE OF IT MEANS");
  for (const Wish* wish : wishes)
    for (const WishChange& change : wish->changes)
      text += fmt::format(row, &change == &wish->changes.front() ? wish->name : "", change.address,
                          advice(change), wished(change), change.effect);
  text +=
      "\nThe law of a material is its model: that of cam clay in scenes of neve new, otherwise the "
      "paper's snow.\n"
      "neve card --preset wet draws what a kind of snow bears and does, and has it as numbers.\n";
  return text;
}

std::string wishes_markdown(const std::vector<const Wish*>& wishes) {
  std::string text =
      "| I want it | parameter | make it | less | more | more of it means |\n"
      "| --- | --- | --- | --- | --- | --- |\n";
  for (const Wish* wish : wishes)
    for (const WishChange& change : wish->changes) {
      const bool is_first = &change == &wish->changes.front();
      const auto picture = [&](const char* side, const char* value) {
        const std::string shown = fmt::format("`{}`", value);
        return is_first ? fmt::format("{}<br>![{}, {}](wishes/{}_{}.png)", shown, wish->name, side,
                                      wish->name, side)
                        : shown;
      };
      text += fmt::format("| {} | `{}` | {} | {} | {} | {} |\n",
                          is_first ? fmt::format("**{}**", wish->name) : "", change.address,
                          advice(change), picture("less", change.less),
                          picture("more", change.more), change.effect);
    }
  return text;
}

std::string wishes_json(const std::vector<const Wish*>& wishes) {
  Json list = Json::array();
  for (const Wish* wish : wishes) {
    Json item{{"wish", wish->name}, {"words", words_in(wish->words)}, {"changes", Json::array()}};
    for (const WishChange& change : wish->changes)
      item["changes"].push_back({{"address", change.address},
                                 {"direction", advice(change)},
                                 {"less", change.less},
                                 {"more", change.more},
                                 {"is_more", change.is_more},
                                 {"effect", change.effect}});
    list.push_back(std::move(item));
  }
  return to_text(list) + "\n";
}

}  // namespace neve::app::advice
