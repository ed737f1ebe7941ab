#pragma once
/// Errors of a scene, with their location. what() is the finished line for stderr.

#include <stdexcept>
#include <string>

namespace neve::app::scene::toml {

/// "FILE:LINE:COLUMN: error: MESSAGE; HINT", without the position where line is 0.
class SceneError : public std::runtime_error {
 public:
  SceneError(std::string file_name, int at_line, int at_column, std::string text,
             std::string advice = {});

  std::string file;
  int line, column;  ///< from 1; the column counts code points
  std::string message, hint;
};

}  // namespace neve::app::scene::toml
