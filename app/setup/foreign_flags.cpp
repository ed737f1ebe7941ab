#include "app/setup/foreign_flags.h"

#include <algorithm>

#include "app/scene/params.h"

namespace neve::app::setup {

namespace {

struct ForeignFlag {
  const char* words;  ///< with a blank on both sides of each
  const char* flag;   ///< that the command must have
  const char* advice;
};

constexpr ForeignFlag foreign_flags[] = {
    {" --method --samples --lhs --grid --random --sobol --morris ", "--shard",
     "samples are drawn by a file: [sweep] with method and samples; neve params --sweep"},
    {" --bodies --every --carried ", "--surface-cell",
     "neve export writes all of the snow at --frames or --at; [[export]] in a scene has bodies, "
     "every and carried"},
    {" --size --resolution ", "--tiles",
     "--width 1920 is the width of the whole picture, and output.size the shape of a tile"},
    {" --movie --movie-fps --fps ", "--tiles", "a strip is one picture; neve render makes movies"},
    {" --frames --frame ", "--probe",
     "moments are times in seconds: --at 0.1; frame n is at n / fps"},
    {" --transparent --alpha --rgba ", "--set",
     "a transparent background is --set output.background=transparent"},
    {" --motion-blur --motionblur --blur ", "--shutter", "motion blur is --shutter 180"},
    {" --samples --spp --antialiasing --aa ", "--quality",
     "--quality final has four samples a pixel"},
    {" --gpu --cuda --device ", "--backend",
     "--backend egl draws with a GPU where there is one; the simulation runs on the cores"},
    {" --exr --aov --aovs --channels ", "--passes", "OpenEXR files are --passes all"},
    {" --format ", "--passes",
     "pictures are PNG; --passes all adds OpenEXR, --movie chooses the film, neve export writes "
     "geometry"},
    {" --camera --cam ", "--set",
     "the camera is in the scene: --set camera.orbit=30; neve params camera"},
    {" --time --times ", "--at", "did you mean --at?"},
    {" --strict --werror ", "--json", "findings have a severity each in --json"},
    {" --frame-rate --rate ", "--set", "frames a second are --set fps=30"}};

bool has_flag(const std::vector<std::string>& flags, const std::string& flag) {
  return std::find(flags.begin(), flags.end(), flag) != flags.end();
}

/// The parameter of that address, or those that are called so, of the shortest addresses:
/// output.size, and no size of a box.
std::vector<std::string> parameters_named(const std::string& word) {
  if (scene::param_at(word)) return {word};
  std::vector<std::string> found;
  const auto depth = [](const std::string& address) {
    return std::count(address.begin(), address.end(), '.');
  };
  for (const scene::ParamInfo& info : scene::params()) {
    const std::string& address = info.address;
    if (address != word && !address.ends_with("." + word)) continue;
    if (!found.empty() && depth(address) > depth(found.front())) continue;
    if (!found.empty() && depth(address) < depth(found.front())) found.clear();
    found.push_back(address);
  }
  return found;
}

/// @param value that was typed; "VALUE" where it is not known
std::string as_setting(const std::string& word, const std::string& value,
                       const std::vector<std::string>& flags) {
  if (!has_flag(flags, "--set")) return {};
  const std::vector<std::string> addresses = parameters_named(word);
  if (addresses.empty()) return {};
  if (addresses.size() == 1) return "it is a parameter: --set " + addresses.front() + "=" + value;
  return "several parameters are called so; neve params " + word + " lists them, for --set";
}

}  // namespace

std::string foreign_flag_advice(const std::string& word, const std::vector<std::string>& flags) {
  for (const ForeignFlag& known : foreign_flags)
    if (has_flag(flags, known.flag) &&
        std::string_view(known.words).find(" " + word + " ") != std::string_view::npos)
      return known.advice;
  if (!word.starts_with("--")) return {};
  std::string name = word.substr(2);
  std::replace(name.begin(), name.end(), '-', '_');
  return as_setting(name, "VALUE", flags);
}

std::string stray_word_advice(const std::string& word, const std::vector<std::string>& flags) {
  const std::size_t equals = word.find('=');
  if (equals != std::string::npos && equals > 0)
    return as_setting(word.substr(0, equals), word.substr(equals + 1), flags);
  if (word.ends_with(".toml") && has_flag(flags, "--set"))
    return "one scene at a time; a loop of the shell takes several: for s in *.toml; do neve ... "
           "$s; done";
  return has_flag(flags, "--shard")
             ? "values of -p have commas between them and no blanks, as in -p "
               "ADDRESS=A,B"
             : "";
}

std::string command_meant(const std::string& word) {
  constexpr std::pair<const char*, const char*> commands[] = {
      {"simulate", "render"}, {"run", "render"},    {"draw", "render"},  {"make", "render"},
      {"play", "view"},       {"gui", "view"},      {"web", "view"},     {"open", "view"},
      {"show", "view"},       {"ui", "view"},       {"study", "sweep"},  {"batch", "sweep"},
      {"convert", "export"},  {"save", "export"},   {"diff", "compare"}, {"test", "doctor"},
      {"list", "params"},     {"init", "new"},      {"create", "new"},   {"estimate", "check"},
      {"lint", "check"},      {"validate", "check"}};
  for (const auto& [other, ours] : commands)
    if (word == other) return ours;
  return "";
}

}  // namespace neve::app::setup
