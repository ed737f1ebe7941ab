#include "app/scene/toml/error.h"

#include "app/support/errors.h"

namespace neve::app::scene::toml {
namespace {

std::string place_text(const std::string& file, int line, int column) {
  std::string place = file;
  if (line > 0) place.append(":").append(std::to_string(line));
  if (line > 0) place.append(":").append(std::to_string(column));
  return place;
}

}  // namespace

SceneError::SceneError(std::string file_name, int at_line, int at_column, std::string text,
                       std::string advice)
    : std::runtime_error(error_sentence(place_text(file_name, at_line, at_column), text, advice)),
      file(std::move(file_name)),
      line(at_line),
      column(at_column),
      message(std::move(text)),
      hint(std::move(advice)) {}

}  // namespace neve::app::scene::toml
