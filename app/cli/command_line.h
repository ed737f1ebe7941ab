#pragma once
/// The command line: all commands, and the one that is called.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "app/options/option.h"
#include "app/support/json.h"

namespace neve::app::cli {

inline constexpr const char* exit_codes =
    "Exit codes: 0 ok, 1 internal, 2 usage, 3 scene invalid or missing, 4 no GL backend,\n5 "
    "diverged, 6 input or output failed, 7 runs of a sweep failed, 8 refused by a limit,\n9 a "
    "check failed, 75 interrupted with a checkpoint, 130 interrupted.";

/// A command that can be called.
struct Entry {
  options::Command command;
  std::function<int()> run{};  ///< with the options that were read; none: a part has to be named
  std::vector<Entry> parts{};

  /// "sweep", "collect"; "neve" of the program
  std::string name() const;
  /// A part by its name; null if there is none.
  Entry* part(const std::string& name);
  std::vector<std::string> part_names() const;
  /// Broken into lines for a terminal.
  std::string help() const;
};

/// neve bench
Entry bench_entry();

/// The program: its parts are the commands, in the order of help.
Entry program();

/// Parses and runs. @return the exit code
/// @throws UsageError, and the errors of the command
int run_command_line(const std::vector<std::string>& words);

/// Writes DIR/man1/neve-render.1 and so on, DIR/bash/neve, DIR/zsh/_neve and DIR/fish/neve.fish:
/// man pages and completions of shells, from the same descriptions as --help. @throws IoError
void write_manual(const Entry& program, const std::filesystem::path& folder);

/// The words have to start with a command, and with a part of one that does nothing without.
/// @throws UsageError
void check_command(Entry& program, const std::vector<std::string>& words);
/// Refuses a word that no option of the command takes. @throws UsageError
[[noreturn]] void refuse_leftover(const Entry& entry, const std::string& word);
/// Refuses to help with what is no part of a command. @throws UsageError
[[noreturn]] void refuse_help(const Entry& entry, const std::string& word);

/// Says where an error is written.
struct ErrorOutput {
  bool is_json = false;           ///< on stdout too, as JSON
  bool is_progress_json = false;  ///< on stderr as an event of --progress json
  std::string log;                ///< of --log; empty: none
};

/// Keeps the answer of --json until the command ends: with an error after it, both are one document
/// on stdout.
void set_answer(Json answer);

/// Lets a request to stop that comes before anything is made be answered like an error.
void prepare_interrupt(const ErrorOutput& output);

/// Call it while an exception is handled. Prints one message on stderr and, if wanted, a JSON
/// object on stdout. @return the exit code
int report_current_error(const ErrorOutput& output);

/// Prints the answer, if there is one, and flushes std::cout. A reader that stops early is no
/// error: `neve dump ... | head`.
/// @throws IoError when it cannot be written for another reason
void finish_output();

/// Warns of variables of the environment that look like those of neve and are read by nothing, and
/// of many more threads than cores, on standard error.
void warn_of_surroundings(const options::Command& command, const ErrorOutput& output);

/// Finds out where the flags want errors; works on command lines that do not parse.
ErrorOutput error_output(const std::vector<std::string>& words);

struct FolderAdvice {
  std::string what;  ///< "is the folder of a sweep, not of a run"
  std::string hint;
};

/// About a folder without run.json.
FolderAdvice advice_on_folder(const std::filesystem::path& folder);

/// Refuses a regular file that is no picture, with advice by its suffix.
/// @param command  "neve compare"
/// @throws Error
void require_picture(const std::filesystem::path& file, const std::string& command);

}  // namespace neve::app::cli
