#include "app/card/card.h"

#include <iterator>
#include <utility>

#include "app/card/falls.h"
#include "app/card/plates.h"
#include "app/scene/flat.h"
#include "app/scene/schema_leaf.h"
#include "sim/base/thread_pool.h"

namespace neve::app::card {

namespace {

/// The longest first, so that the last one to end is a short one.
constexpr std::pair<Kind, Experiment (*)(const Subject&)> by_length[] = {
    {Kind::column, column}, {Kind::drop, drop},   {Kind::tilt, tilt},
    {Kind::shear, shear},   {Kind::press, press}, {Kind::tear, tear}};

Json to_json(const sim::Material& material) {
  scene::Scene scene;
  scene.materials = {material};
  const std::string table = "material." + material.name + ".";
  Json json;
  for (const scene::FlatParam& param : scene::flatten(scene))
    if (param.address.starts_with(table) && param.value)
      json[param.address.substr(table.size())] = scene::to_json(*param.value);
  return json;
}

Json to_json(const Experiment& e) {
  const KindInfo& info = info_of(e.kind);
  Json json;
  for (const Measure& measure : e.measures) json[measure.name] = number_or_null(measure.value);
  json["formula"] = Json::object();
  for (const Measure& measure : e.measures)
    if (measure.formula) json["formula"][measure.name] = number_or_null(*measure.formula);
  json["words"] = e.words;
  json["failure"] = e.failure.empty() ? Json() : Json(e.failure);
  json["curve"] = {{info.x_name, e.x}, {info.y_name, e.y}};
  return json;
}

}  // namespace

std::vector<Card> make_cards(const std::vector<Subject>& subjects, int threads,
                             const std::function<void()>& done) {
  std::vector<Card> cards;
  for (const Subject& subject : subjects)
    cards.push_back({subject, std::vector<Experiment>(std::size(kinds))});
  ThreadPool pool(threads);
  const int parts = static_cast<int>(subjects.size() * std::size(by_length));
  pool.run(pool.thread_count(), parts, [&](int part) {
    const auto at = static_cast<std::size_t>(part);
    Card& card = cards[at % cards.size()];
    const auto& [kind, make] = by_length[at / cards.size()];
    card.experiments[static_cast<std::size_t>(kind)] = make(card.subject);
    if (done) done();
  });
  return cards;
}

Json to_json(const Card& card) {
  Json json;
  json["title"] = card.subject.title;
  json["material"] = to_json(card.subject.material);
  json["transfer"] = scene::name(card.subject.solver.transfer);
  for (const Experiment& e : card.experiments) json[info_of(e.kind).name] = to_json(e);
  return json;
}

}  // namespace neve::app::card
