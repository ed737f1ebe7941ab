#include "app/cli/manual.h"

#include <algorithm>
#include <vector>

#include "app/output/atomic_file.h"
#include "app/support/version.h"

namespace neve::app::cli {

namespace {

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* command) { return !command->get_name().empty(); });
}

/// "--frames" of an option, also of one that has a short name; "" of positional ones.
std::string long_flag(const CLI::Option& option) {
  const std::vector<std::string>& names = option.get_lnames();
  return names.empty() ? "" : "--" + names.front();
}

bool takes_value(const CLI::Option& option) {
  return option.get_items_expected_max() > 0;
}

/// Text as troff reads it: a dash that is a minus, no control lines.
std::string troff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else {
      const bool is_control = (c == '.' || c == '\'') && (out.empty() || out.back() == '\n');
      if (is_control) out += "\\&";
      out += c;
    }
  }
  return out;
}

/// A word between single quotes of a shell.
std::string quoted_word(const std::string& text, const std::string& quote) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'')
      out += quote;
    else
      out += c;
  }
  return out + "'";
}

std::string option_entry(const CLI::Option& option) {
  std::string names;
  for (const std::string& name : option.get_snames()) names += "\\fB\\-" + name + "\\fR, ";
  for (const std::string& name : option.get_lnames())
    names += "\\fB" + troff("--" + name) + "\\fR, ";
  if (names.empty()) names = "\\fI" + troff(option.get_name(true, false)) + "\\fR, ";
  names.resize(names.size() - 2);
  if (takes_value(option) && !option.get_type_name().empty())
    names += " \\fI" + troff(option.get_type_name()) + "\\fR";
  std::string text = option.get_description();
  if (!option.get_default_str().empty()) text += "; default: " + option.get_default_str();
  return ".TP\n" + names + "\n" + troff(text) + "\n";
}

std::string page_name(std::string name) {
  std::replace(name.begin(), name.end(), ' ', '-');
  return name;
}

std::string joined_commands(const CLI::App& app) {
  std::string words;
  for (const CLI::App* command : commands_of(app))
    words += (words.empty() ? "" : " ") + command->get_name();
  return words;
}

std::string joined_flags(const CLI::App& command) {
  std::string words;
  for (const CLI::Option* option : command.get_options())
    if (const std::string flag = long_flag(*option); !flag.empty())
      words += (words.empty() ? "" : " ") + flag;
  return words;
}

void write_pages(const CLI::App& command, const std::string& name, const std::string& footer,
                 const std::filesystem::path& folder) {
  output::write_file(folder / (page_name(name) + ".1"), man_page(command, name, footer));
  for (const CLI::App* part : commands_of(command))
    write_pages(*part, name + " " + part->get_name(), footer, folder);
}

}  // namespace

std::string man_page(const CLI::App& command, const std::string& name, const std::string& footer) {
  std::string title = page_name(name);
  std::transform(title.begin(), title.end(), title.begin(),
                 [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c; });
  std::string text = ".TH " + title + " 1 \"\" \"neve " + version + "\" \"neve\"\n.SH NAME\n" +
                     troff(page_name(name)) + " \\- " + troff(command.get_description()) +
                     "\n.SH SYNOPSIS\n.B " + troff(name) + "\n[\\fIOPTIONS\\fR]";
  for (const CLI::Option* option : command.get_options())
    if (option->get_positional())
      text += " " + std::string(option->get_required() ? "" : "[") + "\\fI" +
              troff(option->get_name(true, false)) + "\\fR" + (option->get_required() ? "" : "]");
  const std::vector<const CLI::App*> parts = commands_of(command);
  text += parts.empty() ? "\n" : " [\\fICOMMAND\\fR ...]\n";
  text += ".SH OPTIONS\n";
  for (const CLI::Option* option : command.get_options()) text += option_entry(*option);
  if (!parts.empty()) text += ".SH COMMANDS\n";
  for (const CLI::App* part : parts)
    text +=
        ".TP\n\\fB" + troff(part->get_name()) + "\\fR\n" + troff(part->get_description()) + "\n";
  text += ".SH EXIT STATUS\n" + troff(footer) + "\n.SH SEE ALSO\n";
  return text + (name == "neve" ? "The pages in share/doc/neve\n" : ".BR neve (1)\n");
}

std::string bash_completion(const CLI::App& app) {
  std::string text =
      "# Completion of neve for bash.\n_neve() {\n"
      "  local word=${COMP_WORDS[COMP_CWORD]} flags=\n  COMPREPLY=()\n"
      "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n    COMPREPLY=($(compgen -W \"" +
      joined_commands(app) + "\" -- \"$word\"))\n    return\n  fi\n  case ${COMP_WORDS[1]} in\n";
  for (const CLI::App* command : commands_of(app)) {
    std::string words = joined_flags(*command);
    for (const CLI::App* part : commands_of(*command))
      words += " " + part->get_name() + " " + joined_flags(*part);
    text += "    " + command->get_name() + ") flags=\"" + words + "\" ;;\n";
  }
  return text +
         "  esac\n  COMPREPLY=($(compgen -W \"$flags\" -- \"$word\"))\n"
         "  case $word in -*) ;; *) COMPREPLY+=($(compgen -f -- \"$word\")) ;; esac\n}\n"
         "complete -o filenames -F _neve neve\n";
}

std::string zsh_completion(const CLI::App& app) {
  const auto plain = [](std::string text) {
    std::replace(text.begin(), text.end(), ':', ' ');
    std::replace(text.begin(), text.end(), '[', '(');
    std::replace(text.begin(), text.end(), ']', ')');
    return quoted_word(text, "'\\''");
  };
  std::string text =
      "#compdef neve\n# Completion of neve for zsh.\nlocal -a commands\ncommands=(\n";
  for (const CLI::App* command : commands_of(app)) {
    const std::string about = plain(command->get_description());
    text += "  '" + command->get_name() + ":" + about.substr(1) + "\n";
  }
  text +=
      ")\nif (( CURRENT == 2 )); then\n  _describe command commands\n  return\nfi\n"
      "case $words[2] in\n";
  for (const CLI::App* command : commands_of(app)) {
    text += "  " + command->get_name() + ")\n    _arguments '*:file:_files'";
    for (const CLI::Option* option : command->get_options()) {
      if (long_flag(*option).empty()) continue;
      const std::string about = plain(option->get_description());
      text += " \\\n      '" + long_flag(*option) + "[" + about.substr(1, about.size() - 2) + "]" +
              (takes_value(*option) ? ":value:_files'" : "'");
    }
    text += "\n    ;;\n";
  }
  return text + "esac\n";
}

std::string fish_completion(const CLI::App& app) {
  const auto quoted = [](const std::string& text) { return quoted_word(text, "\\'"); };
  std::string text = "# Completion of neve for fish.\n";
  for (const CLI::App* command : commands_of(app)) {
    const std::string& name = command->get_name();
    text += "complete -c neve -n __fish_use_subcommand -a " + name + " -d " +
            quoted(command->get_description()) + "\n";
    for (const CLI::Option* option : command->get_options())
      if (!long_flag(*option).empty())
        text += "complete -c neve -n '__fish_seen_subcommand_from " + name + "' -l " +
                long_flag(*option).substr(2) + (takes_value(*option) ? " -r" : "") + " -d " +
                quoted(option->get_description()) + "\n";
  }
  return text;
}

namespace {

void make_part(const std::filesystem::path& folder) {
  try {
    output::make_folder(folder);
  } catch (const IoError& error) {
    throw IoError(error.what(), error.where, "choose another folder, as in neve manual DIR");
  }
}

}  // namespace

void write_manual(const CLI::App& app, const std::filesystem::path& folder) {
  for (const char* part : {"man1", "bash", "zsh", "fish"}) make_part(folder / part);
  write_pages(app, "neve", app.get_footer(), folder / "man1");
  output::write_file(folder / "bash" / "neve", bash_completion(app));
  output::write_file(folder / "zsh" / "_neve", zsh_completion(app));
  output::write_file(folder / "fish" / "neve.fish", fish_completion(app));
}

}  // namespace neve::app::cli
