#include "app/setup/command_text.h"

#include "app/scene/toml/value.h"

namespace neve::app::setup {

namespace {

std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace

std::string shell_word(const std::string& text) {
  const std::string plain =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-./,=+:@%";
  const bool is_plain = !text.empty() && text.find_first_not_of(plain) == std::string::npos;
  return is_plain ? text : quoted(text);
}

std::vector<std::string> arguments(const RenderCommand& command) {
  // A name that starts like a flag would be taken for one.
  const std::string scene =
      command.scene_file.starts_with('-') ? "./" + command.scene_file : command.scene_file;
  std::vector<std::string> words{"neve", "render", scene};
  const auto add = [&](const char* flag, const std::string& value) {
    words.insert(words.end(), {flag, value});
  };
  for (const scene::Override& change : command.overrides)
    add("--set", change.address + "=" + change.value);
  if (command.coarsening > 1) add("--coarsen", scene::toml::number_text(command.coarsening));
  if (command.frames)
    add("--frames",
        std::to_string(command.frames->first) + "-" + std::to_string(command.frames->last));
  for (const std::string& view : command.views) add("--view", view);
  if (command.size)
    add("--size", std::to_string(command.size->width) + "x" + std::to_string(command.size->height));
  if (command.quality) add("--quality", name(*command.quality));
  if (!command.out.empty()) add("--out", command.out);
  return words;
}

std::string command_line(const RenderCommand& command) {
  std::string line;
  bool is_setting = false;
  for (const std::string& word : arguments(command)) {
    line += (line.empty() ? "" : " ") + (is_setting ? quoted(word) : shell_word(word));
    is_setting = word == "--set";
  }
  return line;
}

}  // namespace neve::app::setup
