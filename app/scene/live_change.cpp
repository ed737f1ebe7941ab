#include "app/scene/live_change.h"

#include <stdexcept>
#include <utility>

#include "app/scene/flat.h"

namespace neve::app::scene {

Json to_json(const std::vector<LiveChange>& changes) {
  Json list = Json::array();
  for (const LiveChange& change : changes)
    list.push_back({{"step", change.step}, {"address", change.address}, {"value", change.value}});
  return list;
}

std::vector<LiveChange> live_changes(const Json& json) {
  std::vector<LiveChange> changes;
  if (!json.is_array()) throw std::runtime_error("the changes are not a list");
  for (const Json& item : json) {
    const bool is_change = item.is_object() && item.contains("step") && item.contains("address") &&
                           item.contains("value") && item["step"].is_number_unsigned() &&
                           item["address"].is_string() && item["value"].is_string();
    if (!is_change)
      throw std::runtime_error("a change does not consist of step, address and value");
    changes.push_back({whole_number<std::size_t>(item["step"]), item["address"].get<std::string>(),
                       item["value"].get<std::string>()});
    const LiveChange& change = changes.back();
    if (!is_live(change.address))
      throw std::runtime_error("no live parameter is called \"" + change.address + "\"");
    if (changes.size() > 1 && change.step < changes[changes.size() - 2].step)
      throw std::runtime_error("the steps of the changes decrease");
  }
  return changes;
}

std::string text_of(const LiveChange& change) {
  return "step " + std::to_string(change.step) + ": " + change.address + " = " + change.value;
}

void note_change(std::vector<LiveChange>& changes, LiveChange change) {
  const auto is_same = [&](const LiveChange& other) {
    return other.step == change.step && other.address == change.address;
  };
  const std::size_t count = changes.size();
  if (count >= 2 && is_same(changes[count - 1]) && is_same(changes[count - 2])) changes.pop_back();
  changes.push_back(std::move(change));
}

void forget_changes_after(std::vector<LiveChange>& changes, std::size_t step) {
  std::erase_if(changes, [&](const LiveChange& change) { return change.step > step; });
}

}  // namespace neve::app::scene
