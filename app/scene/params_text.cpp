#include <algorithm>
#include <cmath>

#include "app/scene/params.h"
#include "app/scene/schema_leaf.h"
#include "app/support/json.h"
#include "app/support/text.h"

namespace neve::app::scene {
namespace {

bool is_bounded(const Valid& valid) {
  return std::isfinite(valid.min) || std::isfinite(valid.max);
}

std::string default_text(const ParamInfo& info) {
  if (info.valid.is_required) return "required";
  return info.default_value ? toml::toml_literal(*info.default_value) : "-";
}

std::string range_text(const ParamInfo& info) {
  if (!info.choices.empty()) return joined(info.choices, " ");
  return is_bounded(info.valid) ? info.valid.text_of_bounds() : "-";
}

}  // namespace

std::string params_table(const std::vector<ParamInfo>& list) {
  struct Row {
    std::string address, type, value, unit, range, change, help;
  };
  std::vector<Row> rows{{"ADDRESS", "TYPE", "DEFAULT", "UNIT", "RANGE", "CHANGE", "MEANING"}};
  for (const ParamInfo& info : list) {
    rows.push_back({info.address, info.type, default_text(info),
                    info.unit.empty() ? "-" : info.unit, range_text(info),
                    info.is_live ? "live" : "restart", info.help});
  }
  const auto width = [&](std::string Row::*column, std::size_t limit) {
    std::size_t widest = 0;
    for (const Row& row : rows) {
      if ((row.*column).size() <= limit) widest = std::max(widest, (row.*column).size());
    }
    return widest;
  };
  // A few long cells push their own row aside instead of widening every row.
  const std::size_t widths[] = {width(&Row::address, 60), width(&Row::type, 20),
                                width(&Row::value, 20),   width(&Row::unit, 20),
                                width(&Row::range, 40),   width(&Row::change, 20)};
  std::string text;
  for (const Row& row : rows) {
    std::size_t k = 0;
    for (const std::string* cell :
         {&row.address, &row.type, &row.value, &row.unit, &row.range, &row.change}) {
      text += *cell + std::string(std::max(widths[k], cell->size()) - cell->size() + 2, ' ');
      ++k;
    }
    text += row.help + "\n";
  }
  return text;
}

std::string params_json(const std::vector<ParamInfo>& params) {
  Json list = Json::array();
  for (const ParamInfo& info : params) {
    Json item;
    item["address"] = info.address;
    item["type"] = info.type;
    item["unit"] = info.unit;
    item["min"] = count_json(info.valid.min);
    item["max"] = count_json(info.valid.max);
    const bool has_default = info.default_value && !info.valid.is_required;
    item["default"] = has_default ? to_json(*info.default_value) : Json();
    item["live"] = info.is_live;
    item["help"] = info.help;
    if (!info.choices.empty()) item["choices"] = info.choices;
    if (info.valid.is_required) item["required"] = true;
    if (info.valid.is_min_open) item["min_open"] = true;
    if (info.valid.min_above_0 > 0) item["min_above_0"] = info.valid.min_above_0;
    if (info.valid.is_max_open) item["max_open"] = true;
    list.push_back(std::move(item));
  }
  return to_text(list) + "\n";
}

}  // namespace neve::app::scene
