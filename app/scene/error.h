#pragma once
/// What is wrong with a scene, and where. what() is the finished line for stderr.

#include <stdexcept>
#include <string>

namespace neve::app {

/// "FILE:LINE:COLUMN: error: MESSAGE; HINT", without the position where line is 0.
class SceneError : public std::runtime_error {
 public:
  SceneError(std::string file_name, int at_line, int at_column, std::string text,
             std::string advice = {})
      : std::runtime_error(
            file_name +
            (at_line > 0 ? ":" + std::to_string(at_line) + ":" + std::to_string(at_column) : "") +
            ": error: " + text + (advice.empty() ? "" : "; " + advice)),
        file(std::move(file_name)),
        line(at_line),
        column(at_column),
        message(std::move(text)),
        hint(std::move(advice)) {}

  std::string file;
  int line, column;  ///< from 1; the column counts code points
  std::string message, hint;
};

/// A mistake on the command line: "WHERE: error: MESSAGE; HINT", where WHERE is the argument.
class UsageError : public std::runtime_error {
 public:
  UsageError(std::string argument, std::string text, std::string advice = {})
      : std::runtime_error((argument.empty() ? "" : argument + ": error: ") + text +
                           (advice.empty() ? "" : "; " + advice)),
        where(std::move(argument)),
        message(std::move(text)),
        hint(std::move(advice)) {}

  std::string where, message, hint;
};

}  // namespace neve::app
