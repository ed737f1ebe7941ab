/// Answers to unknown words come from one table, and name only what exists.

#include <gtest/gtest.h>

#include <set>

#include "app/advice/suggest.h"
#include "app/run/passes.h"
#include "app/scene/leaf.h"
#include "app/scene/names.h"
#include "app/scene/params.h"

namespace neve::app {
namespace {

using advice::Entry;

TEST(Advice, AWordOfAnotherProgramComesBeforeASimilarOne) {
  const advice::Context keys{"key", {"friction", "hardening", "density"}, true};
  EXPECT_EQ(advice::suggest("rho", keys), "did you mean \"density\"?");
  EXPECT_EQ(advice::suggest("hardning", keys), "did you mean \"hardening\"?");
  EXPECT_EQ(advice::suggest("nonsense", keys, "read on"), "read on");
  EXPECT_EQ(advice::suggest_one_of("p2g", {"stage", {"rasterize", "volumes"}}),
            "did you mean rasterize? expected rasterize, volumes");
  EXPECT_EQ(advice::suggest(".ABC", {"format of an export", {"ply"}}).substr(0, 27),
            "neve does not write Alembic");
}

TEST(Advice, ANameIsOfferedOnlyWhereItIsKnown) {
  EXPECT_EQ(advice::our_name("mu", {"key", {"friction"}}), "friction");
  EXPECT_EQ(advice::our_name("mu", {"key", {"youngs_modulus", "friction"}}), "friction");
  EXPECT_EQ(advice::our_name("mu", {"key", {"youngs_modulus"}}), "youngs_modulus");
  EXPECT_EQ(advice::our_name("mu", {"key", {"density"}}), "");
}

/// Words between the dots of all addresses.
std::set<std::string> parts_of_addresses() {
  std::set<std::string> parts;
  for (const scene::ParamInfo& info : scene::params())
    for (std::size_t begin = 0, end = 0; end != std::string::npos; begin = end + 1) {
      end = info.address.find('.', begin);
      const std::string part = info.address.substr(begin, end - begin);
      parts.insert(part.substr(0, part.find('[')));
    }
  return parts;
}

void expect_names(const char* context, const std::set<std::string>& known) {
  ASSERT_FALSE(advice::entries_of(context).empty()) << context;
  for (const Entry& entry : advice::entries_of(context))
    for (const std::string& name : entry.names)
      EXPECT_TRUE(known.contains(name)) << context << ": " << entry.words.front() << ": " << name;
}

template <class E>
std::set<std::string> choices_of() {
  const std::vector<std::string> list = scene::choices<E>();
  return {list.begin(), list.end()};
}

TEST(Advice, NamesInTheTableExist) {
  expect_names("key", parts_of_addresses());
  expect_names("solver.transfer", choices_of<sim::Transfer>());
  expect_names("material.NAME.model", choices_of<sim::Model>());
  expect_names("material.NAME.flow", {"radial", "isochoric"});
  expect_names("solver.precision", choices_of<sim::Precision>());
  expect_names("stage", {sim::stage_names.begin(), sim::stage_names.end()});
  expect_names("quality", {"draft", "preview", "final"});
  for (const Entry& entry : advice::entries_of("pass"))
    EXPECT_NO_THROW(run::pass_list(entry.names)) << entry.words.front();
  std::set<std::string> attributes = choices_of<scene::ExportAttribute>();
  attributes.insert({"force", "m", "kirchhoff"});  // quantities of neve dump
  expect_names("attribute", attributes);
}

TEST(Advice, AWordIsOnceInItsContext) {
  for (const char* context : {"key", "attribute", "pass", "format of an export", "command", "unit",
                              "size of a picture", "solver.transfer"}) {
    std::set<std::string> words;
    for (const Entry& entry : advice::entries_of(context))
      for (const std::string& word : entry.words)
        EXPECT_TRUE(words.insert(word).second) << context << ": " << word;
  }
}

}  // namespace
}  // namespace neve::app
