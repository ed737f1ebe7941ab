#include "app/options/option.h"

#include <exception>
#include <filesystem>
#include <new>
#include <system_error>

#include "app/output/json_file.h"
#include "app/output/sequence.h"
#include "app/support/errors.h"
#include "app/support/text.h"

namespace neve::app::options {

std::string Option::long_name() const {
  const auto found =
      std::ranges::find_if(names, [](const std::string& name) { return name.starts_with("--"); });
  return found == names.end() ? "" : *found;
}

std::string Option::default_text() const {
  return joined(write(), ",");
}

Option& Option::excludes(const std::vector<std::string>& flags, const std::string& hint) {
  const std::vector<std::string> first(flags.begin(), flags.end() - 1);
  const std::string all = joined(first, ", ") + (first.empty() ? "" : " or ") + flags.back();
  rules.push_back({true, flags, "cannot be combined with " + all, hint});
  return *this;
}

void Command::about(const std::string& command, const std::string& sentence) {
  name = command;
  help = sentence;
  Option& option = add("--help,-h", "", "", "Print this help");
  option.is_flag = true;
  option.read = [](const std::string&) {};
  option.write = [] { return std::vector<std::string>{}; };
}

Option& Command::add(const char* names, const std::string& type, const std::string& example,
                     const std::string& sentence) {
  Option& option = options.emplace_back();
  option.names = comma_separated(names);
  option.type = type;
  option.example = example;
  option.help = sentence;
  return option;
}

Option& Command::custom(const char* names, const std::string& type, const std::string& example,
                        std::function<void(const std::string&)> read,
                        std::function<std::string()> write, const std::string& sentence) {
  Option& option = add(names, type, example, sentence);
  option.read = std::move(read);
  option.write = [write = std::move(write)] {
    const std::string value = write();
    return std::vector<std::string>(value.empty() ? 0 : 1, value);
  };
  return option;
}

Option* Command::find(const std::string& name) {
  for (Option& option : options)
    if (std::find(option.names.begin(), option.names.end(), name) != option.names.end())
      return &option;
  return nullptr;
}

std::vector<std::string> Command::flags() const {
  std::vector<std::string> flags;
  for (const Option& option : options)
    if (!option.is_argument()) flags.push_back(option.long_name());
  return flags;
}

void refuse_input(const std::string& flag, const std::string& output, const std::string& input) {
  std::error_code error;
  if (std::filesystem::is_regular_file(output, error) &&
      std::filesystem::equivalent(output, input, error))
    throw UsageError(flag, output + " is what the command reads", "name another file");
}

namespace {

/// Null where it is none.
Json json_of(const std::filesystem::path& file) {
  try {
    return output::read_json(file);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    return {};
  }
}

/// A picture, table or log in the place of what a run or sweep consists of would take it from them.
void refuse_part_of_run(const std::string& flag, const std::string& output) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (!fs::is_regular_file(output, error)) return;
  const fs::path file = fs::absolute(output, error).lexically_normal();
  const auto refuse = [&](const fs::path& folder) {
    throw UsageError(flag, output + " belongs to what neve wrote into " + folder.string(),
                     "name another file");
  };
  struct Record {
    const char *name, *key;
  };
  for (const Record& own :
       {Record{"run.json", "frames"}, {"manifest.json", "runs"}, {"status.json", "state"}})
    if (file.filename() == own.name && json_of(file).contains(own.key)) refuse(file.parent_path());
  // Pictures are in the folder of their view, movies beside it.
  const fs::path above = file.parent_path();
  for (const fs::path& folder : {above, above.parent_path()})
    if (const Json run = json_of(output::run_json_path(folder));
        run.contains("files") &&
        run["files"].contains(file.lexically_relative(folder).generic_string()))
      refuse(folder);
}

}  // namespace

void Command::check_all() const {
  const auto is_given = [this](const std::string& flag) { return find(flag)->is_given(); };
  for (const Option& option : options) {
    if (option.is_required && !option.is_given())
      throw UsageError("", full_name() + " needs " + option.name(),
                       "see " + full_name() + " --help");
    for (const Option::Rule& rule : option.rules)
      if (option.is_given() &&
          std::any_of(rule.flags.begin(), rule.flags.end(), is_given) == rule.is_with)
        throw UsageError(option.name(), rule.message, rule.hint);
  }
  for (const auto& check : checks) check();
  for (const char* flag : {"--out", "--emit", "--log", "--record"}) {
    const Option* output = find(flag);
    if (!output) continue;
    for (const std::string& file : output->given) {
      refuse_part_of_run(flag, file);
      for (const Option& input : options)
        if (&input != output)
          for (const std::string& read : input.given) refuse_input(flag, file, read);
    }
  }
}

}  // namespace neve::app::options
