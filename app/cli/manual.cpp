#include "app/cli/command_line.h"

#include <algorithm>

#include "app/output/atomic_file.h"
#include "app/output/temporary.h"
#include "app/support/text.h"
#include "app/support/version.h"

namespace neve::app::cli {

namespace {

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

std::string option_entry(const options::Option& option) {
  std::string text;
  for (const std::string& name : option.names)
    text += (text.empty() ? "" : ", ") +
            ((option.is_argument() ? "\\fI" : "\\fB") + troff(name) + "\\fR");
  if (!option.alone.empty())
    text += "[=\\fI" + troff(option.type) + "\\fR]";
  else if (!option.type.empty())
    text += " \\fI" + troff(option.type) + "\\fR";
  return ".TP\n" + text + "\n" + troff(options::sentence_of(option)) + "\n";
}

std::string page_name(const options::Command& command) {
  std::string name = command.full_name();
  std::replace(name.begin(), name.end(), ' ', '-');
  return name;
}

std::string title_of(const std::string& name) {
  std::string title = name;
  for (char& c : title)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return title;
}

/// The page of a command in troff.
std::string man_page(const Entry& entry) {
  const std::string name = page_name(entry.command), full = entry.command.full_name();
  const std::string usage = options::usage_line(entry.command, !entry.parts.empty());
  std::string text = ".TH " + title_of(name) + " 1 \"\" \"neve " + version +
                     "\" \"neve\"\n.SH NAME\n" + troff(name) + " \\- " + troff(entry.command.help) +
                     "\n.SH SYNOPSIS\n.B " + troff(full) + "\n" +
                     troff(usage.substr(full.size() + 1)) + "\n.SH OPTIONS\n";
  for (const options::Option& option : entry.command.options) text += option_entry(option);
  if (!entry.parts.empty()) text += ".SH COMMANDS\n";
  for (const Entry& part : entry.parts)
    text += ".TP\n\\fB" + troff(part.name()) + "\\fR\n" + troff(part.command.help) + "\n";
  text += ".SH EXIT STATUS\n" + troff(exit_codes) + "\n.SH SEE ALSO\n";
  return text + (name == "neve" ? "The pages in share/doc/neve\n" : ".BR neve (1)\n");
}

void write_pages(const Entry& entry, const std::filesystem::path& folder) {
  output::write_file(folder / (page_name(entry.command) + ".1"), man_page(entry));
  for (const Entry& part : entry.parts) write_pages(part, folder);
}

/// A line of bash for the flags of a command, and those of them that a value follows.
std::string bash_flags(const options::Command& command, const std::string& parts) {
  std::string with_value;
  for (const options::Option& option : command.options)
    if (!option.is_argument() && option.needs_value())
      with_value += " " + joined(option.names, " ");
  return "flags=\"" + joined(command.flags(), " ") + parts + "\" with_value=\"" + with_value +
         " \" ;;\n";
}

/// Commands and flags for a shell; files complete everything else.
std::string bash_completion(const Entry& program) {
  std::string text =
      "# Completion of neve for bash.\n_neve() {\n"
      "  local word=${COMP_WORDS[COMP_CWORD]} part= flags= with_value=\n  COMPREPLY=()\n"
      "  local commands=\"" +
      joined(program.part_names(), " ") +
      "\"\n  if [ \"$COMP_CWORD\" -eq 1 ]; then\n    COMPREPLY=($(compgen -W \"$commands " +
      joined(program.command.flags(), " ") +
      "\" -- \"$word\"))\n    return\n  fi\n"
      "  [ \"$COMP_CWORD\" -eq 2 ] || part=${COMP_WORDS[2]}\n  case ${COMP_WORDS[1]} in\n    help) "
      "COMPREPLY=($(compgen -W \"$commands\" -- \"$word\")); return ;;\n";
  for (const Entry& entry : program.parts) {
    std::string parts;
    for (const std::string& name : entry.part_names()) parts += " " + name;
    if (parts.empty()) {
      text += "    " + entry.name() + ") " + bash_flags(entry.command, "");
      continue;
    }
    text += "    " + entry.name() + ") case $part in\n";
    for (const Entry& part : entry.parts)
      text += "      " + part.name() + ") " + bash_flags(part.command, "");
    text += "      *) " + bash_flags(entry.command, parts) + "    esac ;;\n";
  }
  return text +
         "  esac\n  [[ $with_value == *\" ${COMP_WORDS[COMP_CWORD-1]} \"* ]] && flags=\n"
         "  COMPREPLY=($(compgen -W \"$flags\" -- \"$word\"))\n"
         "  local IFS=$'\\n'  # names of files may have blanks\n"
         "  case $word in\n    -*) ;;\n    # a part may have the name of a folder\n"
         "    *) [ ${#COMPREPLY[@]} -gt 0 ] || compopt -o filenames 2>/dev/null; "
         "COMPREPLY+=($(compgen -f -- \"$word\")) ;;\n  esac\n}\n"
         "complete -F _neve neve\n";
}

std::string zsh_completion(const Entry& program) {
  // Quotes a text for zsh, without the quotes around it.
  const auto plain = [](std::string text) {
    std::replace(text.begin(), text.end(), ':', ' ');
    std::replace(text.begin(), text.end(), '[', '(');
    std::replace(text.begin(), text.end(), ']', ')');
    text = quoted_word(text, "'\\''");
    return text.substr(1, text.size() - 2);
  };
  std::string text =
      "#compdef neve\n# Completion of neve for zsh.\nlocal -a commands\ncommands=(\n";
  for (const Entry& entry : program.parts)
    text += "  '" + entry.name() + ":" + plain(entry.command.help) + "'\n";
  text +=
      ")\nif (( CURRENT == 2 )); then\n  _describe command commands\n  return\nfi\n"
      "case $words[2] in\n";
  for (const Entry& entry : program.parts) {
    text += "  " + entry.name() + ")\n    _arguments '*:file:_files'";
    for (const options::Option& option : entry.command.options)
      if (!option.is_argument())
        text += std::string(" \\\n      '") + (option.is_repeatable ? "*" : "") +
                option.long_name() + "[" + plain(option.help) + "]" +
                (option.needs_value() ? ":value:_files'" : "'");
    text += "\n    ;;\n";
  }
  return text + "esac\n";
}

std::string fish_completion(const Entry& program) {
  const auto quoted = [](const std::string& text) { return quoted_word(text, "\\'"); };
  std::string text =
      "# Completion of neve for fish.\ncomplete -c neve -n __fish_use_subcommand -f\n";
  for (const Entry& entry : program.parts) {
    text += "complete -c neve -n __fish_use_subcommand -a " + entry.name() + " -d " +
            quoted(entry.command.help) + "\n";
    for (const std::string& part : entry.part_names())
      text += "complete -c neve -n '__fish_seen_subcommand_from " + entry.name() + "' -a " + part +
              "\n";
    for (const options::Option& option : entry.command.options)
      if (!option.is_argument())
        text += "complete -c neve -n '__fish_seen_subcommand_from " + entry.name() + "' -l " +
                option.long_name().substr(2) + (option.needs_value() ? " -r" : "") + " -d " +
                quoted(option.help) + "\n";
  }
  return text;
}

void make_part(const std::filesystem::path& folder) {
  try {
    output::make_folder(folder);
    output::remove_abandoned(folder);
  } catch (const IoError& error) {
    throw IoError(error.what(), error.where, "choose another folder, as in neve manual DIR");
  }
}

}  // namespace

void write_manual(const Entry& program, const std::filesystem::path& folder) {
  make_part(folder);
  for (const char* part : {"man1", "bash", "zsh", "fish"}) make_part(folder / part);
  write_pages(program, folder / "man1");
  output::write_file(folder / "bash" / "neve", bash_completion(program));
  output::write_file(folder / "zsh" / "_neve", zsh_completion(program));
  output::write_file(folder / "fish" / "neve.fish", fish_completion(program));
}

}  // namespace neve::app::cli
