#include "app/view/production.h"

#include "app/command_text.h"
#include "app/output/atomic_file.h"
#include "app/scene/error.h"
#include "app/scene/flat.h"
#include "app/sweep/around.h"

namespace neve::app {

std::string plain_file_name(const std::string& address) {
  std::string name = address;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_' && c != '-') c = '_';
  return name;
}

std::string render_command(const Document& document) {
  RenderCommand command;
  command.scene_file = document.file();
  command.overrides = document.all_overrides();
  command.coarsening = document.coarsening();
  return command_line(command);
}

void write_sweep_around(const std::filesystem::path& file, const Document& document,
                        const std::string& address) {
  for (const FlatParam& param : flatten(*document.scene())) {
    if (param.address != address) continue;
    make_folder(file.parent_path());
    write_file(file, sweep_around(document.file(), file.string(), param, document.all_overrides()));
    return;
  }
  throw UsageError("", "nothing has the address " + address);
}

}  // namespace neve::app
