#pragma once
/// Commands as typed into a POSIX shell.

#include <optional>
#include <string>
#include <vector>

#include "app/scene/override.h"
#include "app/scene/scene.h"
#include "app/setup/plan.h"

namespace neve::app::setup {

/// A word for a POSIX shell, quoted where it has to be.
std::string shell_word(const std::string& text);

/// Contents of a picture that a command can express.
struct RenderCommand {
  std::string scene_file;  ///< as the shell's folder sees it
  std::vector<scene::Override> overrides;
  std::optional<FrameRange> frames;
  std::vector<std::string> views;
  std::optional<scene::PictureSize> size;
  std::optional<Quality> quality;
  double coarsening = 1;
  std::string out;  ///< empty: where neve render puts it
};

/// "neve", "render", "scene.toml", "--set", "material.snow.hardening=5", ...
std::vector<std::string> arguments(const RenderCommand& command);

/// The same as one line to paste. Values of --set are always quoted, since most hold something that
/// a shell would act on.
std::string command_line(const RenderCommand& command);

}  // namespace neve::app::setup
