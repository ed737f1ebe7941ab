#include "app/cli/command_line.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <memory>

#include "app/card/card_options.h"
#include "app/cli/commands.h"
#include "app/support/errors.h"
#include "app/support/json.h"
#include "app/support/out_folder.h"
#include "app/support/text.h"
#include "app/support/version.h"
#include "app/sweep/sheet/star.h"
#include "app/sweep/store/promote.h"
#include "sim/kernels/simd.h"

namespace neve::app::cli {

namespace {

using Words = std::vector<std::string>;

/// A command with options of its own, which live as long as it does.
template <class Options>
Entry entry(void (*describe)(options::Command&, Options&), int (*run)(const Options&),
            std::vector<Entry> parts = {}) {
  const auto options = std::make_shared<Options>();
  Entry made{{}, [options, run] { return run(*options); }, std::move(parts)};
  describe(made.command, *options);
  return made;
}

/// Columns of the terminal; 0 where the output is a file.
int terminal_width() {
  winsize size{};
  return ::isatty(STDOUT_FILENO) && ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 ? size.ws_col
                                                                                   : 0;
}

std::string simd_in_use() {
  return sim::kernels::name(sim::kernels::chosen_simd_level());
}

int print_version(const PlainOptions& options) {
  if (options.is_json)
    std::cout << to_text({{"name", "neve"},
                          {"version", version},
                          {"build", build_json()},
                          {"simd", simd_in_use()}})
              << "\n";
  else
    std::cout << "neve " << version << " (" << build_text(simd_in_use()) << ")\n";
  return exit_ok;
}

int print_manual(const PlainOptions& options) {
  write_manual(program(), options.name);
  return exit_ok;
}

/// The entry that words name. @throws UsageError
Entry& named(Entry& root, const Words& words) {
  Entry* found = &root;
  for (const std::string& word : words) {
    Entry* part = found->part(word);
    if (!part) refuse_help(*found, word);
    found = part;
  }
  return *found;
}

/// Every command below it with its options.
void list_options(const Entry& entry, Json& list) {
  list.push_back(options::to_json(entry.command));
  for (const Entry& part : entry.parts) list_options(part, list);
}

int print_help(const PlainOptions& options) {
  Entry root = program();
  const Entry& entry = named(root, options.names);
  if (!options.is_json) {
    std::cout << entry.help();
    return exit_ok;
  }
  Json list = Json::array();
  list_options(entry, list);
  std::cout << to_text(list) << "\n";
  return exit_ok;
}

/// The word that names a part: flags without a value may come before it.
Words::iterator place_of_part(Entry& entry, Words& words) {
  const auto is_plain_flag = [&](const std::string& word) {
    const options::Option* option = entry.command.find(word);
    return option && option->is_flag;
  };
  const auto at = std::find_if_not(words.begin(), words.end(), is_plain_flag);
  return at != words.end() && entry.part(*at) ? at : words.end();
}

bool asks_for_help(const Words& words) {
  const auto end = std::find(words.begin(), words.end(), "--");
  return std::any_of(words.begin(), end,
                     [](const std::string& word) { return word == "--help" || word == "-h"; });
}

}  // namespace

std::string Entry::name() const {
  const std::string& whole = command.name;
  return whole.empty() ? "neve" : whole.substr(whole.rfind(' ') + 1);
}

Entry* Entry::part(const std::string& name) {
  const auto found = std::ranges::find(parts, name, &Entry::name);
  return found == parts.end() ? nullptr : &*found;
}

std::vector<std::string> Entry::part_names() const {
  std::vector<std::string> names;
  for (const Entry& part : parts) names.push_back(part.name());
  return names;
}

std::string Entry::help() const {
  std::vector<const options::Command*> commands;
  for (const Entry& part : parts) commands.push_back(&part.command);
  return options::help_text(command, commands, terminal_width()) +
         (command.name.empty() ? std::string("\n") + exit_codes + "\n" : "");
}

Entry program() {
  Entry made;
  made.command.about(
      "", "neve simulates snow and draws it, as pictures and movies or live in a window.");
  static bool is_version_asked_for = false;
  made.command("--version", is_version_asked_for, "Print the version");
  made.parts = {
      entry(describe_new, run_new),
      entry<run::RenderOptions>(run::describe, run_render),
      entry(describe_check, run_check),
      entry<card::CardOptions>(card::describe, card::run),
      entry(describe_dump, run_dump),
      entry(describe_export, run_export),
      entry(describe_strip, run_strip_command),
      entry(describe_doctor, run_doctor),
      entry(describe_info, run_info),
      entry(describe_verify, run_verify),
      entry(describe_params, run_params),
      entry(describe_schema, run_schema),
      entry(describe_compare, run_compare),
      entry<sweep::plan::SweepOptions>(
          sweep::plan::describe, run_sweep,
          {entry<sweep::plan::SweepRunOptions>(sweep::plan::describe, run_sweep_run),
           entry<sweep::plan::CollectOptions>(sweep::plan::describe, run_sweep_collect),
           entry<sweep::store::PromoteOptions>(sweep::store::describe, sweep::store::run_promote),
           entry<sweep::sheet::StarOptions>(sweep::sheet::describe, sweep::sheet::run_star)}),
      entry(describe_pick, run_pick),
      entry(describe_view, run_view),
      bench_entry(),
      entry(describe_manual, print_manual),
      entry(describe_version, print_version),
      entry(describe_help, print_help)};
  return made;
}

int run_command_line(const Words& words) {
  make_printable(std::cout);
  Entry root = program();
  if (words.empty()) {
    std::cerr << root.help();
    return exit_usage;
  }
  if (words.front() == "--version") return print_version({});
  if (words.front() == "--help" || words.front() == "-h") return print_help({});
  check_command(root, words);
  Entry* called = root.part(words.front());
  Words rest(words.begin() + 1, words.end());
  if (const auto at = place_of_part(*called, rest); at != rest.end()) {
    called = called->part(*at);
    rest.erase(at);
  }
  if (asks_for_help(rest)) {
    std::cout << called->help();
    return exit_ok;
  }
  const Words leftovers = options::parse(called->command, rest);
  if (!leftovers.empty()) refuse_leftover(*called, leftovers.front());
  called->command.check_all();
  set_other_place(called->command.other_place);
  const ErrorOutput output = error_output(words);
  warn_of_surroundings(called->command, output);
  prepare_interrupt(output);
  return called->run();
}

ErrorOutput error_output(const Words& words) {
  ErrorOutput output;
  for (std::size_t k = 0; k < words.size(); ++k) {
    const std::string& word = words[k];
    const std::string next = k + 1 < words.size() ? words[k + 1] : "";
    output.is_json = output.is_json || word == "--json";
    output.is_progress_json = output.is_progress_json || word == "--progress=json" ||
                              (word == "--progress" && next == "json");
    if (word == "--log") output.log = next;
    if (word.starts_with("--log=")) output.log = word.substr(6);
  }
  return output;
}

}  // namespace neve::app::cli
