#include "app/options/option.h"

#include "app/support/text.h"

namespace neve::app::options {

namespace {

constexpr std::size_t column = 30;  // that texts begin in

/// "-q,--quiet", "--size WxH", "SCENE"
std::string heading_of(const Option& option) {
  std::string heading;
  for (const std::size_t length : {2u, 0u})  // letters first
    for (const std::string& name : option.names)
      if ((name.size() == 2 && !option.is_argument()) == (length == 2))
        heading += (heading.empty() ? "" : ",") + name;
  if (!option.alone.empty()) return heading + "[=" + option.type + "]";
  if (!option.type.empty()) heading += " " + option.type;
  return heading + (option.is_repeatable ? " ..." : "");
}

/// The text beside its heading, with its further lines below its first.
std::string row(const std::string& heading, const std::string& text, std::size_t width) {
  std::string line = "  " + heading;
  if (line.size() >= column)
    line += "\n" + std::string(column, ' ');
  else
    line.resize(column, ' ');
  const std::size_t room = width > column + 20 ? width - column : text.size();
  return line + joined(broken_lines(text, room), "\n" + std::string(column, ' ')) + "\n";
}

}  // namespace

std::string sentence_of(const Option& option) {
  const std::string value = option.shows_default ? option.default_text() : "";
  return option.help + (value.empty() ? "" : "; default: " + value) +
         (option.is_required && !option.is_argument() ? " (required)" : "");
}

std::string usage_line(const Command& command, bool has_parts) {
  std::string line = command.full_name() + " [OPTIONS]";
  for (const Option& option : command.options)
    if (option.is_argument())
      line += option.is_required ? " " + option.name() : " [" + option.name() + "]";
  return line + (has_parts ? " [COMMAND]" : "");
}

std::string help_text(const Command& command, const std::vector<const Command*>& parts, int width) {
  const auto room = static_cast<std::size_t>(width);
  std::string text = command.help + "\nUsage: " + usage_line(command, !parts.empty()) + "\n";
  for (const bool wants_arguments : {true, false}) {
    std::string rows;
    for (const Option& option : command.options)
      if (option.is_argument() == wants_arguments)
        rows += row(heading_of(option), sentence_of(option), room);
    if (!rows.empty()) text += (wants_arguments ? "\nArguments:\n" : "\nOptions:\n") + rows;
  }
  if (!parts.empty()) text += "\nCommands:\n";
  for (const Command* part : parts)
    text += row(part->name.substr(part->name.rfind(' ') + 1), part->help, room);
  return text;
}

Json to_json(const Command& command) {
  Json list = Json::array();
  for (const Option& option : command.options) {
    Json json{{"name", option.is_argument() ? option.name() : option.long_name()},
              {"type", option.is_flag ? "flag" : option.type},
              {"help", option.help},
              {"is_argument", option.is_argument()},
              {"is_repeatable", option.is_repeatable},
              {"is_required", option.is_required}};
    for (const std::string& name : option.names)
      if (name.size() == 2 && !option.is_argument()) json["letter"] = name;
    if (!option.alone.empty()) json["alone"] = option.alone;  // a value comes after "=" alone
    if (option.shows_default) json["default"] = option.default_text();
    list.push_back(std::move(json));
  }
  return {{"command", command.full_name()}, {"help", command.help}, {"options", list}};
}

}  // namespace neve::app::options
